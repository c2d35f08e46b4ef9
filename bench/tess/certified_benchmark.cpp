// Meshes that keep a tolerance, from control points to triangles: the plan (edges, bounds, rates, layout), the vertices
// with their normals, and the indices. Each mesh is checked for cracks after it was timed.

#include <benchmark/benchmark.h>

#include <string>

#include "base/impl_access.h"
#include "sets.h"
#include "suite.h"
#include "support/edges_of_set.h"
#include "support/synthetic_sets.h"
#include "tess/edges/shared_edges.h"
#include "tess/tolerance_search.h"
#include "tessera/tessellation.h"
#include "timing.h"

namespace tessera::bench { namespace {

using test::value_of;

/// Positions, normals and indices; no other outputs.
struct Output {
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;

  explicit Output(const MeshCapacity& capacity)
      : positions(3 * capacity.vertices), normals(3 * capacity.vertices), indices(3 * capacity.triangles) {}
  MeshViews views() {
    MeshViews out;
    out.position = View3<float>::interleaved(positions);
    out.normal = View3<float>::interleaved(normals);
    out.indices = indices;
    return out;
  }
  double bytes() const {
    return static_cast<double>(sizeof(float) * (positions.size() + normals.size()) +
                               sizeof(std::uint32_t) * indices.size());
  }
};

/// The fault of the mesh; null if it is a disc without cracks, whose border is the set's.
const char* fault_of(const PatchSet& set, const Output& out) {
  Mesh mesh;
  mesh.origin = set.origin();
  mesh.positions = out.positions;
  mesh.normals = out.normals;
  mesh.indices = out.indices;
  const auto report = check(mesh);
  if (!report) return "the mesh can't be checked";
  if (report->non_manifold_edges || report->inconsistent_edges || report->t_junctions)
    return "the triangles don't fit together";
  if (report->non_finite_vertices || report->degenerate_triangles || report->flipped_triangles)
    return "triangles are degenerate or flipped";
  // vertices - edges + triangles = 1, and 3 triangles = 2 edges - open edges
  if (2 * report->distinct_positions != report->triangles + report->open_edges + 2) return "there are cracks";
  return nullptr;
}

/// The timed part: the plan, the run, or both.
enum class Timed { plan, run, mesh, edges };

void certify(benchmark::State& state, const char* surface, int rate, int threads, Timed timed) {
  const PatchSet& set = set_named(surface);
  const double tolerance = tolerance_for(set, rate);
  Tessellation plan = plan_for(set, tolerance);
  Output out(plan.capacity());
  const double bytes = timed == Timed::run || timed == Timed::mesh ? out.bytes() : 0;
  const LimitsAround around({}, out.bytes());
  const auto best = time_calls(state, threads, [&]() -> Status {
    if (timed == Timed::edges) {
      benchmark::DoNotOptimize(test::edges_of_set(set).count());
      return {};
    }
    if (timed != Timed::run) {
      Result<Tessellation> made = Tessellation::make(set, {.tolerance = tolerance});
      if (!made) return made.status();
      plan = std::move(*made);
    }
    return timed == Timed::plan ? Status{} : plan.run(set, out.views());
  });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  if (bytes > 0)
    if (const char* fault = fault_of(set, out)) return state.SkipWithError(fault);
  report_rates(state, *best, static_cast<double>(plan.capacity().triangles), bytes);
  state.counters["ns_a_patch"] = 1e9 * *best / static_cast<double>(set.patch_count());
  if (threads == 1 && bytes > 0) report_limit(state, *best, *limits, {.bytes_written = bytes});
}

void add_surface(const char* surface, int rate, int threads) {
  for (const auto& [name, timed] :
       {std::pair{"mesh", Timed::mesh}, {"plan", Timed::plan}, {"run", Timed::run}, {"edges", Timed::edges}}) {
    const bool quick = threads == 1 && rate == 8 && timed == Timed::mesh;
    if (timed == Timed::edges && (rate != 4 || threads != 1)) continue;  // depends only on the set
    add_case({std::string("certified.") + name, surface, "3", "rate" + std::to_string(rate), "-", threads},
             quick ? Part::quick : Part::full,
             [=, timed = timed](benchmark::State& state) { certify(state, surface, rate, threads, timed); });
  }
}

const bool registered = [] {
  add_surface("bicubic25", 8, 1);  // where costs other than those of the patches count
  for (const int threads : {1, 2}) {
    for (const int rate : {4, 8, 12, 17}) add_surface("bicubic20000", rate, threads);
    for (const int rate : {4, 8}) add_surface("rational10000", rate, threads);
  }
  return true;
}();

}}  // namespace tessera::bench
