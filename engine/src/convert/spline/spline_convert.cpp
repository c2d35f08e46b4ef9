#include "tessera/convert.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "convert/spline/spline_net.h"
#include "surface/net/validate.h"
#include "surface/spline/spline_lines.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::vector<NetPoint> net_points(std::span<const Vec3> points, std::span<const double> weights) {
  std::vector<NetPoint> result;
  result.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) result.push_back({points[k], weights.empty() ? 1 : weights[k]});
  return result;
}

struct PointsAndWeights {
  std::vector<Vec3> points;
  std::vector<double> weights;

  PointsAndWeights(const std::vector<NetPoint>& net, bool rational) {
    for (const NetPoint& p : net) points.push_back(p.point);
    if (rational)
      for (const NetPoint& p : net) weights.push_back(p.weight);
  }
};

SplineNet net_of(const Curve& curve) {
  return {curve.degree(),
          curve.is_rational(),
          1,
          {curve.knots().begin(), curve.knots().end()},
          net_points(curve.points(), curve.weights())};
}

Result<Curve> curve_of(const SplineNet& net, const Interval& domain) {
  const PointsAndWeights data(net.points, net.rational);
  if (net.rational) return Curve::nurbs(net.degree, data.points, data.weights, net.knots, domain);
  return Curve::b_spline(net.degree, data.points, net.knots, domain);
}

/// Calls along_u(net of the rows), then along_v(net of the columns).
template <class AlongU, class AlongV>
Result<BSplineSurface> changed(const BSplineSurface& surface, AlongU along_u, AlongV along_v) {
  const bool rational = surface.is_rational();
  SplineNet u{surface.degree_u(),
              rational,
              surface.count_v(),
              {surface.knots_u().begin(), surface.knots_u().end()},
              net_points(surface.points(), surface.weights())};
  along_u(u);
  SplineNet v{surface.degree_v(),
              rational,
              u.count(),
              {surface.knots_v().begin(), surface.knots_v().end()},
              transposed(u.points, u.width)};
  along_v(v);
  const PointsAndWeights data(transposed(v.points, v.width), rational);
  if (rational)
    return BSplineSurface::rational(u.degree, u.knots, v.degree, v.knots, data.points, data.weights, surface.domain());
  return BSplineSurface::polynomial(u.degree, u.knots, v.degree, v.knots, data.points, surface.domain());
}

Status check_new_knots(const KnotLine& line, std::span<const double> knots, const std::string& name) {
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const auto bad = [&](StatusCode code, const std::string& what) {
      return Status(code, name + "[" + std::to_string(k) + "] = " + text(knots[k]) + what,
                    static_cast<std::ptrdiff_t>(k));
    };
    if (!std::isfinite(knots[k])) return bad(StatusCode::non_finite, ", it must be finite");
    if (!(knots[k] > line.from && knots[k] < line.to))
      return bad(StatusCode::invalid_argument,
                 " is not inside the domain, [" + text(line.from) + ", " + text(line.to) + "]");
    const std::size_t count =
        multiplicity(line.knots, knots[k]) + static_cast<std::size_t>(std::count(knots.begin(), knots.end(), knots[k]));
    if (count > static_cast<std::size_t>(line.degree))
      return bad(StatusCode::invalid_argument, " would have multiplicity " + std::to_string(count) +
                                                   ", above the degree, " + std::to_string(line.degree));
  }
  return {};
}

Status check_elevation(int degree, int by, const char* name) {
  if (by < 0) return {StatusCode::invalid_argument, std::string(name) + " cannot be raised by " + std::to_string(by)};
  return check_degree(by > max_degree ? by : degree + by, name);
}

auto inserting(std::span<const double> knots) {
  return [knots](SplineNet& net) {
    for (const double t : knots) insert_knot(net, t);
  };
}
auto clamping(double from, double to) {
  return [=](SplineNet& net) { clamp(net, from, to); };
}
auto elevating(double from, double to, int by) {
  return [=](SplineNet& net) {
    clamp(net, from, to);
    for (int k = 0; k < by; ++k) net = elevate_degree(net);
  };
}

/// Gives `net` the inner knots of `other` with the same multiplicity.
void merge_knots(SplineNet& net, const SplineNet& other) {
  for (const double t : other.knots) raise_multiplicity(net, t, multiplicity(other.knots, t));
}

}  // namespace

Result<Curve> insert_knots(const Curve& curve, std::span<const double> knots) {
  return guarded([&]() -> Result<Curve> {
    if (Status status = check_new_knots(line_of(curve), knots, "new knots"); !status.ok()) return status;
    SplineNet net = net_of(curve);
    inserting(knots)(net);
    return curve_of(net, curve.domain());
  });
}

Result<BSplineSurface> insert_knots(const BSplineSurface& surface, std::span<const double> knots_u,
                                    std::span<const double> knots_v) {
  return guarded([&]() -> Result<BSplineSurface> {
    if (Status status = check_new_knots(line_u(surface), knots_u, "new knots u"); !status.ok()) return status;
    if (Status status = check_new_knots(line_v(surface), knots_v, "new knots v"); !status.ok()) return status;
    return changed(surface, inserting(knots_u), inserting(knots_v));
  });
}

Result<Curve> clamp_ends(const Curve& curve) {
  return guarded([&]() -> Result<Curve> {
    SplineNet net = net_of(curve);
    clamp(net, curve.domain().from, curve.domain().to);
    return curve_of(net, curve.domain());
  });
}

Result<BSplineSurface> clamp_ends(const BSplineSurface& surface) {
  return guarded([&] {
    const Domain& d = surface.domain();
    return changed(surface, clamping(d.u0, d.u1), clamping(d.v0, d.v1));
  });
}

Result<Curve> elevate_degree(const Curve& curve, int by) {
  return guarded([&]() -> Result<Curve> {
    if (Status status = check_elevation(curve.degree(), by, "the degree"); !status.ok()) return status;
    SplineNet net = net_of(curve);
    elevating(curve.domain().from, curve.domain().to, by)(net);
    return curve_of(net, curve.domain());
  });
}

Result<BSplineSurface> elevate_degree(const BSplineSurface& surface, int by_u, int by_v) {
  return guarded([&]() -> Result<BSplineSurface> {
    if (Status status = check_elevation(surface.degree_u(), by_u, "degree u"); !status.ok()) return status;
    if (Status status = check_elevation(surface.degree_v(), by_v, "degree v"); !status.ok()) return status;
    const Domain& d = surface.domain();
    return changed(surface, elevating(d.u0, d.u1, by_u), elevating(d.v0, d.v1, by_v));
  });
}

Result<std::pair<Curve, Curve>> make_compatible(const Curve& a, const Curve& b) {
  return guarded([&]() -> Result<std::pair<Curve, Curve>> {
    const Interval d = a.domain(), e = b.domain();
    if (!(d == e))
      return Status(StatusCode::invalid_argument, "the curves have different domains, [" + text(d.from) + ", " +
                                                      text(d.to) + "] and [" + text(e.from) + ", " + text(e.to) + "]");
    SplineNet net_a = net_of(a), net_b = net_of(b);
    const int degree = std::max(a.degree(), b.degree());
    elevating(d.from, d.to, degree - a.degree())(net_a);
    elevating(d.from, d.to, degree - b.degree())(net_b);
    merge_knots(net_a, net_b);
    merge_knots(net_b, net_a);
    Result<Curve> first = curve_of(net_a, d), second = curve_of(net_b, d);
    if (!first) return first.status();
    if (!second) return second.status();
    return std::pair<Curve, Curve>(*std::move(first), *std::move(second));
  });
}

}}  // namespace tessera::abi_0_1
