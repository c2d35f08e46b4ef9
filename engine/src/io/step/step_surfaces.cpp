// Surfaces of StepGeometry.

#include <cmath>
#include <limits>
#include <utility>

#include "base/saturated.h"
#include "base/text.h"
#include "io/step/step_geometry.h"
#include "io/step/step_splines.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();

Status check_box(const StepEntity& entity, const Domain& box) {
  const bool is_finite = std::isfinite(box.u1 - box.u0) && std::isfinite(box.v1 - box.v0);
  if (is_finite && box.u0 < box.u1 && box.v0 < box.v1) return {};
  return entity.error("a rectangle of its parameters must not be empty", StatusCode::invalid_argument);
}

/// Angles must be moderate numbers, and span at most a full turn.
Status check_angles(const StepEntity& entity, const Interval& angles) {
  if (angles.to - angles.from <= full_turn * (1 + 1e-12) && std::abs(angles.from) <= max_angle) return {};
  return entity.error("an interval of angles must not be longer than a full turn", StatusCode::invalid_argument);
}

Status needs_box(const StepEntity& entity) {
  return entity.error("is unbounded and needs a rectangle of its parameters", StatusCode::invalid_argument);
}

bool is_torus(const StepEntity& entity) {
  return entity.is("TOROIDAL_SURFACE") || entity.is("DEGENERATE_TOROIDAL_SURFACE");
}

bool is_elementary(const StepEntity& entity) {
  return entity.is("PLANE") || entity.is("CYLINDRICAL_SURFACE") || entity.is("CONICAL_SURFACE") ||
         entity.is("SPHERICAL_SURFACE") || is_torus(entity);
}

/// Returns all of a closed surface. Degenerate tori have the part on one side of where they meet themselves.
Domain closed_box(StepEntity& entity, double major, double minor) {
  if (entity.is("SPHERICAL_SURFACE")) return {0, full_turn, -full_turn / 4, full_turn / 4};
  if (!entity.is("DEGENERATE_TOROIDAL_SURFACE") || major >= minor) return {0, full_turn, 0, full_turn};
  const double meeting = std::acos(-major / minor);
  return entity.logical(entity.attribute(4)) ? Domain{0, full_turn, -meeting, meeting}
                                             : Domain{0, full_turn, meeting, full_turn - meeting};
}

/// Knots and weights of a spline surface, whose points are read elsewhere.
struct Net {
  int degree_u = 1, degree_v = 1;
  std::size_t count_u = 0, count_v = 0;
  std::vector<double> knots_u, knots_v, weights;
};

void read_weights(StepEntity& entity, Net& net) {
  if (!entity.is("RATIONAL_B_SPLINE_SURFACE")) return;
  for (const std::size_t row : entity.list(entity.attribute(entity.part("RATIONAL_B_SPLINE_SURFACE"), 0))) {
    const std::vector<double> weights = entity.reals(row);
    if (weights.size() != net.count_v)
      entity.fail("a row has " + counted(weights.size(), "weight") + ", expected " + std::to_string(net.count_v));
    net.weights.insert(net.weights.end(), weights.begin(), weights.end());
  }
  if (net.weights.size() != saturated_product(net.count_u, net.count_v))
    entity.fail("has " + counted(net.weights.size(), "weight") + " for " + counted(net.count_u * net.count_v, "point"));
}

/// The cylinder or cone of a line that is revolved.
std::optional<StepElementary> revolved_line(const StepSweep& sweep) {
  const SplineLine& line = sweep.profile;
  if (line.degree != 1 || line.points.size() != 2 || line.arcs) return {};
  const Vec3 &a = line.points[0], &b = line.points[1];
  const double from = line.knots[1], to = line.knots[2];
  const Vec3 along = (1 / (to - from)) * (b - a), start = a - from * along;  // where the parameter is 0
  const double radius = std::hypot(start.x, start.y), size = std::max({max_abs(a), max_abs(b), radius});
  constexpr double rounding = 1e-12;
  if (!(radius > rounding * size) || std::abs(length(along) - 1) > rounding || !(along.z > rounding)) return {};
  const Vec3 outwards{start.x / radius, start.y / radius, 0};
  if (std::abs(cross(outwards, along).z) > rounding) return {};
  const double opening = dot(outwards, along);
  StepElementary out;
  out.kind = std::abs(opening) > rounding ? StepElementaryKind::cone : StepElementaryKind::cylinder;
  out.radius = radius;
  if (out.kind == StepElementaryKind::cone) out.half_angle = std::atan2(opening, along.z);
  out.frame.z = sweep.frame.z;
  out.frame.x = outwards.x * sweep.frame.x + outwards.y * sweep.frame.y;
  out.frame.y = cross(out.frame.z, out.frame.x);
  out.frame.origin = sweep.frame.at({0, 0, start.z});
  out.whole = {0, full_turn, -far_away, far_away};
  return out;
}

}  // namespace

Result<FaceSurface> elementary_surface(const StepElementary& of, const Domain& box) {
  switch (of.kind) {
    case StepElementaryKind::plane:
      return plane_surface(of.frame, box);
    case StepElementaryKind::cylinder:
      return cylinder_surface(of.frame, of.radius, box);
    case StepElementaryKind::cone:
      return cone_surface(of.frame, of.radius, of.half_angle, box);
    case StepElementaryKind::sphere:
      return torus_surface(of.frame, 0, of.radius, box);
    case StepElementaryKind::torus:
      break;
  }
  return torus_surface(of.frame, of.radius, of.minor, box);
}

Result<FaceSurface> StepGeometry::surface(std::uint64_t number, const std::optional<Domain>& box) const {
  Result<FaceSurface> made = face(number, box, 0);
  // Errors of splines do not name the entity yet; all others begin with its number.
  if (made || made.status().message().starts_with('#')) return made;
  return StepEntity(index_, number).named(made.status());
}

Result<FaceSurface> StepGeometry::face(std::uint64_t number, const std::optional<Domain>& box, int depth) const {
  StepEntity entity(index_, number);
  if (depth > max_depth) entity.fail("is made of too many surfaces, or of itself");
  if (!entity.status().ok()) return entity.status();
  if (box)
    if (Status status = check_box(entity, *box); !status.ok()) return status;
  if (is_elementary(entity)) return elementary(entity, box);
  if (is_step_spline(entity, "SURFACE")) return spline_face(entity, box);
  if (entity.is("SURFACE_OF_LINEAR_EXTRUSION") || entity.is("SURFACE_OF_REVOLUTION")) return swept(entity, box, depth);
  if (entity.is("RECTANGULAR_TRIMMED_SURFACE")) return trimmed_face(entity, box, depth);
  return entity.error("is no surface that can be converted", StatusCode::unsupported);
}

std::uint64_t StepGeometry::bare_surface(std::uint64_t number) const {
  StepEntity entity(index_);
  for (int depth = 0; depth <= max_depth; ++depth) {
    entity.read(number);
    if (!entity.is("RECTANGULAR_TRIMMED_SURFACE")) return number;
    const std::uint64_t inner = entity.reference(entity.attribute(1));
    if (!entity.status().ok()) return number;
    number = inner;
  }
  return number;
}

Result<std::optional<StepElementary>> StepGeometry::elementary(std::uint64_t number) const {
  StepEntity entity(index_, number);
  if (!entity.status().ok()) return entity.status();
  if (!is_elementary(entity)) return std::optional<StepElementary>();
  Result<StepElementary> made = elementary(entity);
  if (!made) return made.status();
  return std::optional<StepElementary>(*made);
}

Result<std::optional<StepElementary>> StepGeometry::elementary_sweep(std::uint64_t number, const Box3& extent) const {
  StepEntity entity(index_, number);
  if (entity.is("SURFACE_OF_LINEAR_EXTRUSION")) return extruded_circle(number);
  if (!entity.is("SURFACE_OF_REVOLUTION")) return std::optional<StepElementary>();
  const Result<std::optional<StepSweep>> turned = sweep(number, extent);
  return turned ? revolved_line(**turned) : Result<std::optional<StepElementary>>(turned.status());
}

Result<std::optional<StepElementary>> StepGeometry::extruded_circle(std::uint64_t number) const {
  StepEntity entity(index_, number);
  const std::uint64_t along = entity.reference(entity.attribute(1)), by = entity.reference(entity.attribute(2));
  StepEntity circle(index_, along);
  if (!entity.status().ok() || !circle.is("CIRCLE")) return std::optional<StepElementary>();
  const std::uint64_t position = circle.reference(circle.attribute(1));
  StepElementary out;
  out.kind = StepElementaryKind::cylinder;
  out.radius = units_.length * circle.positive(circle.attribute(2), "radius");
  if (!circle.status().ok()) return circle.status();
  const Result<Frame> frame = placement(position);
  if (!frame) return frame.status();
  const Result<Vec3> direction = vector(by);
  if (!direction) return direction.status();
  if (length(normalized(*direction) - frame->z) > 1e-12) return std::optional<StepElementary>();
  out.frame = *frame;
  out.whole = {0, full_turn, -far_away, far_away};
  return std::optional<StepElementary>(out);
}

Result<StepElementary> StepGeometry::elementary(StepEntity& entity) const {
  const bool is_plane = entity.is("PLANE"), is_cone = entity.is("CONICAL_SURFACE"), is_round = is_torus(entity);
  const std::uint64_t position = entity.reference(entity.attribute(1));
  // A ring of negative radius is that of the positive one, half a turn away.
  const double given_radius = is_plane   ? 1
                              : is_cone  ? entity.real(entity.attribute(2))
                              : is_round ? std::abs(entity.real(entity.attribute(2)))
                                         : entity.positive(entity.attribute(2), "radius");
  StepElementary out;
  out.kind = is_plane                         ? StepElementaryKind::plane
             : is_cone                        ? StepElementaryKind::cone
             : is_round                       ? StepElementaryKind::torus
             : entity.is("SPHERICAL_SURFACE") ? StepElementaryKind::sphere
                                              : StepElementaryKind::cylinder;
  out.radius = units_.length * given_radius;
  out.minor = is_round ? units_.length * entity.positive(entity.attribute(3), "minor radius") : 0;
  out.half_angle = is_cone ? units_.angle * entity.real(entity.attribute(3)) : 0;
  if (given_radius < 0 || (is_round && given_radius == 0))
    entity.fail("its radius is " + text(given_radius) + ", expected 0 or more");
  if (is_cone && !(std::abs(out.half_angle) < full_turn / 4))
    entity.fail("its half angle is " + text(out.half_angle) + " radians, expected less than a right angle");
  if (!entity.status().ok()) return entity.status();
  const Result<Frame> frame = placement(position);
  if (!frame) return frame.status();
  out.frame = *frame;
  out.whole = is_plane                                             ? Domain{-far_away, far_away, -far_away, far_away}
              : is_round || out.kind == StepElementaryKind::sphere ? closed_box(entity, out.radius, out.minor)
                                                                   : Domain{0, full_turn, -far_away, far_away};
  if (!entity.status().ok()) return entity.status();
  return out;
}

Result<FaceSurface> StepGeometry::elementary(StepEntity& entity, const std::optional<Domain>& given) const {
  const Result<StepElementary> made = elementary(entity);
  if (!made) return made.status();
  const bool is_plane = made->kind == StepElementaryKind::plane;
  const bool is_closed = made->kind == StepElementaryKind::sphere || made->kind == StepElementaryKind::torus;
  if (!given && !is_closed) return needs_box(entity);
  const Domain box = given ? *given : made->whole;
  if (Status status = is_plane ? Status() : check_angles(entity, range_u(box)); !status.ok()) return status;
  if (Status status = is_closed ? check_angles(entity, range_v(box)) : Status(); !status.ok()) return status;
  return elementary_surface(*made, box);
}

Result<std::optional<StepOffset>> StepGeometry::offset(std::uint64_t number) const {
  StepEntity entity(index_, number);
  if (!entity.is("OFFSET_SURFACE")) return std::optional<StepOffset>();
  StepOffset out{entity.reference(entity.attribute(1)), units_.length * entity.real(entity.attribute(2))};
  if (!entity.status().ok()) return entity.status();
  out.basis = bare_surface(out.basis);
  if (StepEntity(index_, out.basis).is("OFFSET_SURFACE"))
    return entity.error("is an offset of an offset surface", StatusCode::unsupported);
  return std::optional<StepOffset>(out);
}

Result<std::optional<StepSweep>> StepGeometry::sweep(std::uint64_t number, const Box3& extent) const {
  StepEntity entity(index_, number);
  StepSweep out;
  out.is_turned = entity.is("SURFACE_OF_REVOLUTION");
  if (!out.is_turned && !entity.is("SURFACE_OF_LINEAR_EXTRUSION")) return std::optional<StepSweep>();
  const std::uint64_t along = entity.reference(entity.attribute(1)), by = entity.reference(entity.attribute(2));
  if (!entity.status().ok()) return entity.status();
  const Result<Vec3> direction = out.is_turned ? Vec3{} : vector(by);
  if (!direction) return direction.status();
  out.direction = normalized(*direction);
  const Result<Frame> frame = out.is_turned ? placement(by) : Frame{};
  if (!frame) return frame.status();
  out.frame = *frame;
  const Result<Interval> reach = profile_range(along, out.is_turned ? &out.frame : nullptr, out.direction, extent);
  if (!reach) return reach.status();
  Result<SplineLine> profile = line(along, reach->from < reach->to ? Range(*reach) : Range(), 1);
  if (!profile) return profile.status();
  out.profile = *std::move(profile);
  if (out.is_turned)
    for (Vec3& p : out.profile.points) p = out.frame.local(p);
  return std::optional<StepSweep>(std::move(out));
}

Result<FaceSurface> StepGeometry::swept(StepEntity& entity, const std::optional<Domain>& box, int depth) const {
  const bool is_turned = entity.is("SURFACE_OF_REVOLUTION");
  const std::uint64_t along = entity.reference(entity.attribute(1)), by = entity.reference(entity.attribute(2));
  if (!entity.status().ok()) return entity.status();
  if (!box && !is_turned) return needs_box(entity);
  const Range part = box ? Range(is_turned ? range_v(*box) : range_u(*box)) : Range();
  Result<SplineLine> profile = line(along, part, depth + 1);
  if (!profile) return profile.status();
  if (!is_turned) {
    const Result<Vec3> direction = vector(by);
    if (!direction) return direction.status();
    return extruded(*profile, normalized(*direction), range_v(*box));
  }
  const Interval angles = box ? range_u(*box) : Interval{0, full_turn};
  if (Status status = check_angles(entity, angles); !status.ok()) return status;
  const Result<Frame> frame = placement(by);
  if (!frame) return frame.status();
  for (Vec3& p : profile->points) p = frame->local(p);
  return revolved(*frame, angles, *profile);
}

Result<FaceSurface> StepGeometry::spline_face(StepEntity& entity, const std::optional<Domain>& box) const {
  const SplineAttributes place = spline_attributes(entity, "SURFACE");
  Net net;
  net.degree_u = entity.integer(entity.attribute(place.spline, place.spline_at));
  net.degree_v = entity.integer(entity.attribute(place.spline, place.spline_at + 1));
  std::vector<Vec3> poles;
  for (const std::size_t row : entity.list(entity.attribute(place.spline, place.spline_at + 2))) {
    const Result<std::vector<Vec3>> some = points(entity, row);
    if (!some) return some.status();
    if (net.count_u++ == 0) net.count_v = some->size();
    if (some->size() != net.count_v)
      return entity.error("row " + std::to_string(net.count_u) + " has " + counted(some->size(), "point") +
                          ", row 1 has " + std::to_string(net.count_v));
    poles.insert(poles.end(), some->begin(), some->end());
  }
  if (!check_degree(entity, net.degree_u, net.count_u) || !check_degree(entity, net.degree_v, net.count_v))
    return entity.status();
  net.knots_u = step_knots(entity, "SURFACE", net.degree_u, net.count_u, 0);
  net.knots_v = step_knots(entity, "SURFACE", net.degree_v, net.count_v, 1);
  read_weights(entity, net);
  if (!entity.status().ok()) return entity.status();
  std::optional<Domain> part;
  if (box) {
    const Interval u = covered(net.knots_u, net.degree_u, range_u(*box));
    const Interval v = covered(net.knots_v, net.degree_v, range_v(*box));
    part = Domain{u.from, u.to, v.from, v.to};
    if (Status status = check_box(entity, *part); !status.ok()) return status;
  }
  Result<BSplineSurface> spline =
      net.weights.empty()
          ? BSplineSurface::polynomial(net.degree_u, net.knots_u, net.degree_v, net.knots_v, std::move(poles), part)
          : BSplineSurface::rational(net.degree_u, net.knots_u, net.degree_v, net.knots_v, std::move(poles),
                                     std::move(net.weights), part);
  if (!spline) return entity.named(spline.status());
  return with_parameters(std::move(spline), {});
}

/// Returns the factors from the file's parameters to ours, (u1, v1) of a rectangle from 0.
Result<Domain> StepGeometry::trim_scales(std::uint64_t number, int depth) const {
  StepEntity entity(index_, number);
  if (depth > max_depth) entity.fail("is made of too many surfaces, or of itself");
  const double length = units_.length, angle = units_.angle;
  if (!entity.status().ok()) return entity.status();
  if (entity.is("PLANE")) return Domain{0, length, 0, length};
  if (entity.is("CYLINDRICAL_SURFACE")) return Domain{0, angle, 0, length};
  if (entity.is("SPHERICAL_SURFACE") || is_torus(entity)) return Domain{0, angle, 0, angle};
  if (entity.is("CONICAL_SURFACE")) {
    const double half_angle = angle * entity.real(entity.attribute(3));
    if (!entity.status().ok()) return entity.status();
    return Domain{0, angle, 0, length / std::cos(half_angle)};
  }
  const bool is_turned = entity.is("SURFACE_OF_REVOLUTION"), is_trimmed = entity.is("RECTANGULAR_TRIMMED_SURFACE");
  if (!is_turned && !is_trimmed && !entity.is("SURFACE_OF_LINEAR_EXTRUSION")) return Domain{};
  const std::uint64_t along = entity.reference(entity.attribute(1));
  const std::uint64_t by = is_trimmed ? 0 : entity.reference(entity.attribute(2));
  if (!entity.status().ok()) return entity.status();
  if (is_trimmed) return trim_scales(along, depth + 1);
  const Result<double> scale = curve_scale(along, depth + 1);
  if (!scale) return scale.status();
  if (is_turned) return Domain{0, angle, 0, *scale};
  const Result<Vec3> direction = vector(by);
  if (!direction) return direction.status();
  return Domain{0, *scale, 0, tessera::length(*direction)};
}

Result<FaceSurface> StepGeometry::trimmed_face(StepEntity& entity, const std::optional<Domain>& box, int depth) const {
  const std::uint64_t basis = entity.reference(entity.attribute(1));
  std::array<double, 4> trims{};
  for (std::size_t k = 0; k < 4; ++k) trims[k] = entity.real(entity.attribute(2 + k));
  const bool agrees_u = entity.logical(entity.attribute(6)), agrees_v = entity.logical(entity.attribute(7));
  if (!entity.status().ok()) return entity.status();
  if (!agrees_u || !agrees_v) return entity.error("runs against its basis surface", StatusCode::unsupported);
  if (box) return face(basis, box, depth + 1);
  const Result<Domain> scale = trim_scales(basis, depth + 1);
  if (!scale) return scale.status();
  Domain part{scale->u1 * trims[0], scale->u1 * trims[1], scale->v1 * trims[2], scale->v1 * trims[3]};
  const StepEntity of(index_, basis);
  const bool is_round = (is_elementary(of) && !of.is("PLANE")) || of.is("SURFACE_OF_REVOLUTION");
  if (is_round && part.u1 <= part.u0) part.u1 += full_turn;  // past the place where angles begin again
  if (is_torus(of) && part.v1 <= part.v0) part.v1 += full_turn;
  if (Status status = check_box(entity, part); !status.ok()) return status;
  return face(basis, part, depth + 1);
}

}}  // namespace tessera::abi_0_1
