// Meshes at one rate, positions, normals, parameters and triangles, and the packing of patches into blocks. Each mesh is
// checked against the reference evaluators and the shape of its triangles, each set of blocks by what evaluates from it.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "sets.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/tessellate.h"
#include "timing.h"

namespace tessera::bench {
namespace {

using test::value_of;

constexpr int rate = 8;

/// Every 50th patch: the vertices of its triangles lie on it, with its normals.
bool lies_on(const PatchSet& set, const Mesh& mesh) {
  const double size = set.box().diagonal();
  const std::size_t of_patch = mesh.triangle_count() / set.patch_count();
  for (std::size_t triangle = 0; triangle < mesh.triangle_count(); triangle += 50 * of_patch + 1)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t k = mesh.indices[3 * triangle + corner];
      const BezierPatch patch = set.patch(mesh.patches[triangle]);
      const double u = mesh.parameters[2 * k], v = mesh.parameters[2 * k + 1];
      const Vec3 p{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
      const Vec3 n{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
      const SurfaceJet jet = evaluate_jet(patch, u, v);
      if (!(max_abs(p + mesh.origin - jet.position) <= 1e-5 * size)) return false;
      const Vec3 area = cross(jet.du, jet.dv);
      if (length(area) > 1e-3 * length(jet.du) * length(jet.dv) && !(max_abs(n - normalized(area)) <= 1e-3))
        return false;
    }
  return true;
}

void tessellate(benchmark::State& state, const char* surface, int threads) {
  const PatchSet& set = set_named(surface);
  const TessellationPlan plan = value_of(TessellationPlan::make(set, {.rate_u = rate, .rate_v = rate}));
  Mesh mesh = value_of(plan.allocate());
  const auto bytes =
      static_cast<double>(sizeof(float) * (mesh.positions.size() + mesh.normals.size() + mesh.parameters.size()) +
                          sizeof(std::uint32_t) * (mesh.patches.size() + mesh.indices.size()));
  const LimitsAround around({}, bytes);
  const auto best = time_calls(state, threads, [&] { return plan.run(set, mesh.views()); });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  const auto report = check(mesh);
  if (!report || report->non_finite_vertices || report->non_manifold_edges || report->inconsistent_edges)
    return state.SkipWithError("the triangles don't fit together");
  if (!lies_on(set, mesh)) return state.SkipWithError("the mesh does not lie on the surface");
  report_rates(state, *best, static_cast<double>(mesh.triangle_count()), bytes);
  if (threads == 1) report_limit(state, *best, *limits, {.bytes_written = bytes});
}

void pack(benchmark::State& state, int threads) {
  const std::vector<BezierPatch> patches = test::wavy_field(200, 100);
  const double bytes = static_cast<double>(patches.size()) * 16 * 3 * sizeof(float);
  const LimitsAround around({}, bytes);
  const auto best = time_calls(state, threads, [&] { return PatchSet::from(patches).status(); });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  const PatchSet set = value_of(PatchSet::from(patches));
  const TessellationPlan plan = value_of(TessellationPlan::make(set, {.rate_u = 2, .rate_v = 2}));
  Mesh mesh = value_of(plan.allocate());
  if (!plan.run(set, mesh.views()).ok() || !lies_on(set, mesh))
    return state.SkipWithError("the blocks don't hold the patches");
  report_rates(state, *best, static_cast<double>(patches.size()), bytes);
  if (threads == 1) report_limit(state, *best, *limits, {.bytes_written = bytes});
}

const bool registered = [] {
  for (const int threads : {1, 2}) {
    const Part part = threads == 1 ? Part::quick : Part::full;
    for (const char* surface : {"teapot", "bicubic20000"})
      add_case({"tessellate", surface, "3", square(rate), "-", threads}, part,
               [=](benchmark::State& state) { tessellate(state, surface, threads); });
    add_case({"pack", "bicubic20000", "3", "20000", "-", threads}, part,
             [=](benchmark::State& state) { pack(state, threads); });
  }
  return true;
}();

}  // namespace
}  // namespace tessera::bench
