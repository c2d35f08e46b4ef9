#include "tessera/nurbs_surface.h"

#include <cmath>
#include <string>

#include "base/text.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct Frame {
  Vec3 origin, x, y, z;
  /// Returns the point at (x, y, z) of the frame.
  Vec3 at(const Vec3& p) const { return origin + (p.x * x + p.y * y) + p.z * z; }
};

Result<Frame> frame_of(const Axis& axis) {
  if (!is_finite(axis.origin) || !is_finite(axis.direction) || !is_finite(axis.zero))
    return Status(StatusCode::non_finite, "the axis must be finite");
  const Vec3 z = normalized(axis.direction), zero = normalized(axis.zero);
  if (z == Vec3{}) return Status(StatusCode::invalid_argument, "the axis has no direction");
  const Vec3 across = zero - dot(zero, z) * z;
  if (!(length(across) > 1e-8))
    return Status(StatusCode::invalid_argument, "the direction of angle zero is parallel to the axis");
  const Vec3 x = normalized(across);
  return Frame{axis.origin, x, cross(z, x), z};
}

Status check_positive(double value, const char* name) {
  if (!std::isfinite(value))
    return {StatusCode::non_finite, std::string(name) + " is " + text(value) + ", it must be finite"};
  if (!(value > 0))
    return {StatusCode::invalid_argument, std::string(name) + " is " + text(value) + ", it must be above 0"};
  return {};
}

/// The unit circle at z = 0: ends of the arcs and the points between; the first point is repeated at the end.
struct UnitCircle {
  std::vector<Vec3> points;
  std::vector<double> weights, knots;
};

UnitCircle unit_circle(CircleArcs arcs) {
  const double h = std::sqrt(3.0) / 2, r3 = std::sqrt(3.0);
  UnitCircle circle;
  if (arcs == CircleArcs::four)
    circle.points = {{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                     {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}};
  else
    circle.points = {{1, 0, 0}, {1, r3, 0}, {-0.5, h, 0}, {-2, 0, 0}, {-0.5, -h, 0}, {1, -r3, 0}, {1, 0, 0}};
  const double inner = arcs == CircleArcs::four ? std::sqrt(0.5) : 0.5, count = arcs == CircleArcs::four ? 4 : 3;
  for (std::size_t k = 0; k < circle.points.size(); ++k) circle.weights.push_back(k % 2 ? inner : 1);
  circle.knots = {0, 0, 0};
  for (double k = 1; k < count; ++k) circle.knots.insert(circle.knots.end(), {k / count, k / count});
  circle.knots.insert(circle.knots.end(), {1, 1, 1});
  return circle;
}

/// A profile in the frame, with any points and weights, and v's degree and knots.
struct Profile {
  int degree = 1;
  std::vector<double> knots;
  std::vector<Vec3> points;
  std::vector<double> weights;
  std::optional<Interval> domain;
};

Result<BSplineSurface> revolve(const Profile& profile, const Frame& frame, CircleArcs arcs) {
  const UnitCircle turn = unit_circle(arcs);
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i < turn.points.size(); ++i)
    for (std::size_t j = 0; j < profile.points.size(); ++j) {
      const double c = turn.points[i].x, s = turn.points[i].y;
      const Vec3& p = profile.points[j];
      points.push_back(frame.at({c * p.x - s * p.y, s * p.x + c * p.y, p.z}));
      weights.push_back(turn.weights[i] * (profile.weights.empty() ? 1 : profile.weights[j]));
    }
  std::optional<Domain> domain;
  if (profile.domain) domain = Domain{0, 1, profile.domain->from, profile.domain->to};
  return BSplineSurface::rational(2, turn.knots, profile.degree, profile.knots, points, weights, domain);
}

/// Revolves the straight line from (bottom, 0, 0) to (top, 0, height).
Result<BSplineSurface> revolve_line(const Axis& axis, double bottom, double top, double height, CircleArcs arcs) {
  const Result<Frame> frame = frame_of(axis);
  if (!frame) return frame.status();
  if (!std::isfinite(height))
    return Status(StatusCode::non_finite, "the height is " + text(height) + ", it must be finite");
  if (height == 0) return Status(StatusCode::invalid_argument, "the height is 0");
  return revolve({1, {0, 0, 1, 1}, {{bottom, 0, 0}, {top, 0, height}}, {}, {}}, *frame, arcs);
}

}  // namespace

Result<Curve> make_nurbs_circle(const Axis& axis, double radius, CircleArcs arcs) {
  return guarded([&]() -> Result<Curve> {
    const Result<Frame> frame = frame_of(axis);
    if (!frame) return frame.status();
    if (Status status = check_positive(radius, "the radius"); !status.ok()) return status;
    UnitCircle turn = unit_circle(arcs);
    for (Vec3& p : turn.points) p = frame->at(radius * p);
    return Curve::nurbs(2, turn.points, turn.weights, turn.knots);
  });
}

Result<BSplineSurface> make_surface_of_revolution(const Curve& profile, const Axis& axis, CircleArcs arcs) {
  return guarded([&]() -> Result<BSplineSurface> {
    const Result<Frame> frame = frame_of(axis);
    if (!frame) return frame.status();
    Profile local{profile.degree(), {profile.knots().begin(), profile.knots().end()}, {}, {}, profile.domain()};
    local.weights.assign(profile.weights().begin(), profile.weights().end());
    for (const Vec3& p : profile.points()) {
      const Vec3 d = p - frame->origin;
      local.points.push_back({dot(d, frame->x), dot(d, frame->y), dot(d, frame->z)});
    }
    return revolve(local, *frame, arcs);
  });
}

Result<BSplineSurface> make_nurbs_sphere(const Axis& axis, double radius, CircleArcs arcs) {
  return guarded([&]() -> Result<BSplineSurface> {
    const Result<Frame> frame = frame_of(axis);
    if (!frame) return frame.status();
    if (Status status = check_positive(radius, "the radius"); !status.ok()) return status;
    const double r = radius, h = std::sqrt(0.5);
    const std::vector<Vec3> half{{0, 0, -r}, {r, 0, -r}, {r, 0, 0}, {r, 0, r}, {0, 0, r}};
    return revolve({2, {0, 0, 0, 0.5, 0.5, 1, 1, 1}, half, {1, h, 1, h, 1}, {}}, *frame, arcs);
  });
}

Result<BSplineSurface> make_nurbs_torus(const Axis& axis, double major, double minor, CircleArcs arcs) {
  return guarded([&]() -> Result<BSplineSurface> {
    const Result<Frame> frame = frame_of(axis);
    if (!frame) return frame.status();
    if (Status status = check_positive(major, "the major radius"); !status.ok()) return status;
    if (Status status = check_positive(minor, "the minor radius"); !status.ok()) return status;
    if (!(minor < major))
      return Status(StatusCode::invalid_argument,
                    "the minor radius, " + text(minor) + ", is not below the major, " + text(major));
    const UnitCircle tube = unit_circle(arcs);
    std::vector<Vec3> points;
    for (const Vec3& p : tube.points) points.push_back({major + minor * p.x, 0, minor * p.y});
    return revolve({2, tube.knots, points, tube.weights, {}}, *frame, arcs);
  });
}

Result<BSplineSurface> make_nurbs_cylinder(const Axis& axis, double radius, double height, CircleArcs arcs) {
  return guarded([&]() -> Result<BSplineSurface> {
    if (Status status = check_positive(radius, "the radius"); !status.ok()) return status;
    return revolve_line(axis, radius, radius, height, arcs);
  });
}

Result<BSplineSurface> make_nurbs_cone(const Axis& axis, double bottom, double top, double height, CircleArcs arcs) {
  return guarded([&]() -> Result<BSplineSurface> {
    // A radius of 0 at one end is an apex; every other radius must be positive.
    if (bottom != 0 || top == 0)
      if (Status status = check_positive(bottom, "the bottom radius"); !status.ok()) return status;
    if (top != 0)
      if (Status status = check_positive(top, "the top radius"); !status.ok()) return status;
    return revolve_line(axis, bottom, top, height, arcs);
  });
}

}}  // namespace tessera::abi_0_1
