#include "tess/write/mesh_views.h"

#include <algorithm>
#include <string>

#include "base/impl_access.h"
#include "base/saturated.h"
#include "base/text.h"
#include "block/patch_set_impl.h"
#include "eval/grid_checks.h"
#include "parallel/least_index.h"
#include "parallel/long_lists.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t compared_per_task = 1024;

Status invalid(std::string message) { return {StatusCode::invalid_argument, std::move(message)}; }

Status check_size(const char* name, std::size_t size, std::size_t wanted, const char* what) {
  if (size >= wanted) return {};
  return {StatusCode::buffer_too_small, std::string("the ") + name + " view holds " + std::to_string(size) + " " +
                                            what + ", " + std::to_string(wanted) + " are needed"};
}

template <class T, int N>
Status check_view(const char* name, const VectorView<T, N>& view, std::size_t vertices) {
  if (view.empty()) return {};
  if (std::find(view.component.begin(), view.component.end(), nullptr) != view.component.end())
    return invalid(std::string("a component of the ") + name + " view is null");
  if (view.stride < 1)
    return invalid("the " + std::string(name) + " view's stride is " + std::to_string(view.stride) +
                   ", it must be at least 1");
  return check_size(name, view.size, vertices, "vertices");
}

template <class View>
void add_wanted(ViewChecks& checks, const char* name, const View& view) {
  if (!view.empty()) checks.add(name, view);
}

void add_wanted(ViewChecks& checks, const char* name, std::span<std::uint32_t> numbers, std::size_t records) {
  const View1<std::uint32_t> view{.component = {numbers.data()}, .stride = 1, .size = numbers.size()};
  if (!numbers.empty()) checks.add(name, view, records);
}

/// Returns checks that the views of vertices are aligned and do not share memory.
ViewChecks vertex_checks(const MeshViews& out, const MeshCapacity& wanted) {
  ViewChecks checks(wanted.vertices);
  add_wanted(checks, "position", out.position);
  add_wanted(checks, "normal", out.normal);
  add_wanted(checks, "model_position", out.model_position);
  return checks;
}

Status check_lengths(const MeshViews& out, const MeshCapacity& wanted, bool f64) {
  // An array without elements may have no memory, so a mesh without vertices has no view that is not empty.
  if (f64 && out.model_position.empty() && wanted.vertices > 0)
    return invalid("the model_position view is empty, a plan with positions in double requires it");
  if (!f64 && !out.model_position.empty())
    return invalid("the model_position view must be empty: the plan has no positions in double");
  if (!f64 && out.position.empty() && wanted.vertices > 0) return invalid("the position view is empty, it is required");
  if (Status status = check_view("model_position", out.model_position, wanted.vertices); !status.ok()) return status;
  if (Status status = check_view("position", out.position, wanted.vertices); !status.ok()) return status;
  return check_view("normal", out.normal, wanted.vertices);
}

}  // namespace

Mesh empty_mesh(const MeshCapacity& capacity, const Vec3& origin, const MeshArrays& arrays) {
  Mesh mesh;
  mesh.origin = origin;
  const std::size_t vertices = capacity.vertices, triangles = capacity.triangles, quads = capacity.quads;
  const std::size_t coordinates = saturated_product(3, vertices);
  const ListSize sizes[] = {size_of(mesh.positions, coordinates, 1),  // RayScene::make() needs room for one more
                            size_of(mesh.normals, arrays.normals ? coordinates : 0),
                            size_of(mesh.parameters, arrays.parameters ? saturated_product(2, vertices) : 0),
                            size_of(mesh.model_positions, arrays.model_positions ? coordinates : 0),
                            size_of(mesh.indices, saturated_product(3, triangles)),
                            size_of(mesh.patches, triangles),
                            size_of(mesh.quads, saturated_product(4, quads)),
                            size_of(mesh.quad_patches, quads)};
  resize_lists(sizes);
  return mesh;
}

Status check_updated_views(const MeshViews& out, const MeshCapacity& wanted, bool f64) {
  if (Status status = check_lengths(out, wanted, f64); !status.ok()) return status;
  const auto check_count = [&](const char* name, std::size_t size) -> Status {
    if (size <= wanted.vertices) return {};
    return {StatusCode::count_mismatch, std::string("the ") + name + " view holds " +
                                            counted(size, "vertex", "vertices") + ", the mesh has " +
                                            std::to_string(wanted.vertices) + ": it is that of another topology"};
  };
  for (const Status& status : {check_count("position", out.position.size), check_count("normal", out.normal.size),
                               check_count("model_position", out.model_position.size)})
    if (!status.ok()) return status;
  return vertex_checks(out, wanted).status();
}

Status check_no_quads(const MeshViews& out) {
  if (out.quads.empty() && out.quad_patch.empty()) return {};
  return invalid("there is a view of quads, the plan has none: set TessellationOptions::quads");
}

Status check_views(const MeshViews& out, const MeshCapacity& wanted, bool f64) {
  if (Status status = check_lengths(out, wanted, f64); !status.ok()) return status;
  if (Status status = check_view("parameter", out.parameter, wanted.vertices); !status.ok()) return status;
  if (Status status = check_size("indices", out.indices.size(), 3 * wanted.triangles, "indices"); !status.ok())
    return status;
  if (!out.patch.empty())
    if (Status status = check_size("patch", out.patch.size(), wanted.triangles, "triangles"); !status.ok())
      return status;
  if (Status status = check_size("quads", out.quads.size(), 4 * wanted.quads, "indices"); !status.ok()) return status;
  if (!out.quad_patch.empty())
    if (Status status = check_size("quad patch", out.quad_patch.size(), wanted.quads, "quads"); !status.ok())
      return status;
  ViewChecks checks = vertex_checks(out, wanted);
  add_wanted(checks, "parameter", out.parameter);
  add_wanted(checks, "indices", out.indices, 3 * wanted.triangles);
  add_wanted(checks, "patch", out.patch, wanted.triangles);
  add_wanted(checks, "quads", out.quads, 4 * wanted.quads);
  add_wanted(checks, "quad patch", out.quad_patch, wanted.quads);
  return checks.status();
}

Status no_float_blocks() {
  return {StatusCode::unsupported, "a tessellation needs float Bernstein blocks, the set has none"};
}

Status check_shapes(const PatchSet& set, std::span<const PatchShape> planned) {
  LeastIndex changed;
  const auto compare = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (PatchShape::of(impl_of(set).patches[k], impl_of(set).collapsed[k]) == planned[k]) continue;
      changed.add(k);
      return;
    }
  };
  if (Status status = parallel_for(planned.size(), compared_per_task, {}, compare); !status.ok()) return status;
  if (!changed.found()) return {};
  return {StatusCode::stale,
          "patch " + std::to_string(changed.index()) + " has other collapsed sides than when the plan was made",
          static_cast<std::ptrdiff_t>(changed.index())};
}

}}  // namespace tessera::abi_0_1
