// Transfinite grids, partially bicubic Coons patches: transfinite.PRECISION.LAYOUT. Each case checks the values that it
// timed against the scalar evaluator. The limit is the time to store the output; times_pointwise is the time of
// evaluate_jet() per point over the case's.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "base/aligned.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/parametric_surface.h"
#include "timing.h"

namespace tessera::bench { namespace {

using test::value_of;

struct Case {
  bool callables;    ///< whether borders are functions; otherwise NURBS and B-spline curves
  bool twice;        ///< double precision
  bool arrays;       ///< an array per component; otherwise triples
  std::size_t size;  ///< parameters per direction
  Isa isa;
  int threads;

  CaseName name() const {
    const std::string operation =
        std::string("transfinite.") + (twice ? "double." : "float.") + (arrays ? "arrays" : "interleaved");
    return {
        operation, callables ? "coons-callables" : "coons-curves", "-", square(size), std::string(tessera::name(isa)),
        threads};
  }
};

/// Four borders over the unit square, in waves.
CoonsPatch patch_of(bool callables) {
  CoonsOptions options{.f = Blend::cubic(), .g = Blend::cubic()};
  if (callables) {
    const auto u_line = [](double v) {
      return value_of(ParametricCurve::make({.position = [=](double u) {
        return Vec3{u, v, 0.1 * std::sin(9 * u + v)};
      }}));
    };
    const auto v_line = [](double u) {
      return value_of(ParametricCurve::make({.position = [=](double v) {
        return Vec3{u, v, 0.1 * std::sin(9 * u + v)};
      }}));
    };
    return value_of(CoonsPatch::make({u_line(0), u_line(1), v_line(0), v_line(1)}, options));
  }
  const std::vector<double> knots{0, 0, 0, 0, 0.3, 0.6, 1, 1, 1, 1}, weights{1, 2, 1, 0.5, 1, 1};
  const auto curve = [&](const Vec3& from, const Vec3& to, bool rational) {
    std::vector<Vec3> points;
    for (int k = 0; k < 6; ++k)
      points.push_back(from + (k / 5.0) * (to - from) + Vec3{0, 0, k % 5 == 0 ? 0 : 0.1 * (k % 3)});
    return value_of(rational ? Curve::nurbs(3, points, weights, knots) : Curve::b_spline(3, points, knots));
  };
  const Vec3 r00{0, 0, 0}, r01{0, 1, 0.5}, r10{1, 0, 0.2}, r11{1, 1, 0};
  return value_of(CoonsPatch::make(
      {curve(r00, r10, true), curve(r01, r11, false), curve(r00, r01, false), curve(r10, r11, true)}, options));
}

/// Sets TESSERA_ISA, and restores it at the end of its lifetime.
class ForcedIsa {
 public:
  explicit ForcedIsa(Isa isa) {
    if (const char* before = std::getenv("TESSERA_ISA")) before_ = before;
    setenv("TESSERA_ISA", std::string(tessera::name(isa)).c_str(), 1);
  }
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;
  ~ForcedIsa() { before_ ? setenv("TESSERA_ISA", before_->c_str(), 1) : unsetenv("TESSERA_ISA"); }

 private:
  std::optional<std::string> before_;
};

/// Checks every 37th point against the scalar evaluator.
template <class T>
bool check_values(const CoonsPatch& patch, const std::vector<double>& t, const View3<T>& out) {
  const double tolerance = sizeof(T) == 4 ? 1e-5 : 1e-13;
  for (std::size_t k = 0; k < t.size() * t.size(); k += 37) {
    const Vec3 expected = value_of(position(patch, t[k / t.size()], t[k % t.size()]));
    const Vec3 value{static_cast<double>(out.at(k, 0)), static_cast<double>(out.at(k, 1)),
                     static_cast<double>(out.at(k, 2))};
    if (!(max_abs(value - expected) <= tolerance)) return false;
  }
  return true;
}

/// Seconds per point of evaluate_jet(), the best of several runs over 64 x 64 points.
double pointwise_seconds(const CoonsPatch& patch) {
  double best = 1e30;
  for (int run = 0; run < 5; ++run) {
    Vec3 sum;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 64; ++i)
      for (int j = 0; j < 64; ++j) sum += evaluate_jet(patch, i / 63.0, j / 63.0)->position;
    best = std::min(best, seconds_since(start) / 4096);
    benchmark::DoNotOptimize(sum);
  }
  return best;
}

template <class T>
void run(benchmark::State& state, const Case& c) {
  const CoonsPatch patch = patch_of(c.callables);
  const std::vector<double> t = uniform_parameters(static_cast<int>(c.size));
  const std::size_t points = c.size * c.size, bytes = 3 * points * sizeof(T);
  AlignedVector<T> memory(3 * points);
  const std::span<T> all(memory);
  const View3<T> out =
      c.arrays ? View3<T>::soa({all.subspan(0, points), all.subspan(points, points), all.subspan(2 * points)})
               : View3<T>::interleaved(all);
  std::optional<ForcedIsa> forced(c.isa);
  const LimitsAround around(c.isa, static_cast<double>(bytes));
  ExecutionReport report;
  Execution execution;
  execution.report = &report;
  const auto best = time_calls(state, c.threads, [&] { return evaluate(patch, t, t, out, execution); });
  const auto limits = around.best(state);
  forced.reset();
  if (!best || !limits) return;
  if (report.isa != c.isa) return state.SkipWithError("another instruction set ran than was asked for");
  if (!check_values(patch, t, out)) return state.SkipWithError("the timed values differ from the scalar evaluator");
  report_rates(state, *best, static_cast<double>(points), static_cast<double>(bytes));
  if (c.threads == 1 && limits->plain_store_bytes_per_second > 0) {  // views are written by plain stores
    const double seconds = static_cast<double>(bytes) / limits->plain_store_bytes_per_second;
    state.counters["limit_fraction"] = seconds / *best;
  }
  state.counters["times_pointwise"] = pointwise_seconds(patch) * static_cast<double>(points) / *best;
}

void add(const Case& c) {
  add_case(c.name(), c.threads == 1 ? quick_on_fastest(c.isa) : Part::full,
           [c](benchmark::State& state) { c.twice ? run<double>(state, c) : run<float>(state, c); });
}

const bool registered = [] {
  for (const Isa isa : available_isas()) {
    for (const bool callables : {true, false}) add({callables, false, false, 1024, isa, 1});
    add({true, false, true, 1024, isa, 1});
    add({true, true, false, 1024, isa, 1});
    add({true, false, false, 1024, isa, 2});
  }
  return true;
}();

}}  // namespace tessera::bench
