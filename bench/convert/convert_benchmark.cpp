// The other conversions: convert.KIND, to Bezier patches of other degrees or from other kinds of surfaces. Each is
// checked against its own surface's reference evaluator before the rate, patches per second, is reported. Most allocate
// a little for each patch, so there is no limit of the machine to compare them with.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "convert/wavy_surface.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/bezier_operations.h"
#include "tessera/convert.h"
#include "tessera/coons_patch.h"
#include "tessera/hermite_patch.h"
#include "tessera/parametric_surface.h"
#include "timing.h"

namespace tessera::bench { namespace {

using test::value_of;

Vec3 position_at(const SurfaceJet& jet) { return jet.position; }
template <class T>
Vec3 position_at(const Result<T>& result) {
  return position_at(value_of(result));
}

/// Whether the patches agree with `surface` at parameters spread over the domain.
template <class Surface>
bool same(const PatchGrid& grid, const Surface& surface, double tolerance) {
  const Domain domain = grid.domain();
  for (int k = 0; k < 500; ++k) {
    const double s = std::fmod(0.618034 * k, 1), t = k / 499.0;
    const double u = domain.u0 + s * (domain.u1 - domain.u0), v = domain.v0 + t * (domain.v1 - domain.v0);
    const auto jet = grid.evaluate_jet(u, v);
    if (!jet || !(max_abs(jet->position - position_at(evaluate_jet(surface, u, v))) <= tolerance)) return false;
  }
  return true;
}

/// Times `convert`, which returns a Result<PatchGrid>.
template <class Surface, class Convert>
void run(benchmark::State& state, const Surface& surface, double tolerance, const Convert& convert) {
  const Result<PatchGrid> checked = convert();
  if (!checked) return state.SkipWithError(checked.status().message().c_str());
  if (!same(*checked, surface, tolerance)) return state.SkipWithError("the patches are not the surface");
  const auto best = time_calls(state, 1, [&] { return convert().status(); });
  if (best) report_rates(state, *best, static_cast<double>(checked->patches().size()));
}

/// Elevates every patch of a field to degree 5 in both directions.
void elevate_patches(benchmark::State& state) {
  const std::vector<BezierPatch> patches = test::wavy_field(40, 25);
  std::vector<BezierPatch> out = patches;
  const auto best = time_calls(state, 1, [&]() -> Status {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      Result<BezierPatch> elevated = elevate_degree(patches[k], 5, 5);
      if (!elevated) return elevated.status();
      out[k] = std::move(*elevated);
    }
    return {};
  });
  if (!best) return;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const double u = std::fmod(0.37 * static_cast<double>(k), 1), v = std::fmod(0.73 * static_cast<double>(k), 1);
    const Vec3 apart = evaluate_jet(out[k], u, v).position - evaluate_jet(patches[k], u, v).position;
    if (out[k].degree_u() != 5 || !(max_abs(apart) <= 1e-13 * 40))
      return state.SkipWithError("the patches are not those of lower degree");
  }
  report_rates(state, *best, static_cast<double>(patches.size()));
}

/// Elevates a B-spline surface to degree 4 in both directions, then converts it to patches.
void elevate_spline(benchmark::State& state) {
  const BSplineSurface surface = value_of(wavy_surface(50, 3, false));
  run(state, surface, 1e-11, [&]() -> Result<PatchGrid> {
    const Result<BSplineSurface> higher = elevate_degree(surface, 1, 1);
    if (!higher) return higher.status();
    return to_bezier(*higher);
  });
}

void hermite(benchmark::State& state) {
  constexpr std::size_t side = 33;
  std::vector<double> knots;
  std::vector<HermiteNode> nodes;
  for (std::size_t i = 0; i < side; ++i) knots.push_back(static_cast<double>(i));
  for (const double u : knots)
    for (const double v : knots)
      nodes.push_back({{u, v, std::sin(0.7 * u) * std::cos(0.5 * v)},
                       {1, 0, 0.7 * std::cos(0.7 * u) * std::cos(0.5 * v)},
                       {0, 1, -0.5 * std::sin(0.7 * u) * std::sin(0.5 * v)},
                       {}});
  const auto twisted = value_of(estimate_twists(TwistEstimate::adini, knots, knots, nodes));
  const HermiteNetwork network = value_of(HermiteNetwork::on_knots(knots, knots, twisted));
  run(state, network, 1e-12 * side, [&] { return to_bezier(network); });
}

/// A cubic B-spline of 64 spans from one point to another, with waves between.
Curve border(const Vec3& from, const Vec3& to, bool rational) {
  constexpr int spans = 64, points = spans + 3;
  std::vector<double> knots(3, 0.0), weights;
  for (int k = 0; k <= spans; ++k) knots.push_back(k);
  knots.insert(knots.end(), 3, spans);
  std::vector<Vec3> net;
  for (int k = 0; k < points; ++k) {
    const double t = k / (points - 1.0);
    net.push_back(from + t * (to - from) + Vec3{0, 0, std::sin(20 * t) * t * (1 - t)});
    weights.push_back(1 + 0.3 * std::sin(1.7 * k));
  }
  return value_of(rational ? Curve::nurbs(3, net, weights, knots) : Curve::b_spline(3, net, knots));
}

void coons(benchmark::State& state) {
  const Vec3 r00{0, 0, 0}, r01{0, 9, 1}, r10{9, 0, -1}, r11{9, 9, 0};
  const CoonsPatch patch = value_of(CoonsPatch::make(
      {border(r00, r10, false), border(r01, r11, false), border(r00, r01, false), border(r10, r11, false)},
      {.f = Blend::cubic(), .g = Blend::cubic()}));
  run(state, patch, 1e-11, [&] { return to_bezier(patch); });
}

void ruled(benchmark::State& state) {
  const RuledSurface surface =
      value_of(RuledSurface::make(border({0, 0, 0}, {9, 0, 0}, true), border({0, 5, 0}, {9, 5, 3}, true)));
  run(state, surface, 1e-11, [&] { return to_bezier(surface); });
}

/// Fits by samples, without certificate.
void fit(benchmark::State& state) {
  const ParametricSurface surface =
      value_of(ParametricSurface::make({.position =
                                            [](double u, double v) {
                                              return Vec3{u, v, std::sin(3 * u) * std::cos(2 * v)};
                                            }},
                                       {0, 3, 0, 3}));
  run(state, surface, 2e-6, [&] { return to_bezier(surface, {.tolerance = 1e-6, .certify = false}); });
}

const bool registered = [] {
  add_case({"convert.elevate", "bicubic1000", "3", "to5"}, Part::quick, elevate_patches);
  add_case({"convert.elevate", "bspline", "3", square(50)}, Part::quick, elevate_spline);
  add_case({"convert.hermite", "network", "3", square(32)}, Part::quick, hermite);
  add_case({"convert.coons", "bspline", "3", square(64)}, Part::quick, coons);
  add_case({"convert.ruled", "nurbs", "3r", "64"}, Part::quick, ruled);
  add_case({"convert.fit", "callable", "3", "1e-6"}, Part::quick, fit);
  return true;
}();

}}  // namespace tessera::bench
