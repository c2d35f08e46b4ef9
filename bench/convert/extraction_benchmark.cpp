// Bezier extraction: extraction/KIND/DEGREE of a surface of 200 x 200 spans. The patches are checked against the
// reference evaluator before the rate is reported; store_fraction is the time to fill as much memory as the points of
// the patches take, measured in the same process, over the time of one conversion.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "convert/wavy_surface.h"
#include "tessera/limits.h"
#include "tessera/spline_convert.h"

namespace tessera::bench {
namespace {

constexpr int spans = 200;

bool same(const BSplineSurface& surface, const PatchGrid& grid) {
  for (double t = 0; t <= spans; t += 0.37) {
    const double u = t, v = std::fmod(7 * t, spans);
    if (!(max_abs(grid.evaluate_jet(u, v)->position - evaluate_jet(surface, u, v).position) <=
          8 * 0x1p-52 * (spans + 16)))
      return false;
  }
  return true;
}

void run(benchmark::State& state, int degree, bool rational) {
  const auto surface = wavy_surface(spans, degree, rational);
  if (!surface) return state.SkipWithError(surface.status().message().c_str());
  const auto checked = to_bezier(*surface);
  if (!checked || !same(*surface, *checked)) return state.SkipWithError("the patches are not the surface");
  for (auto _ : state) {
    const auto grid = to_bezier(*surface);
    benchmark::DoNotOptimize(grid->patches().data());
  }
  const double patches = 1.0 * spans * spans;
  const double bytes = patches * (degree + 1) * (degree + 1) * (rational ? 32 : 24);
  state.counters["patches_per_second"] = benchmark::Counter(patches, benchmark::Counter::kIsIterationInvariantRate);
  const auto limits = measure_limits({.isa = {}, .store_bytes = static_cast<std::size_t>(bytes)});
  if (!limits) return state.SkipWithError("the machine's limits could not be measured");
  state.counters["store_fraction"] =
      benchmark::Counter(bytes / limits->plain_store_bytes_per_second, benchmark::Counter::kIsIterationInvariantRate);
}

const bool registered = [] {
  for (const bool rational : {false, true})
    for (const int degree : {2, 3, 5})
      benchmark::RegisterBenchmark(
          ("extraction/" + std::string(rational ? "nurbs/" : "bspline/") + std::to_string(degree)).c_str(),
          [=](benchmark::State& state) { run(state, degree, rational); })
          ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace tessera::bench
