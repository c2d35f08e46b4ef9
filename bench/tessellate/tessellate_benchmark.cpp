// Meshes at one rate (positions, normals, parameters and triangles), and the packing of patches into blocks. Each mesh
// is checked against the reference evaluators and the shape of its triangles, each set of blocks by evaluation from it.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "sets.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "tessera/tessellation.h"
#include "timing.h"

namespace tessera::bench { namespace {

using test::value_of;

constexpr int rate = 8;

/// Checks every 50th patch: the vertices of its triangles lie on it, with its normals.
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
  const Tessellation plan = value_of(Tessellation::make(set, {.rates = UniformRates{rate, rate}}));
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

/// A kind of packing: blocks of one kind.
struct Packing {
  const char* name;  ///< of the operation
  bool rational;
  BlockKinds kinds;
  double bytes_per_value;  ///< of the blocks

  double bytes_per_patch() const { return 16 * (rational ? 4 : 3) * bytes_per_value; }
};

constexpr BlockKinds only(bool BlockKinds::*kind) {
  BlockKinds kinds{.float_bernstein = false};
  kinds.*kind = true;
  return kinds;
}

const Packing packings[] = {{"pack", false, only(&BlockKinds::float_bernstein), 4},
                            {"pack.rational", true, only(&BlockKinds::float_bernstein), 4},
                            {"pack.double", false, only(&BlockKinds::double_bernstein), 8},
                            {"pack.power", false, only(&BlockKinds::float_power), 4},
                            {"pack.points", false, only(&BlockKinds::float_points), 4}};

/// Checks grids of 3 x 3 from the blocks, or the middles of patches from points, against the reference evaluator.
template <class T>
bool grids_lie_on(const PatchSet& set, const GridPlanOptions& options) {
  const auto t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t, options));
  std::vector<T> memory(3 * plan.capacity());
  if (!evaluate(set, plan, QuantityViews<T>{.position = View3<T>::interleaved(memory)}).ok()) return false;
  const Vec3 origin = sizeof(T) == 4 ? set.origin() : Vec3{};
  for (std::size_t patch = 0; patch < set.patch_count(); patch += 50) {
    const T* p = &memory[3 * (9 * patch + 4)];
    const Vec3 expected = evaluate_jet(set.patch(patch), 0.5, 0.5).position;
    const Vec3 apart = origin + Vec3{double{p[0]}, double{p[1]}, double{p[2]}} - expected;
    if (!(max_abs(apart) <= 1e-5 * set.box().diagonal())) return false;
  }
  return true;
}
bool points_lie_on(const PatchSet& set) {
  std::vector<std::uint32_t> patch;
  for (std::size_t k = 0; k < set.patch_count(); k += 50) patch.push_back(static_cast<std::uint32_t>(k));
  const std::vector<float> half(patch.size(), 0.5f);
  std::vector<float> out(3 * patch.size());
  const PatchSamples<float> samples{View1<const std::uint32_t>::interleaved(patch),
                                    View1<const float>::interleaved(half), View1<const float>::interleaved(half)};
  if (!evaluate(set, samples, QuantityViews<float>{.position = View3<float>::interleaved(out)}, {}).ok()) return false;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3 p = set.origin() + Vec3{out[3 * k], out[3 * k + 1], out[3 * k + 2]};
    if (!(max_abs(p - evaluate_jet(set.patch(patch[k]), 0.5, 0.5).position) <= 1e-5 * set.box().diagonal()))
      return false;
  }
  return true;
}
bool holds(const PatchSet& set) {
  if (set.blocks().float_points) return points_lie_on(set);
  if (set.blocks().double_bernstein) return grids_lie_on<double>(set, {.precision = Precision::double_precision});
  return grids_lie_on<float>(
      set, {.representation = set.blocks().float_power ? Representation::power : Representation::bernstein});
}

void pack(benchmark::State& state, const Packing& packing, int threads) {
  std::vector<BezierPatch> patches = test::wavy_field(200, 100);
  if (packing.rational) {
    const PatchSet& weighted = set_named("rational20000");
    for (std::size_t k = 0; k < patches.size(); ++k) patches[k] = weighted.patch(k);
  }
  const double bytes = static_cast<double>(patches.size()) * packing.bytes_per_patch();
  const LimitsAround around({}, bytes);
  const PatchSetOptions options{.blocks = packing.kinds};
  const auto best = time_calls(state, threads, [&] { return PatchSet::make(patches, options).status(); });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  if (!holds(value_of(PatchSet::make(patches, options))))
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
    for (const Packing& packing : packings)
      add_case({packing.name, "bicubic20000", packing.rational ? "3r" : "3", "20000", "-", threads}, part,
               [&packing, threads](benchmark::State& state) { pack(state, packing, threads); });
  }
  return true;
}();

}}  // namespace tessera::bench
