#include "tessera/part_mesh.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/text.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check_local(const TessellationOptions& options) {
  const auto refused = [](const char* what) {
    return Status(StatusCode::unsupported, std::string(what) +
                                               " is not for models in parts: it decides for the whole "
                                               "mesh");
  };
  if (options.joining.share_vertices) return refused("share_vertices");
  if (options.joining.crease_angle) return refused("a crease angle");
  if (options.budget) return refused("a budget of triangles");
  if (!options.surface_tolerances.empty()) return refused("a list of surfaces' tolerances");
  if (options.fewest) return refused("a search for the fewest triangles");
  return {};
}

/// The patches of a part's wanted surfaces in its set.
struct OwnPatches {
  std::size_t first = 0, end = 0;
};

OwnPatches own_patches(const ModelPart& part, const PatchSet& set) {
  OwnPatches own;
  while (own.first < set.patch_count() && set.source(own.first).surface < part.first) ++own.first;
  own.end = own.first;
  while (own.end < set.patch_count() && set.source(own.end).surface < part.end) ++own.end;
  return own;
}

/// Leaves of a list only what stands from `begin` until `end`, less `offset`.
template <class T>
void keep(std::vector<T>& values, std::size_t begin, std::size_t end, std::size_t offset = 0) {
  if (values.empty()) return;
  constexpr std::size_t block = 4096;  // stays in a first-level cache between both loops
  for (std::size_t k = begin; (begin > 0 || offset > 0) && k < end; k += block) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(k);
    const auto to = from - static_cast<std::ptrdiff_t>(begin);
    const auto count = static_cast<std::ptrdiff_t>(std::min(block, end - k));
    std::copy(from, from + count, to);
    if (offset > 0) std::for_each(to, to + count, [&](T& value) { value -= static_cast<T>(offset); });
  }
  values.resize(end - begin);
}

/// Leaves of a mesh only what some patches have, from `begin` until `end`. Errors: cancelled.
Status keep_patches(Mesh& mesh, std::size_t first_patch, const MeshCapacity& begin, const MeshCapacity& end,
                    const Execution& execution) {
  const auto keep_list = [&](std::size_t list) {
    if (list == 0) keep(mesh.indices, 3 * begin.triangles, 3 * end.triangles, begin.vertices);
    if (list == 1) keep(mesh.quads, 4 * begin.quads, 4 * end.quads, begin.vertices);
    if (list == 2) keep(mesh.positions, 3 * begin.vertices, 3 * end.vertices);
    if (list == 3) keep(mesh.model_positions, 3 * begin.vertices, 3 * end.vertices);
    if (list == 4) keep(mesh.normals, 3 * begin.vertices, 3 * end.vertices);
    if (list == 5) keep(mesh.parameters, 2 * begin.vertices, 2 * end.vertices);
    if (list == 6) keep(mesh.patches, begin.triangles, end.triangles, first_patch);
    if (list == 7) keep(mesh.quad_patches, begin.quads, end.quads, first_patch);
  };
  const Execution quiet{.cancel = execution.cancel};
  return parallel_for(8, 1, quiet, [&](std::size_t list, std::size_t) { keep_list(list); });
}

float largest(std::span<const float> values) { return values.empty() ? 0 : *std::ranges::max_element(values); }

Status check_total(const PartCounts& all, const TessellationOptions& options) {
  const std::uint64_t triangles = all.triangles + 2 * all.quads;
  if (options.rates || triangles <= options.max_triangles) return {};
  return Status(StatusCode::invalid_argument, "the mesh of all parts takes " + counted(triangles, "triangle") +
                                                  ", more than the limit of " + std::to_string(options.max_triangles));
}

}  // namespace

double part_reach(const TessellationOptions& options, const Box3& box) {
  constexpr double links = 4, most = 0.05, share = 1e-6;  // the most that a weld may be, and its default, of the size
  const double size = box.diagonal();
  if (options.rates) return 0;
  if (options.joining.weld) return links * std::min(*options.joining.weld, most * size);
  if (!options.tolerance) return links * share * size;
  return links * std::min(*options.tolerance * (options.relative ? size : 1) / 8, most * size);
}

Result<PartMesh> tessellate_part(const ModelPart& part, const TessellationOptions& options, const Execution& execution,
                                 const FitOptions& fit) {
  return guarded([&]() -> Result<PartMesh> {
    if (Status status = check_local(options); !status.ok()) return status;
    PartMesh made;
    made.mesh.origin = part.box.centre() + Vec3{};
    if (part.own_box.empty()) return made;
    const Result<PatchSet> set = make_patch_set(part.model, {.box = part.box, .fit_error = part.fit_error}, fit);
    if (!set) return set.status();
    const Result<Tessellation> plan = Tessellation::make(*set, options, execution);
    if (!plan) return plan.status();
    Result<Mesh> mesh = plan->allocate();
    if (!mesh) return mesh.status();
    made.mesh = *std::move(mesh);
    if (Status status = plan->run(*set, made.mesh.views(), execution); !status.ok()) return status;
    const auto [first, end] = own_patches(part, *set);
    if (Status status = keep_patches(made.mesh, first, plan->before(first), plan->before(end), execution); !status.ok())
      return status;
    made.own = {end - first, made.mesh.vertex_count(), made.mesh.triangle_count(), made.mesh.quad_count()};
    made.bound = options.rates ? plan->bound() : double{largest(plan->bounds().subspan(first, end - first))};
    made.gap = plan->gap(), made.certified = plan->certified();
    return made;
  });
}

Result<PartSums> sum_parts(const Result<PartMesh>& own, const TessellationOptions& options, Transport& transport) {
  return guarded([&]() -> Result<PartSums> {
    if (Status status = transport.agree(own.status()); !status.ok()) return status;
    std::array<std::uint64_t, 4> counts{own->own.patches, own->own.vertices, own->own.triangles, own->own.quads};
    const Result<std::vector<std::uint64_t>> all = transport.prefix_sum(counts);
    if (!all) return all.status();
    PartSums sums;
    sums.before = {counts[0], counts[1], counts[2], counts[3]};
    sums.all = {(*all)[0], (*all)[1], (*all)[2], (*all)[3]};
    if (Status status = check_total(sums.all, options); !status.ok()) return status;
    std::array<double, 3> most{own->bound, own->gap, own->certified ? 0.0 : 1.0};
    if (Status status = transport.reduce_max(most); !status.ok()) return status;
    sums.bound = most[0], sums.gap = most[1], sums.certified = most[2] == 0;
    return sums;
  });
}

}}  // namespace tessera::abi_0_1
