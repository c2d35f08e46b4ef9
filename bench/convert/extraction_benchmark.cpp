// Bezier extraction: extraction/KIND/DEGREE of a surface of 200 x 200 spans. The patches are checked against the
// reference evaluator before the rate is reported; store_fraction is the time to fill as much memory as the points of
// the patches take, measured in the same process, over the time of one conversion.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "tessera/limits.h"
#include "tessera/spline_convert.h"

namespace tessera::bench {
namespace {

constexpr int spans = 200;

Result<BSplineSurface> wavy_surface(int degree, bool rational) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  for (int k = 0; k <= spans; ++k) knots.push_back(k);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), spans);
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i < spans + degree; ++i)
    for (int j = 0; j < spans + degree; ++j) {
      points.push_back({1.0 * i, 1.0 * j, std::sin(0.1 * i) * std::cos(0.2 * j)});
      weights.push_back(1 + 0.5 * std::sin(1.0 * i * j));
    }
  if (!rational) return BSplineSurface::polynomial(degree, knots, degree, knots, points);
  return BSplineSurface::rational(degree, knots, degree, knots, points, weights);
}

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
  const auto surface = wavy_surface(degree, rational);
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
