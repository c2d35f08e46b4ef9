// Bezier extraction of a surface of 200 x 200 spans. The patches are checked against the reference evaluator before the
// rate is reported. The limit is the time to fill as much memory as the points of the patches take.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "convert/wavy_surface.h"
#include "suite.h"
#include "tessera/convert.h"
#include "timing.h"

namespace tessera::bench { namespace {

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
  const double patches = 1.0 * spans * spans;
  const double bytes = patches * (degree + 1) * (degree + 1) * (rational ? 32 : 24);
  const LimitsAround around({}, bytes);
  const auto best = time_calls(state, 1, [&] { return to_bezier(*surface).status(); });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  report_rates(state, *best, patches, bytes);
  report_limit(state, *best, *limits, {.bytes_written = bytes});
}

const bool registered = [] {
  for (const bool rational : {false, true})
    for (const int degree : {2, 3, 5})
      add_case({"extract", rational ? "nurbs" : "bspline", std::to_string(degree), square(spans)},
               degree == 3 ? Part::quick : Part::full, [=](benchmark::State& state) { run(state, degree, rational); });
  return true;
}();

}}  // namespace tessera::bench
