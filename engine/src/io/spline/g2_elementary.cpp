// Elementary surfaces of .g2 files. GoTools writes the dimension, sizes, the location, the z axis, the x axis, the
// range of the parameters, and whether the two are swapped.

#include <cmath>

#include "io/spline/elementary.h"
#include "io/spline/g2.h"
#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Axes of length 1, x made orthogonal to z. None if an axis is zero or the two are parallel.
std::optional<Affine> frame(const Vec3& location, const Vec3& z_axis, const Vec3& x_axis) {
  const Vec3 z = normalized(z_axis), along = normalized(x_axis), y = normalized(cross(z, along));
  if (y == Vec3{}) return std::nullopt;
  return Affine{.columns = {normalized(cross(y, z)), y, z}, .translation = location};
}

void snap_pole(double& latitude) {
  if (std::abs(std::abs(latitude) - pi / 2) <= printed) latitude = std::copysign(pi / 2, latitude);
}

Result<Surface> plane(const Domain& d) {
  const std::array<double, 4> u{d.u0, d.u0, d.u1, d.u1}, v{d.v0, d.v0, d.v1, d.v1};
  const std::array<Vec3, 4> corners{Vec3{d.u0, d.v0, 0}, Vec3{d.u0, d.v1, 0}, Vec3{d.u1, d.v0, 0}, Vec3{d.u1, d.v1, 0}};
  Result<BSplineSurface> surface = BSplineSurface::polynomial(1, u, 1, v, corners);
  if (!surface) return surface.status();
  return Surface(*std::move(surface));
}

Result<Surface> cylinder(double radius, const Domain& range) {
  return quadric_part(QuadricKind::elliptic_cylinder, {.a = 1 / radius / radius, .b = 1 / radius / radius, .k = -1},
                      range);
}

Result<Surface> sphere(double radius, Domain range) {
  snap_pole(range.v0);
  snap_pole(range.v1);
  const double square = 1 / radius / radius;
  return quadric_part(QuadricKind::ellipsoid, {.a = square, .b = square, .c = square, .k = -1}, range);
}

/// The radius at v is R + v tan(angle). The apex lies at v = -R / tan(angle), where the canonical cone has v = 0.
Result<Surface> cone(const G2Elementary& e, Affine& placement, double& shift_v) {
  const double slope = std::tan(e.angle);
  if (std::abs(slope) <= printed) return cylinder(e.radius, e.range);
  const double apex = shift_v = e.radius / slope;
  placement = placement * Affine::translated({0, 0, -apex}) * Affine::scaled({std::abs(slope), std::abs(slope), 1});
  const Domain range{e.range.u0, e.range.u1, e.range.v0 + apex, e.range.v1 + apex};
  // A falling radius is the part of the cone below the apex: the same circles half a turn further on.
  if (slope < 0) {
    placement = placement * Affine::scaled({-1, -1, 1});
  }
  return quadric_part(QuadricKind::elliptic_cone, {.a = 1, .b = 1, .c = -1}, range);  // slope 1, then scaled
}

Result<Surface> make_surface(std::int64_t kind, const G2Elementary& e, Affine& placement, double& shift_v) {
  const bool positive = e.radius > 0 && (kind != g2_torus || e.minor_radius > 0);
  if (!positive && kind != g2_plane && !(kind == g2_cone && e.radius == 0)) {
    return Status(StatusCode::invalid_argument, "its radius is not above 0");
  }
  switch (kind) {
    case g2_plane:
      return plane(e.range);
    case g2_cylinder:
      return cylinder(e.radius, e.range);
    case g2_sphere:
      return sphere(e.radius, e.range);
    case g2_cone:
      return cone(e, placement, shift_v);
    default:
      return torus_part(e.radius, e.minor_radius, e.range);
  }
}

}  // namespace

G2Elementary read_g2_elementary(std::int64_t kind, G2Numbers& numbers, bool is_whole) {
  G2Elementary e;
  numbers.integer("the dimension 3", 3, 3);
  if (kind != g2_plane) e.radius = numbers.number("a radius");
  if (kind == g2_torus) e.minor_radius = numbers.number("the minor radius");
  e.location = numbers.vector("the location");
  e.z_axis = numbers.vector("the z axis");
  e.x_axis = numbers.vector("the x axis");
  if (kind == g2_cone) e.angle = numbers.number("the cone's angle");
  if (kind == g2_torus) numbers.integer("the flag of the outer part", 0, 1);
  if (kind == g2_plane || kind == g2_cylinder || kind == g2_cone)
    e.bounded = numbers.integer("the flag of a bounded surface", 0, 1) == 1;
  if (!numbers.ok() || (!e.bounded && !is_whole)) return e;
  std::vector<double*> limits;
  if (e.bounded || kind != g2_plane) limits = {&e.range.u0, &e.range.u1};
  if (e.bounded) limits.insert(limits.end(), {&e.range.v0, &e.range.v1});
  for (double* const limit : limits) *limit = numbers.number("a limit of the parameters");
  e.swapped = numbers.integer("the flag of swapped parameters", 0, 1) == 1;
  return e;
}

Result<G2Object> make_g2_elementary(std::int64_t kind, const G2Elementary& record, const G2Numbers& numbers) {
  const std::optional<Affine> axes = frame(record.location, record.z_axis, record.x_axis);
  if (!axes) return numbers.failure("expected a z axis and an x axis of different directions");
  Affine placement = *axes;
  double shift_v = 0;
  Result<Surface> surface = make_surface(kind, record, placement, shift_v);
  if (!surface) return refused_element(numbers, surface.status());
  return G2Object{*std::move(surface), placement, shift_v};
}

}}  // namespace tessera::abi_0_1
