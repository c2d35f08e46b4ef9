#pragma once
// Circles and surfaces of revolution as exact NURBS.

#include <cstdint>

#include "tessera/bspline_surface.h"
#include "tessera/curve.h"

#pragma GCC visibility push(default)
namespace tessera {

/// An axis of revolution, and where its angle is zero. Angles grow counter-clockwise as seen from the tip of
/// `direction`.
struct Axis {
  Vec3 origin{0, 0, 0};     ///< a point of the axis
  Vec3 direction{0, 0, 1};  ///< of any length > 0
  Vec3 zero{1, 0, 0};       ///< not parallel to direction; its part across it counts
};

/// Of how many rational quadratic arcs a full circle is made (Piegl and Tiller, The NURBS Book, 2nd ed., sec. 7.5):
/// four through the corners of a square with inner weights sqrt(2)/2, three through those of a triangle with 1/2.
enum class CircleArcs : std::uint8_t { three = 3, four = 4 };

// All have the full turn for u in [0, 1], arc k of n on [k/n, (k+1)/n], with double inner knots, so C1 as a point set
// moves but only C0 by its parameter. Errors: invalid_argument, non_finite (a radius that is not positive and finite,
// an axis without a direction), and those of the curve or surface.

Result<Curve> nurbs_circle(const Axis& axis, double radius, CircleArcs arcs = CircleArcs::four);
/// `profile` turned about the axis: u is the turn, v the profile's parameter, its degree and knots v's. Weights are
/// products. Points of the profile on the axis make poles. (The NURBS Book, sec. 8.5, in closed form.)
Result<BSplineSurface> surface_of_revolution(const Curve& profile, const Axis& axis,
                                             CircleArcs arcs = CircleArcs::four);
/// v in [0, 1] runs from the pole at -direction to that at +direction, over two arcs. The normal points outwards.
Result<BSplineSurface> nurbs_sphere(const Axis& axis, double radius, CircleArcs arcs = CircleArcs::four);
/// The tube of radius `minor` about the circle of radius `major` > minor; v in [0, 1] runs around the tube from its
/// outermost circle towards +direction. The normal points outwards.
Result<BSplineSurface> nurbs_torus(const Axis& axis, double major, double minor, CircleArcs arcs = CircleArcs::four);
/// From the origin to origin + height * direction / |direction|, v in [0, 1] along it.
Result<BSplineSurface> nurbs_cylinder(const Axis& axis, double radius, double height,
                                      CircleArcs arcs = CircleArcs::four);
/// The same with radius `bottom` at the origin and `top` at the height; one of them may be zero: an apex.
Result<BSplineSurface> nurbs_cone(const Axis& axis, double bottom, double top, double height,
                                  CircleArcs arcs = CircleArcs::four);

}  // namespace tessera
#pragma GCC visibility pop
