#include "exact/swept_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

Result<FaceSurface> with_parameters(Result<BSplineSurface> surface, const Reparametrization& parameters,
                                    double fit_error) {
  if (!surface) return surface.status();
  return FaceSurface{*std::move(surface), parameters, fit_error};
}

Result<FaceSurface> revolved(const Frame& frame, const Interval& angles, const SplineLine& profile) {
  const Arcs turn(angles.from, angles.to);
  std::vector<Vec3> points;
  std::vector<double> weights;
  const std::vector<Arcs::Point> arcs = turn.points();
  points.reserve(arcs.size() * profile.points.size());
  weights.reserve(arcs.size() * profile.points.size());
  for (const Arcs::Point& arc : arcs)
    for (std::size_t k = 0; k < profile.points.size(); ++k) {
      const Vec3& p = profile.points[k];
      points.push_back(frame.at({arc.cosine * p.x - arc.sine * p.y, arc.sine * p.x + arc.cosine * p.y, p.z}));
      weights.push_back(arc.weight * profile.weight(k));
    }
  const Domain domain{angles.from, angles.to, profile.range.from, profile.range.to};
  return with_parameters(BSplineSurface::rational(2, turn.knots(), profile.degree, profile.knots, std::move(points),
                                                  std::move(weights), domain),
                         {turn, profile.arcs}, profile.fit_error);
}

Result<FaceSurface> extruded(const SplineLine& profile, const Vec3& direction, const Interval& range) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  points.reserve(2 * profile.points.size());
  weights.reserve(2 * profile.points.size());
  for (std::size_t k = 0; k < profile.points.size(); ++k)
    for (const double v : {range.from, range.to}) {
      points.push_back(profile.points[k] + v * direction);
      weights.push_back(profile.weight(k));
    }
  const std::vector<double> knots_v{range.from, range.from, range.to, range.to};
  const Domain domain{profile.range.from, profile.range.to, range.from, range.to};
  return with_parameters(BSplineSurface::rational(profile.degree, profile.knots, 1, knots_v, std::move(points),
                                                  std::move(weights), domain),
                         {profile.arcs, {}}, profile.fit_error);
}

Result<FaceSurface> plane_surface(const Frame& frame, const Domain& box) {
  return extruded(straight_line(frame.at({box.u0, 0, 0}), frame.at({box.u1, 0, 0}), range_u(box)), frame.y,
                  range_v(box));
}

Result<FaceSurface> cylinder_surface(const Frame& frame, double radius, const Domain& box) {
  return revolved(frame, range_u(box), straight_line({radius, 0, box.v0}, {radius, 0, box.v1}, range_v(box)));
}

Result<FaceSurface> cone_surface(const Frame& frame, double radius, double half_angle, const Domain& box) {
  const double s = std::sin(half_angle), c = std::cos(half_angle);
  std::array<double, 2> radii{radius + box.v0 * s, radius + box.v1 * s};
  const double largest = std::max(std::abs(radii[0]), std::abs(radii[1]));
  for (double& r : radii)
    if (std::abs(r) < 1e-12 * largest) r = 0;  // the apex
  return revolved(frame, range_u(box),
                  straight_line({radii[0], 0, box.v0 * c}, {radii[1], 0, box.v1 * c}, range_v(box)));
}

Result<FaceSurface> torus_surface(const Frame& frame, double major, double minor, const Domain& box) {
  return revolved(frame, range_u(box), ellipse_arcs({major, 0, 0}, {minor, 0, 0}, {0, 0, minor}, range_v(box)));
}

}}  // namespace tessera::abi_0_1
