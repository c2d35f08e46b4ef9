#include "tessera/tessellate.h"

#include <span>

#include "base/function_ref.h"
#include "base/text.h"
#include "tessera/guard.h"
#include "tessera/mesh_assembly.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status refusal(std::span<const std::uint32_t> patches, const char* fault) {
  return {StatusCode::invalid_argument,
          counted(patches.size(), "patch", "patches") + " " + fault + ": a Tessellation has the mesh and its bounds",
          static_cast<std::ptrdiff_t>(patches.front())};
}

Result<Mesh> with_parts(Result<Mesh> mesh, FunctionRef<Result<std::vector<MeshPart>>(const Mesh&)> parts_of) {
  if (!mesh) return mesh;
  Result<std::vector<MeshPart>> parts = parts_of(*mesh);
  if (!parts) return parts.status();
  mesh->parts = *std::move(parts);
  return mesh;
}

}  // namespace

Result<Mesh> tessellate(const PatchSet& set, const TessellationOptions& options, const Execution& execution) {
  if (const std::span<const Status> faults = set.trim_faults(); !faults.empty()) return faults.front();
  const Result<Tessellation> plan = Tessellation::make(set, options, execution);
  if (!plan) return plan.status();
  if (const auto beyond = plan->patches_beyond_tolerance(); !beyond.empty())
    return refusal(beyond, "cannot keep the tolerance");
  if (const auto crossed = plan->crossed_patches(); !crossed.empty())
    return refusal(crossed, "without triangles, because their trimming loops cross");
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  if (Status status = plan->run(set, mesh->views(), execution); !status.ok()) return status;
  return mesh;
}

Result<Mesh> tessellate(const Model& model, const TessellationOptions& options, const Execution& execution) {
  const Result<PatchSet> set = make_patch_set(model);
  if (!set) return set.status();
  const auto parts = [&](const Mesh& mesh) { return parts_by_surface(mesh, *set, model); };
  return with_parts(tessellate(*set, options, execution), parts);
}

Result<Mesh> tessellate(const Surface& surface, const TessellationOptions& options, const Execution& execution) {
  return guarded([&] {
    Model model;
    model.surfaces.push_back({{}, surface});
    return tessellate(model, options, execution);
  });
}

Result<Mesh> tessellate(const Shape& shape, const TessellationOptions& options, const Execution& execution) {
  const Result<PatchSet> set = make_patch_set(shape);
  if (!set) return set.status();
  const auto parts = [&](const Mesh& mesh) { return parts_by_face(mesh, *set, shape); };
  return with_parts(tessellate(*set, options, execution), parts);
}

}}  // namespace tessera::abi_0_1
