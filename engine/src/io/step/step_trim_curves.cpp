#include "io/step/step_trim_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convert/fit/lobatto_fit.h"
#include "exact/coedge_parameter.h"
#include "exact/spline_jets.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The curve with mapped points; backwards if `reversed`.
template <class Map>
Result<Curve> mapped_curve(const Curve& curve, bool reversed, const Map& map) {
  std::vector<Vec3> points;
  for (const Vec3& p : curve.points()) points.push_back(map(p));
  std::vector<double> weights(curve.weights().begin(), curve.weights().end());
  std::vector<double> knots(curve.knots().begin(), curve.knots().end());
  const Interval d = curve.domain();
  if (reversed) {
    std::ranges::reverse(points);
    std::ranges::reverse(weights);
    std::ranges::reverse(knots);
    for (double& knot : knots) knot = knot == d.from ? d.to : knot == d.to ? d.from : d.from + d.to - knot;
  }
  return weights.empty() ? Curve::b_spline(curve.degree(), points, knots, d)
                         : Curve::nurbs(curve.degree(), points, weights, knots, d);
}

Result<Curve> straight_curve(const Vec3& a, const Vec3& b, const Interval& range) {
  const std::array<Vec3, 2> points{a, b};
  const std::array<double, 4> knots{range.from, range.from, range.to, range.to};
  return Curve::b_spline(1, points, knots);
}

bool is_line_or_conic(const Curve& edge) {
  return (edge.degree() == 1 && edge.points().size() == 2) || (edge.degree() == 2 && edge.is_rational());
}

/// A parameter, and the value of a function there.
struct Valued {
  double s, value;
};
/// Finds where a function is zero, between parameters at which it has different signs, by false position with halved
/// weights (the Illinois method; Dowell and Jarratt 1971). Ends after 60 steps.
template <class Function>
double root_between(Valued a, Valued b, const Function& f) {
  const double tiny = 1e-15 * std::abs(b.s - a.s);
  for (int step = 0; step < 60 && a.value != b.value && std::abs(b.s - a.s) > tiny; ++step) {
    Valued c{b.s - b.value * (b.s - a.s) / (b.value - a.value), 0};
    c.value = f(c.s);
    if (c.value == 0) return c.s;
    if (std::abs(c.s - b.s) <= tiny) return c.s;
    if ((c.value < 0) == (b.value < 0))
      a.value *= 0.5;
    else
      a = b;
    b = c;
  }
  return b.s;
}

}  // namespace

double TrimCurveMaker::our(bool along_u, double theirs) const {
  const std::optional<Arcs>& arcs = along_u ? parameters_.u : parameters_.v;
  return arcs ? arcs->parameter(theirs) : theirs;
}

ParameterPoint TrimCurveMaker::ours(const ParameterPoint& theirs) const {
  return {our(true, theirs.u), our(false, theirs.v)};
}

/// The place of the sample at a parameter, or nullptr if there is none.
const ParameterPoint* TrimCurveMaker::sampled(const EdgeTrace& piece, double s, double rounding) const {
  const auto before = [&](const TraceSample& sample, double value) {
    return piece.reversed ? sample.s > value + rounding : sample.s < value - rounding;
  };
  const auto found = std::lower_bound(piece.samples.begin(), piece.samples.end(), s, before);
  return found != piece.samples.end() && std::abs(found->s - s) <= rounding ? &found->place : nullptr;
}

/// Interpolates a place by the cubic through the four nearest samples.
ParameterPoint TrimCurveMaker::near(const EdgeTrace& piece, double s) const {
  const auto before = [&](const TraceSample& sample, double value) {
    return piece.reversed ? sample.s > value : sample.s < value;
  };
  const auto& samples = piece.samples;
  const auto next =
      static_cast<std::size_t>(std::lower_bound(samples.begin() + 1, samples.end() - 1, s, before) - samples.begin());
  const std::size_t count = std::min<std::size_t>(4, samples.size());
  const std::size_t first = std::min(next < 2 ? 0 : next - 2, samples.size() - count);
  ParameterPoint out;
  for (std::size_t i = first; i < first + count; ++i) {
    double share = 1;
    for (std::size_t k = first; k < first + count; ++k)
      if (k != i) share *= (s - samples[k].s) / (samples[i].s - samples[k].s);
    out.u += share * samples[i].place.u, out.v += share * samples[i].place.v;
  }
  return out;
}

/// Whether a parameter is the same all along, up to the tolerance; `value`: then a side of the box that is near.
bool TrimCurveMaker::is_constant(const EdgeTrace& piece, bool along_u, double& value) const {
  const std::optional<double> constant = constant_parameter(inverse_, piece, along_u, tolerance_);
  if (!constant) return false;
  value = *constant;
  const Domain& d = box_.domain;
  const double snap = along_u ? box_.tolerance_u : box_.tolerance_v;
  for (const double side : along_u ? std::array{d.u0, d.u1} : std::array{d.v0, d.v1})
    if (std::abs(side - value) <= snap) value = side;
  return true;
}

/// Whether a parameter is a linear function of the edge's, up to the tolerance.
bool TrimCurveMaker::is_linear(const EdgeTrace& piece, bool along_u) const {
  if ((along_u ? parameters_.u : parameters_.v).has_value()) return false;
  const TraceSample &a = piece.samples.front(), &b = piece.samples.back();
  const auto of = [&](const ParameterPoint& p) { return along_u ? p.u : p.v; };
  return std::ranges::all_of(piece.samples, [&](const TraceSample& sample) {
    const double even = of(a.place) + (sample.s - a.s) / (b.s - a.s) * (of(b.place) - of(a.place));
    return std::abs(of(sample.place) - even) * of(inverse_.speeds(sample.place)) <= tolerance_;
  });
}

Result<Curve> TrimCurveMaker::on_plane(const EdgeTrace& piece, const Curve& edge, const Frame& frame) const {
  return mapped_curve(edge, piece.reversed, [&](const Vec3& p) {
    const Vec3 local = frame.local(p);
    return Vec3{local.x, local.y, 0};
  });
}

/// Edge parameters at which the surface's arcs meet, found between samples. An edge that crosses more arcs than a
/// surface has leaves the face's rectangle by far, and the rest of them is not looked for.
std::vector<double> TrimCurveMaker::crossings(const EdgeTrace& piece, const Curve& edge, bool along_u) const {
  constexpr std::size_t max_crossings = 256;
  std::vector<double> out;
  const std::optional<Arcs>& arcs = along_u ? parameters_.u : parameters_.v;
  if (!arcs) return out;
  const FastCurve at_edge(edge);
  const auto value = [&](double s) {
    const ParameterPoint place = inverse_.at(at_edge.point(s), near(piece, s));
    return along_u ? place.u : place.v;
  };
  for (std::size_t k = 0; k + 1 < piece.samples.size(); ++k) {
    const TraceSample &a = piece.samples[k], &b = piece.samples[k + 1];
    const double x = along_u ? a.place.u : a.place.v, y = along_u ? b.place.u : b.place.v;
    const double step = arcs->step(), first = std::ceil((std::min(x, y) - arcs->from()) / step);
    for (double n = first; out.size() < max_crossings && arcs->from() + n * step < std::max(x, y); ++n) {
      const double goal = arcs->from() + n * step;
      out.push_back(root_between({a.s, x - goal}, {b.s, y - goal}, [&](double s) { return value(s) - goal; }));
    }
  }
  return out;
}

/// A curve along one parameter, on which the other one is constant.
Result<Curve> TrimCurveMaker::straight(const EdgeTrace& piece, const Curve& edge, bool along_u, double constant,
                                       Coedge& coedge) const {
  const FastCurve at_edge(edge);
  const Interval d = edge.domain();
  const double a = our(along_u, along_u ? piece.first().u : piece.first().v);
  const double b = our(along_u, along_u ? piece.last().u : piece.last().v);
  const double fixed = our(!along_u, constant);
  const auto at = [&](double t) { return along_u ? Vec3{t, fixed, 0} : Vec3{fixed, t, 0}; };
  if (is_linear(piece, along_u)) return straight_curve(at(a), at(b), d);
  MonotoneFunction f{d, {}, crossings(piece, edge, along_u)};
  f.at = [&, this](double s) {
    const ParameterPoint place = inverse_.at(at_edge.point(s), near(piece, s));
    const double t = our(along_u, along_u ? place.u : place.v);
    return std::clamp(d.from + (d.to - d.from) * (t - a) / (b - a), d.from, d.to);
  };
  for (const double knot : edge.knots())
    if (knot > d.from && knot < d.to) f.breaks.push_back(knot);
  settle_breaks(f);
  state_parameter(f, d, coedge);
  return straight_curve(at(a), at(b), d);
}

Result<Curve> TrimCurveMaker::fitted(const EdgeTrace& piece, const Curve& edge, const double* constant_u,
                                     const double* constant_v) {
  const FastCurve at_edge(edge);
  const Interval d = edge.domain();
  const auto parameter = [&](double t) { return piece.reversed ? d.from + d.to - t : t; };
  double speed_u = 0, speed_v = 0;
  for (const TraceSample& sample : piece.samples) {
    const ParameterPoint speeds = inverse_.speeds(sample.place);
    speed_u = std::max(speed_u, speeds.u), speed_v = std::max(speed_v, speeds.v);
  }
  const auto at = [&](double t) {
    const double s = parameter(t);
    // At a pole, only the trace knows to which parameter the edge tends.
    const ParameterPoint* const known = sampled(piece, s, 1e-14 * (d.to - d.from));
    ParameterPoint place = known ? *known : inverse_.at(at_edge.point(s), near(piece, s));
    if (constant_u) place.u = *constant_u;
    if (constant_v) place.v = *constant_v;
    const ParameterPoint out = ours(place);
    return Vec3{out.u, out.v, 0};
  };
  const auto is_near = [&](const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) * speed_u + std::abs(a.y - b.y) * speed_v <= tolerance_;
  };
  std::vector<double> breaks{d.from, d.to};
  for (const double knot : edge.knots())
    if (knot > d.from && knot < d.to) breaks.push_back(parameter(knot));
  for (const bool along_u : {true, false})
    for (const double s : crossings(piece, edge, along_u)) breaks.push_back(parameter(s));
  std::ranges::sort(breaks);
  const double tiny = 1e-9 * (d.to - d.from);
  std::vector<double> apart{d.from};
  for (const double t : breaks)
    if (t - apart.back() > tiny && d.to - t > tiny) apart.push_back(t);
  apart.push_back(d.to);
  LobattoFit fit;
  fit.follow(at, is_near, apart);
  is_rough_ = is_rough_ || !fit.is_exact_enough();
  return std::move(fit).curve();
}

/// Moves what a curve has beyond the box, by less than the tolerance, onto its sides: the trim would cut it off, and
/// what is cut off meets no other face along the edge.
Result<Curve> TrimCurveMaker::kept_inside(const Curve& curve) const {
  const Domain& d = box_.domain;
  const auto moved = [](double t, double from, double to, double tolerance) {
    const double inside = std::clamp(t, from, to);
    return std::abs(t - inside) <= tolerance ? inside : t;
  };
  const auto map = [&](const Vec3& p) {
    return Vec3{moved(p.x, d.u0, d.u1, box_.tolerance_u), moved(p.y, d.v0, d.v1, box_.tolerance_v), 0};
  };
  const bool is_inside = std::ranges::all_of(curve.points(), [&](const Vec3& p) { return map(p) == p; });
  return is_inside ? curve : mapped_curve(curve, false, map);
}

Result<Curve> TrimCurveMaker::curve_of(const EdgeTrace& piece, const BrepEdge* edge, Coedge& coedge) {
  if (edge == nullptr) {
    const ParameterPoint a = ours(piece.first()), b = ours(piece.last());
    return straight_curve({a.u, a.v, 0}, {b.u, b.v, 0}, {0, 1});
  }
  const Curve& curve = *edge->curve;
  if (const Frame* const frame = inverse_.plane()) return on_plane(piece, curve, *frame);
  double constant = 0;
  const bool along_v = is_constant(piece, true, constant);
  if (!along_v && !is_constant(piece, false, constant)) return fitted(piece, curve, nullptr, nullptr);
  const bool has_arcs = (along_v ? parameters_.v : parameters_.u).has_value();
  if ((has_arcs && is_line_or_conic(curve)) || is_linear(piece, !along_v))
    return straight(piece, curve, !along_v, constant, coedge);
  return fitted(piece, curve, along_v ? &constant : nullptr, along_v ? nullptr : &constant);
}

Status TrimCurveMaker::append(const EdgeTrace& piece, const BrepEdge* edge, TrimLoop& loop) {
  Coedge coedge{piece.edge, piece.reversed, {}};
  const Result<Curve> whole = curve_of(piece, edge, coedge);
  if (!whole) return whole.status();
  Result<Curve> made = kept_inside(*whole);
  if (!made) return made.status();
  loop.curves.push_back(*std::move(made));
  loop.coedges.push_back(std::move(coedge));
  return {};
}

}}  // namespace tessera::abi_0_1
