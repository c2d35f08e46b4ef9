// The RenderMan Interface Specification 3.2, section 5.2: theta = u thetamax, and v runs along the profile. Sphere,
// Cylinder, Cone and Paraboloid are made in a frame where their sizes are 1, so that squares of sizes cannot overflow.

#include "io/rib/rib_quadrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/text.h"
#include "io/spline/elementary.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double pi = std::numbers::pi;

/// Radians; whole turns are exact.
double radians(double degrees) { return degrees / 360 * (2 * pi); }

struct QuadricRequest {
  std::string_view request, numbers;  ///< what its numbers are, for messages
  std::size_t count;
  Result<RibQuadric> (*make)(std::span<const double> n, double turn);  ///< turn: thetamax in radians, above 0
};

Status bad(std::string sentence) { return Status(StatusCode::invalid_argument, std::move(sentence)); }

Result<RibQuadric> placed(Result<Surface> surface, const Affine& placement = {}) {
  if (!surface) return surface.status();
  return RibQuadric{*std::move(surface), placement};
}

/// The line from a to b, about the z axis.
Result<RibQuadric> revolved_line(const Vec3& a, const Vec3& b, double turn) {
  if (a == b) return bad("its profile is a point");
  const Result<Curve> line = Curve::bezier(std::array{a, b});
  if (!line) return line.status();
  return placed(revolved_part(*line, turn));
}

/// Sphere radius zmin zmax thetamax: phi from asin(zmin / radius) to asin(zmax / radius), a pole where z is beyond.
Result<RibQuadric> sphere(std::span<const double> n, double turn) {
  const double radius = n[0];
  if (radius == 0) return bad("its radius is 0");
  const auto latitude = [&](double z) { return std::asin(std::clamp(z / radius, -1.0, 1.0)); };
  const double from = latitude(n[1]), to = latitude(n[2]), up = from <= to ? 1 : -1;  // down: seen in a mirror
  return placed(quadric_part(QuadricKind::ellipsoid, {.a = 1, .b = 1, .c = 1, .k = -1}, {0, turn, up * from, up * to}),
                Affine::scaled({radius, radius, up * radius}));
}

/// Cylinder radius zmin zmax thetamax.
Result<RibQuadric> cylinder(std::span<const double> n, double turn) {
  if (n[0] == 0) return bad("its radius is 0");
  const double up = n[1] <= n[2] ? 1 : -1;
  return placed(
      quadric_part(QuadricKind::elliptic_cylinder, {.a = 1, .b = 1, .k = -1}, {0, turn, up * n[1], up * n[2]}),
      Affine::scaled({n[0], n[0], up}));
}

/// Cone height radius thetamax: from the circle at z = 0 to the apex, the part v = -1 to 0 of x2 + y2 = z2.
Result<RibQuadric> cone(std::span<const double> n, double turn) {
  if (n[0] == 0 || n[1] == 0) return bad("its height or its radius is 0");
  return placed(quadric_part(QuadricKind::elliptic_cone, {.a = 1, .b = 1, .c = -1}, {0, turn, -1, 0}),
                Affine::translated({0, 0, n[0]}) * Affine::scaled({-n[1], -n[1], n[0]}));
}

/// Paraboloid rmax zmin zmax thetamax: r = rmax sqrt(z / zmax). In the frame z = v^2; v is below 0 if z falls.
Result<RibQuadric> paraboloid(std::span<const double> n, double turn) {
  const double side = n[2] < 0 ? -1 : 1, from = side * n[1], to = side * n[2];
  if (n[0] == 0 || to == 0) return bad("its radius or zmax is 0");
  if (from < 0) return bad("zmin and zmax have different signs");
  const double up = from <= to ? 1 : -1, scale = up * n[0] / std::sqrt(to);
  return placed(quadric_part(QuadricKind::elliptic_paraboloid, {.a = 1, .b = 1, .j = -0.5},
                             {0, turn, up * std::sqrt(from), up * std::sqrt(to)}),
                Affine::scaled({scale, scale, side}));
}

/// Hyperboloid x1 y1 z1 x2 y2 z2 thetamax.
Result<RibQuadric> hyperboloid(std::span<const double> n, double turn) {
  return revolved_line({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, turn);
}

/// Disk height radius thetamax: from the rim to the centre.
Result<RibQuadric> disk(std::span<const double> n, double turn) {
  if (n[1] == 0) return bad("its radius is 0");
  return revolved_line({n[1], 0, n[0]}, {0, 0, n[0]}, turn);
}

/// Torus majorradius minorradius phimin phimax thetamax.
Result<RibQuadric> torus(std::span<const double> n, double turn) {
  const double from = radians(n[2]), to = radians(n[3]), up = from <= to ? 1 : -1;
  return placed(torus_part(n[0], n[1], {0, turn, up * from, up * to}), Affine::scaled({1, 1, up}));
}

constexpr QuadricRequest quadric_requests[] = {
    {"Sphere", "radius, zmin, zmax, thetamax", 4, sphere},
    {"Cylinder", "radius, zmin, zmax, thetamax", 4, cylinder},
    {"Cone", "height, radius, thetamax", 3, cone},
    {"Paraboloid", "rmax, zmin, zmax, thetamax", 4, paraboloid},
    {"Hyperboloid", "two points, thetamax", 7, hyperboloid},
    {"Disk", "height, radius, thetamax", 3, disk},
    {"Torus", "majorradius, minorradius, phimin, phimax, thetamax", 5, torus},
};

}  // namespace

Result<RibQuadric> read_quadric(const RibSurfaceText& text) {
  const QuadricRequest& shape =
      *std::find_if(std::begin(quadric_requests), std::end(quadric_requests),
                    [&](const QuadricRequest& known) { return known.request == text.request; });
  std::array<double, 7> values{};
  const std::span<double> numbers = std::span(values).first(shape.count);
  Status status = text.lexer.take_numbers(
      std::to_string(shape.count) + " finite numbers for " + std::string(shape.numbers), numbers);
  if (!status.ok()) return status;
  const double turn = radians(numbers.back());
  if (!is_turn(std::abs(turn)))
    return text.failure("expected a thetamax of -360 to 360 other than 0, found " + tessera::text(numbers.back()));
  // A falling angle is a growing one in the mirror y -> -y, which maps the profile, too.
  const double side = turn < 0 ? -1 : 1;
  if (shape.request == "Hyperboloid") numbers[1] *= side, numbers[4] *= side;
  Result<RibQuadric> quadric = shape.make(numbers, std::abs(turn));
  if (!quadric) return refused_element(text, quadric.status());
  if (side < 0) quadric->placement = Affine::scaled({1, -1, 1}) * quadric->placement;
  return quadric;
}

}}  // namespace tessera::abi_0_1
