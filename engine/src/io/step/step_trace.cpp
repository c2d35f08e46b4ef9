#include "io/step/step_trace.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "convert/fit/lobatto_fit.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Parameters at which an edge is sampled, from its start: several between two knots.
std::vector<double> trace_parameters(const Curve& curve) {
  const Interval d = curve.domain();
  const std::vector<double> breaks = breaks_of(curve.knots(), d);
  const std::size_t spans = breaks.size() - 1;
  const bool is_straight = curve.degree() == 1 && !curve.is_rational();
  const std::size_t each = is_straight ? (spans > 4 ? 2 : 4) : spans > 16 ? 2 : 4;
  // A fit over one or two spans takes its places from here.
  const std::vector<double>& nodes = LobattoTables::of_degree_7().nodes;
  const bool is_short = !is_straight && spans <= 2;
  std::vector<double> out;
  for (std::size_t k = 0; k < spans; ++k)
    for (std::size_t i = 0; i < (is_short ? nodes.size() - 1 : each); ++i) {
      const double x = is_short ? nodes[i] : static_cast<double>(i) / static_cast<double>(each);
      out.push_back(breaks[k] + x * (breaks[k + 1] - breaks[k]));
    }
  out.push_back(d.to);
  return out;
}

}  // namespace

std::optional<double> constant_parameter(const SurfaceInverse& inverse, const EdgeTrace& piece, bool along_u,
                                         double tolerance) {
  const auto of = [&](const ParameterPoint& p) { return along_u ? p.u : p.v; };
  double low = of(piece.first()), high = low, speed = 0;
  for (const TraceSample& sample : piece.samples) {
    low = std::min(low, of(sample.place)), high = std::max(high, of(sample.place));
    speed = std::max(speed, of(inverse.speeds(sample.place)));
  }
  return (high - low) * speed <= 2 * tolerance ? std::optional(0.5 * (low + high)) : std::nullopt;
}

/// Appends a place, and others before it where the parameters move far.
void EdgeTracer::follow(const FastCurve& curve, double to, std::vector<TraceSample>& samples, int depth) const {
  constexpr int max_depth = 8;
  const TraceSample before = samples.back();
  const ParameterPoint place = inverse_.at(curve.point(to), before.place), period = inverse_.period();
  const bool is_far = (period.u > 0 && std::abs(place.u - before.place.u) > period.u / 6) ||
                      (period.v > 0 && std::abs(place.v - before.place.v) > period.v / 6);
  if (is_far && depth < max_depth && !is_pole(place) && !is_pole(before.place)) {
    follow(curve, 0.5 * (before.s + to), samples, depth + 1);
    return follow(curve, to, samples, depth + 1);
  }
  samples.push_back({to, place});
}

/// Gives an end that lies at a pole the parameter that its edge tends to: the parabola through three places near it.
void EdgeTracer::settle_pole(const FastCurve& curve, EdgeTrace& trace, bool at_end) const {
  TraceSample& end = at_end ? trace.samples.back() : trace.samples.front();
  (at_end ? trace.ends_at_pole : trace.starts_at_pole) = is_pole(end.place);
  if (!is_pole(end.place)) return;
  const Interval d = curve.curve().domain();
  const double inwards = (end.s == d.from ? 1 : -1) * 1e-3 * (d.to - d.from);
  ParameterPoint near = (at_end ? trace.samples.end()[-2] : trace.samples[1]).place;
  std::array<ParameterPoint, 3> places;
  for (const int k : {2, 1, 0}) {
    near = inverse_.at(curve.point(end.s + (k + 1) * inwards), near);
    places[static_cast<std::size_t>(k)] = near;
  }
  const auto limit = [](double a, double b, double c) { return 3 * a - 3 * b + c; };
  if (inverse_.is_pole_u(end.place)) end.place.u = limit(places[0].u, places[1].u, places[2].u);
  if (inverse_.is_pole_v(end.place)) end.place.v = limit(places[0].v, places[1].v, places[2].v);
}

EdgeTrace EdgeTracer::trace(std::uint32_t edge, bool reversed, const std::optional<ParameterPoint>& near) const {
  const FastCurve curve(*edges_[edge].curve);
  EdgeTrace out{edge, no_id, reversed, {}, false, false};
  std::vector<double> places = trace_parameters(curve.curve());
  if (reversed) std::ranges::reverse(places);
  std::size_t start = 0;
  std::optional<ParameterPoint> first;
  if (near) first = inverse_.at(curve.point(places[0]), *near);
  if (!first || is_pole(*first)) {
    start = places.size() / 2;
    const Vec3 middle = curve.point(places[start]);
    first = near ? inverse_.at(middle, *near) : inverse_.find(middle);
  }
  out.samples.push_back({places[start], *first});
  for (std::size_t k = start; k > 0; --k) follow(curve, places[k - 1], out.samples, 0);
  std::ranges::reverse(out.samples);
  for (std::size_t k = start + 1; k < places.size(); ++k) follow(curve, places[k], out.samples, 0);
  settle_pole(curve, out, false);
  settle_pole(curve, out, true);
  return out;
}

/// Returns the line along the pole at which two pieces meet, if they leave it at different parameters. The loop keeps
/// the face on its left, so that the line runs towards smaller u where the pole is at the top.
std::optional<EdgeTrace> EdgeTracer::along_pole(const EdgeTrace& before, const EdgeTrace& after,
                                                bool is_closing) const {
  if (!before.ends_at_pole || !after.starts_at_pole) return {};
  const ParameterPoint a = before.last();
  const bool along_u = inverse_.is_pole_u(a);
  const auto along = [&](const ParameterPoint& p) { return along_u ? p.u : p.v; };
  const auto across = [&](const ParameterPoint& p) { return along_u ? p.v : p.u; };
  const double period = along(inverse_.period());
  const bool is_seam = before.edge == after.edge && before.reversed != after.reversed;
  double way = along(after.first()) - along(a);
  if (period > 0) {
    // At the top of u lines, and at the left of v lines, the face lies to the right of growing parameters.
    const bool is_high = across(a) > across(before.samples[before.samples.size() / 2].place);
    const bool falls = (along_u == is_high) == agrees_;
    way -= period * std::round(way / period);
    const double tiny = 1e-6 * period;
    if (std::abs(way) < tiny) way = is_seam ? (falls ? -period : period) : way;
    if (falls && way > tiny) way -= period;
    if (!falls && way < -tiny) way += period;
  }
  if (way == 0 || (is_closing && period == 0 && std::abs(way) < 1e-12)) return {};
  ParameterPoint b = a;
  (along_u ? b.u : b.v) += way;
  const BrepEdge& edge = edges_[before.edge];
  return EdgeTrace{no_id, before.reversed ? edge.start : edge.end, false, {{0, a}, {1, b}}, true, true};
}

LoopTrace EdgeTracer::loop(const StepBound& bound, const std::vector<bool>& reversed_curves) const {
  LoopTrace out;
  out.is_outer = bound.is_outer;
  std::unordered_map<std::uint32_t, int> uses;
  for (const StepEdgeUse& use : bound.uses) ++uses[use.edge];
  // A seam has two places. So begin with another edge, whose place is known.
  const auto is_single = [&](const StepEdgeUse& use) { return uses[use.edge] == 1; };
  const auto found = std::ranges::find_if(bound.uses, is_single);
  const std::size_t first = found == bound.uses.end() ? 0 : static_cast<std::size_t>(found - bound.uses.begin());
  std::optional<ParameterPoint> near;
  for (std::size_t k = 0; k < bound.uses.size(); ++k) {
    const StepEdgeUse& use = bound.uses[(first + k) % bound.uses.size()];
    EdgeTrace next = trace(use.edge, use.reversed != reversed_curves[use.edge], near);
    if (!out.pieces.empty()) {
      if (std::optional<EdgeTrace> line = along_pole(out.pieces.back(), next, false)) out.pieces.push_back(*line);
      // The next piece goes on where the line along the pole ends.
      const ParameterPoint end = out.pieces.back().last(), period = inverse_.period();
      const double du = period.u > 0 ? period.u * std::round((end.u - next.first().u) / period.u) : 0;
      const double dv = period.v > 0 ? period.v * std::round((end.v - next.first().v) / period.v) : 0;
      for (TraceSample& sample : next.samples) sample.place.u += du, sample.place.v += dv;
    }
    near = next.last();
    out.pieces.push_back(std::move(next));
  }
  if (out.pieces.empty()) return out;
  if (std::optional<EdgeTrace> line = along_pole(out.pieces.back(), out.pieces.front(), true))
    out.pieces.push_back(*line);
  const ParameterPoint a = out.pieces.front().first(), b = out.pieces.back().last(), period = inverse_.period();
  if (period.u > 0) out.winding.u = std::round((b.u - a.u) / period.u);
  if (period.v > 0) out.winding.v = std::round((b.v - a.v) / period.v);
  return out;
}

}}  // namespace tessera::abi_0_1
