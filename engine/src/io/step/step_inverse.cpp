#include "io/step/step_inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exact/curve_foot.h"
#include "io/step/step_offset.h"
#include "io/step/step_replica.h"
#include "io/step/step_sphere_axis.h"
#include "io/step/step_spline_inverse.h"
#include "io/step/step_transform.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The angle, moved by whole turns to be near another.
double angle_near(double angle, double near) { return angle + full_turn * std::round((near - angle) / full_turn); }

double distance_from_z(const Vec3& p) { return std::sqrt(p.x * p.x + p.y * p.y); }

/// The angle of a point about z, or `near` on the axis.
double angle_about_z(const Vec3& local, double near) {
  if (local.x == 0 && local.y == 0) return near;
  return angle_near(std::atan2(local.y, local.x), near);
}

/// Planes, cylinders, cones, spheres and tori, in closed form.
class ElementaryInverse : public SurfaceInverse {
 public:
  explicit ElementaryInverse(const StepElementary& of) : of_(of) {
    whole_ = of.whole;
    if (of.kind != StepElementaryKind::plane) period_.u = full_turn;
    if (of.kind == StepElementaryKind::torus && std::isfinite(of.whole.v1 - of.whole.v0) &&
        of.whole.v1 - of.whole.v0 >= full_turn)
      period_.v = full_turn;
    turns_u_ = period_.u > 0, turns_v_ = period_.v > 0;
  }

  ParameterPoint at(const Vec3& p, const ParameterPoint& near) const override {
    Vec3 local = of_.frame.local(p);
    const double ring = distance_from_z(local);
    switch (of_.kind) {
      case StepElementaryKind::plane:
        return {local.x, local.y};
      case StepElementaryKind::cylinder:
        return {angle_about_z(local, near.u), local.z};
      case StepElementaryKind::cone: {
        // The nearest point of the line that turns about the axis, or of its part beyond the apex.
        const double s = std::sin(of_.half_angle), c = std::cos(of_.half_angle);
        const double v = (ring - of_.radius) * s + local.z * c, beyond = (-ring - of_.radius) * s + local.z * c;
        const auto off = [&](double at) { return std::abs((at - of_.radius) * c - local.z * s); };
        if (off(-ring) >= off(ring)) return {angle_about_z(local, near.u), v};
        return {angle_about_z({-local.x, -local.y, local.z}, near.u), beyond};
      }
      case StepElementaryKind::sphere:
        return {angle_about_z(local, near.u), std::atan2(local.z, ring)};
      case StepElementaryKind::torus:
        break;
    }
    // A torus that meets itself has two sheets; a point lies on one of them.
    const auto off = [&](double around) { return std::abs(std::hypot(around - of_.radius, local.z) - of_.minor); };
    const bool is_inner = of_.minor > of_.radius && off(-ring) < off(ring);
    if (is_inner) local = {-local.x, -local.y, local.z};
    return {angle_about_z(local, near.u),
            angle_near(std::atan2(local.z, (is_inner ? -ring : ring) - of_.radius), near.v)};
  }

  Vec3 point(const ParameterPoint& place) const override {
    double ring = of_.radius, z = place.v;
    switch (of_.kind) {
      case StepElementaryKind::plane:
        return of_.frame.at({place.u, place.v, 0});
      case StepElementaryKind::cylinder:
        break;
      case StepElementaryKind::cone:
        ring += place.v * std::sin(of_.half_angle), z *= std::cos(of_.half_angle);
        break;
      case StepElementaryKind::sphere:
        ring *= std::cos(place.v), z = of_.radius * std::sin(place.v);
        break;
      case StepElementaryKind::torus:
        ring += of_.minor * std::cos(place.v), z = of_.minor * std::sin(place.v);
        break;
    }
    return of_.frame.at({ring * std::cos(place.u), ring * std::sin(place.u), z});
  }

  ParameterPoint speeds(const ParameterPoint& place) const override {
    switch (of_.kind) {
      case StepElementaryKind::plane:
        return {1, 1};
      case StepElementaryKind::cylinder:
        return {of_.radius, 1};
      case StepElementaryKind::cone:
        return {std::abs(of_.radius + place.v * std::sin(of_.half_angle)), 1};
      case StepElementaryKind::sphere:
        return {std::abs(of_.radius * std::cos(place.v)), of_.radius};
      case StepElementaryKind::torus:
        break;
    }
    return {std::abs(of_.radius + of_.minor * std::cos(place.v)), of_.minor};
  }

  Result<FaceSurface> surface(const Domain& box) const override { return elementary_surface(of_, box); }
  std::optional<double> apex() const override {
    if (of_.kind != StepElementaryKind::cone || of_.half_angle == 0) return {};
    return -of_.radius / std::sin(of_.half_angle);
  }
  const Frame* plane() const override { return of_.kind == StepElementaryKind::plane ? &of_.frame : nullptr; }

 private:
  StepElementary of_;
};

/// The profile, cut to an interval within its range.
SplineLine profile_part(const SplineLine& line, const Interval& range) {
  SplineLine out = line;
  out.range = covered(line.knots, line.degree, range);
  out.arcs.reset();
  return out;
}

/// Curves that are swept. The profile is searched in a plane in which the sweep is a point.
class SweptInverse : public SurfaceInverse {
 public:
  SweptInverse(StepSweep sweep, Curve curve) : sweep_(std::move(sweep)), curve_(std::move(curve)), fast_(curve_) {
    parameters_ = sample_parameters(curve_, 2 + 2 * curve_.degree());
    for (const double t : parameters_) points_.push_back(flat(t).point);
    const Interval d = curve_.domain();
    constexpr double far = std::numeric_limits<double>::infinity();
    whole_ = sweep_.is_turned ? Domain{0, full_turn, d.from, d.to} : Domain{d.from, d.to, -far, far};
    const double length_of_period = d.to - d.from;
    const double size = length(points_.front()) + length(points_.back());
    const bool is_closed = length(position(curve_, d.from) - position(curve_, d.to)) <= 1e-9 * size;
    turns_u_ = sweep_.is_turned;
    if (turns_u_) period_.u = full_turn;
    if (is_closed) (sweep_.is_turned ? period_.v : period_.u) = length_of_period;
  }

  ParameterPoint at(const Vec3& p, const ParameterPoint& near) const override { return places(p, &near); }
  ParameterPoint find(const Vec3& p) const override { return places(p, nullptr); }

  Vec3 point(const ParameterPoint& place) const override {
    if (!sweep_.is_turned) return fast_.point(wrapped(place.u)) + place.v * sweep_.direction;
    const Vec3 p = fast_.point(wrapped(place.v));
    const double c = std::cos(place.u), s = std::sin(place.u);
    return sweep_.frame.at({c * p.x - s * p.y, s * p.x + c * p.y, p.z});
  }

  ParameterPoint speeds(const ParameterPoint& place) const override {
    const CurvePlace jet = fast_(wrapped(sweep_.is_turned ? place.v : place.u));
    if (!sweep_.is_turned) return {length(jet.slope), 1};
    return {distance_from_z(jet.point), length(jet.slope)};
  }

  Result<FaceSurface> surface(const Domain& box) const override {
    if (sweep_.is_turned) return revolved(sweep_.frame, range_u(box), profile_part(sweep_.profile, range_v(box)));
    return extruded(profile_part(sweep_.profile, range_u(box)), sweep_.direction, range_v(box));
  }

  std::array<std::vector<double>, 2> knots() const override {
    std::vector<double> of_profile(curve_.knots().begin(), curve_.knots().end());
    if (sweep_.is_turned) return {std::vector<double>(), std::move(of_profile)};
    return {std::move(of_profile), std::vector<double>()};
  }

 private:
  double wrapped(double t) const {
    const Interval d = curve_.domain();
    const double period = sweep_.is_turned ? period_.v : period_.u;
    if (period > 0 && (t < d.from || t > d.to)) t -= period * std::floor((t - d.from) / period);
    return std::clamp(t, d.from, d.to);
  }

  /// A point of the profile in the plane: (distance from the axis, 0, height), or what is across the direction.
  CurvePlace flat(double t) const {
    const CurvePlace jet = fast_(t);
    if (!sweep_.is_turned) {
      const Vec3& d = sweep_.direction;
      return {jet.point - dot(jet.point, d) * d, jet.slope - dot(jet.slope, d) * d};
    }
    const double ring = distance_from_z(jet.point);
    const double slope = ring > 0 ? (jet.point.x * jet.slope.x + jet.point.y * jet.slope.y) / ring
                                  : std::hypot(jet.slope.x, jet.slope.y);
    return {{ring, 0, jet.point.z}, {slope, 0, jet.slope.z}};
  }

  ParameterPoint places(const Vec3& p, const ParameterPoint* near) const {
    const Vec3 local = sweep_.is_turned ? sweep_.frame.local(p) : p;
    const Vec3 goal =
        sweep_.is_turned ? Vec3{distance_from_z(local), 0, local.z} : p - dot(p, sweep_.direction) * sweep_.direction;
    const double t = parameter(goal, near ? std::optional(sweep_.is_turned ? near->v : near->u) : std::nullopt);
    const Vec3 there = fast_.point(wrapped(t));
    if (!sweep_.is_turned) return {t, dot(p - there, sweep_.direction)};
    const double near_u = near ? near->u : 0;
    if (local.x == 0 && local.y == 0) return {near_u, t};
    const bool on_axis = there.x == 0 && there.y == 0;
    const double zero = on_axis ? 0 : std::atan2(there.y, there.x);
    return {angle_near(std::atan2(local.y, local.x) - zero, near_u), t};
  }

  double parameter(const Vec3& goal, const std::optional<double>& near) const {
    const Interval d = curve_.domain();
    const auto at_t = [&](double t) { return flat(t); };
    const double period = sweep_.is_turned ? period_.v : period_.u;
    double best = 0;
    double distance = std::numeric_limits<double>::infinity();
    if (near) {
      // A step beyond an end of a closed profile goes on at the other one.
      best = refined_foot(at_t, goal, d, wrapped(*near));
      distance = length(flat(best).point - goal);
    }
    if (!(distance <= std::max(tolerance_, off_))) {
      const double other = nearest_foot(at_t, goal, d, parameters_, points_);
      const double nearest = length(flat(other).point - goal);
      if (near && !(nearest < 0.5 * distance)) off_ = 1.5 * distance;
      if (!near || nearest < distance) best = other;
    }
    return period > 0 && near ? best + period * std::round((*near - best) / period) : best;
  }

  StepSweep sweep_;
  Curve curve_;
  FastCurve fast_;
  std::vector<double> parameters_;
  std::vector<Vec3> points_;  ///< in the plane
  mutable double off_ = 0;    ///< as in SplineInverse; an inverse serves one thread
};

}  // namespace

bool SurfaceInverse::is_pole_u(const ParameterPoint& place) const {
  const double width = period_.u > 0 ? period_.u : whole_.u1 - whole_.u0;
  return std::isfinite(width) && speeds(place).u * width <= tolerance_;
}

bool SurfaceInverse::is_pole_v(const ParameterPoint& place) const {
  const double width = period_.v > 0 ? period_.v : whole_.v1 - whole_.v0;
  return std::isfinite(width) && speeds(place).v * width <= tolerance_;
}

std::unique_ptr<SurfaceInverse> SurfaceInverse::of_plane(const Frame& frame, double tolerance) {
  StepElementary plane;
  plane.frame = frame;
  constexpr double far = std::numeric_limits<double>::infinity();
  plane.whole = {-far, far, -far, far};
  std::unique_ptr<SurfaceInverse> out = std::make_unique<ElementaryInverse>(plane);
  out->tolerance_ = tolerance;
  return out;
}

/// Makes the inverse of a surface at a distance from another: exact where that is elementary, else fitted as far as the
/// points reach.
Result<std::unique_ptr<SurfaceInverse>> SurfaceInverse::make_offset(const StepGeometry& geometry,
                                                                    const StepOffset& offset, const Box3& extent,
                                                                    double tolerance) {
  Result<std::optional<StepElementary>> simple = geometry.elementary(offset.basis);
  if (simple && !*simple) simple = geometry.elementary_sweep(offset.basis, extent);
  if (!simple) return simple.status();
  if (*simple) {
    const Result<StepElementary> moved = offset_by(**simple, offset.distance);
    if (!moved) return moved.status();
    std::unique_ptr<SurfaceInverse> out = std::make_unique<ElementaryInverse>(*moved);
    out->tolerance_ = tolerance;
    return out;
  }
  Box3 wider = extent;
  const double far = std::abs(offset.distance);
  if (!extent.empty())
    wider.extend(extent.lower - Vec3{far, far, far}), wider.extend(extent.upper + Vec3{far, far, far});
  const Result<std::unique_ptr<SurfaceInverse>> basis = make(geometry, offset.basis, wider, tolerance);
  if (!basis) return basis.status();
  Domain box = (*basis)->whole();
  if (!std::isfinite(box.v1 - box.v0)) {  // an extrusion
    const double middle = (*basis)->find(wider.centre()).v;
    box.v0 = middle - wider.diagonal(), box.v1 = middle + wider.diagonal();
  }
  const Result<FaceSurface> surface = (*basis)->surface(box);
  if (!surface) return surface.status();
  Result<FaceSurface> fit = offset_by(surface->surface, offset.distance, 0.1 * tolerance);
  if (!fit) return fit.status();
  std::unique_ptr<SurfaceInverse> out = make_spline_inverse(std::move(fit->surface), tolerance);
  out->tolerance_ = tolerance;
  out->fit_error_ = fit->fit_error;
  return out;
}

/// Makes the inverse of a surface's copy.
Result<std::unique_ptr<SurfaceInverse>> SurfaceInverse::make_replica(const StepGeometry& geometry,
                                                                     const StepReplica& replica, const Box3& extent,
                                                                     double tolerance) {
  const Affine back = inverse_place(replica.map);
  Box3 there;
  for (int k = 0; k < 8 && !extent.empty(); ++k)
    there.extend(back.point({k & 1 ? extent.upper.x : extent.lower.x, k & 2 ? extent.upper.y : extent.lower.y,
                             k & 4 ? extent.upper.z : extent.lower.z}));
  Result<std::unique_ptr<SurfaceInverse>> parent = make(geometry, replica.parent, there, tolerance);
  if (!parent) return parent.status();
  return make_replica_inverse(*std::move(parent), replica.map, tolerance);
}

Result<std::unique_ptr<SurfaceInverse>> SurfaceInverse::make(const StepGeometry& geometry, std::uint64_t surface,
                                                             const Box3& extent, double tolerance,
                                                             std::span<const Curve* const> borders) {
  surface = geometry.bare_surface(surface);
  const Result<std::optional<StepReplica>> replica = geometry.replica(surface);
  if (!replica) return replica.status();
  if (*replica) return make_replica(geometry, **replica, extent, tolerance);
  const Result<std::optional<StepOffset>> offset = geometry.offset(surface);
  if (!offset) return offset.status();
  if (*offset) return make_offset(geometry, **offset, extent, tolerance);
  const Result<std::optional<StepElementary>> simple = geometry.elementary(surface);
  if (!simple) return simple.status();
  std::unique_ptr<SurfaceInverse> out;
  if (*simple) {
    const bool is_sphere = (*simple)->kind == StepElementaryKind::sphere;
    out = std::make_unique<ElementaryInverse>(is_sphere ? off_poles(**simple, borders, tolerance) : **simple);
  } else {
    Result<std::optional<StepSweep>> sweep = geometry.sweep(surface, extent);
    if (!sweep) return sweep.status();
    if (*sweep) {
      Result<Curve> curve = curve_of((*sweep)->profile);
      if (!curve) return curve.status();
      out = std::make_unique<SweptInverse>(*std::move(*sweep), *std::move(curve));
    } else {
      Result<FaceSurface> spline = geometry.surface(surface);
      if (!spline) return spline.status();
      out = make_spline_inverse(std::move(spline->surface), tolerance);
    }
  }
  out->tolerance_ = tolerance;
  return out;
}

}}  // namespace tessera::abi_0_1
