#include "io/spline/elementary.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

double snapped(double turn) { return std::abs(turn - 2 * pi) <= printed ? 2 * pi : turn; }

/// The parameter of an angle in [0, 2 pi] on a circle of four rational arcs over [0,1]. On the arc with middle angle m
/// and half-width h, the angle is m + 2 atan(tan(h/2) s), s from -1 to 1.
double circle_parameter(double angle) {
  const double arc = std::min(3.0, std::floor(angle / (pi / 2)));
  const double off_middle = angle - (arc + 0.5) * (pi / 2);
  const double s = std::tan(off_middle / 2) / std::tan(pi / 8);
  return std::clamp((arc + (1 + s) / 2) / 4, 0.0, 1.0);
}

}  // namespace

bool is_turn(double turn) { return turn > 0 && turn <= 2 * pi + printed; }

Result<Surface> quadric_part(QuadricKind kind, const QuadricCoefficients& coefficients, const Domain& range) {
  Domain turned = range;
  const double turn = range.u1 - range.u0;
  if (snapped(turn) != turn) turned.u1 = range.u0 + 2 * pi;
  const Result<Quadric> whole = Quadric::make(coefficients);
  if (!whole) return whole.status();
  if (whole->kind() != kind)
    return Status(StatusCode::invalid_argument,
                  "its sizes are too far from 1 for double: it is classified as the kind '" +
                      std::string(name(whole->kind())) + "'");
  Result<QuadricPiece> piece = QuadricPiece::make(*whole, turned);
  if (!piece) return piece.status();
  return Surface(*std::move(piece));
}

Result<Surface> revolved_part(const Curve& profile, double turn) {
  if (!is_turn(turn)) return Status(StatusCode::invalid_argument, "its turn must be above 0 and at most a full turn");
  const Result<BSplineSurface> full = make_surface_of_revolution(profile, {});
  if (!full) return full.status();
  const Interval v = profile.domain();
  Result<BSplineSurface> part =
      BSplineSurface::rational(full->degree_u(), full->knots_u(), full->degree_v(), full->knots_v(), full->points(),
                               full->weights(), Domain{0, circle_parameter(snapped(turn)), v.from, v.to});
  if (!part) return part.status();
  return Surface(*std::move(part));
}

Result<Surface> torus_part(double major, double minor, const Domain& range) {
  const double turn_u = range.u1 - range.u0, turn_v = range.v1 - range.v0;
  if (!is_turn(turn_u) || !is_turn(turn_v))
    return Status(StatusCode::invalid_argument, "its ranges must be above 0 and at most a full turn");
  // The turn begins at u0 and the tube at v0, so that ranges are the first parts of full circles.
  const Vec3 outwards{std::cos(range.u0), std::sin(range.u0), 0}, up{0, 0, 1};
  const Result<Curve> tube = make_nurbs_circle({.origin = major * outwards,
                                                .direction = cross(outwards, up),
                                                .zero = std::cos(range.v0) * outwards + std::sin(range.v0) * up},
                                               minor);
  if (!tube) return tube.status();
  const Result<Curve> arc = Curve::nurbs(tube->degree(), tube->points(), tube->weights(), tube->knots(),
                                         Interval{0, circle_parameter(snapped(turn_v))});
  if (!arc) return arc.status();
  return revolved_part(*arc, turn_u);
}

}}  // namespace tessera::abi_0_1
