#pragma once
// B-spline and NURBS curves and surfaces in other clothes, exactly: more knots, a higher degree, clamped ends, Bezier
// pieces.

#include <span>
#include <utility>
#include <vector>

#include "tessera/bspline_surface.h"
#include "tessera/convert.h"
#include "tessera/curve.h"

#pragma GCC visibility push(default)
namespace tessera {

// What is returned is the same curve or surface on the same domain, right to rounding. Control points that stay are the
// same bits. Rational stays rational. Errors of all: out_of_memory, and those stated.

/// With `knots` inserted, each as often as it stands there (Boehm 1980; The NURBS Book, sec. 5.2, 5.3). Each within the
/// domain, its ends not included, and not above the degree in multiplicity, those that stand already included.
/// Errors: non_finite, invalid_argument (index = the knot).
Result<Curve> refined(const Curve& curve, std::span<const double> knots);
Result<BSplineSurface> refined(const BSplineSurface& surface, std::span<const double> knots_u,
                               std::span<const double> knots_v);

/// With knots that end where the domain ends, (degree + 1)-fold: what is unclamped or has a smaller domain than its
/// knots becomes clamped, and its border curves come to have the border points as control points.
Result<Curve> clamped(const Curve& curve);
Result<BSplineSurface> clamped(const BSplineSurface& surface);

/// Clamped, and of a degree higher by `by` >= 0 (by blossoms: Farin, Curves and Surfaces for CAGD, 5th ed., sec. 8.7).
/// Each knot stands as many times more. Errors: invalid_argument, unsupported_degree.
Result<Curve> degree_elevated(const Curve& curve, int by);
Result<BSplineSurface> degree_elevated(const BSplineSurface& surface, int by_u, int by_v);

/// Both clamped, of the higher degree of the two, and on the union of their knots (by ==: knots that differ by rounding
/// both stand). One may be rational and the other not. Errors: invalid_argument (they have not the same domain).
Result<std::pair<Curve, Curve>> compatible(const Curve& a, const Curve& b);

/// A curve as Bezier pieces that share their end points: piece k has the points k * degree .. (k + 1) * degree and
/// covers [breaks[k], breaks[k+1]].
struct BezierPieces {
  int degree = 1;               ///< of every piece
  std::vector<double> breaks;   ///< strictly increasing
  std::vector<Vec3> points;     ///< as many as knots leave room for
  std::vector<double> weights;  ///< empty if the curve is polynomial; not dropped where they are equal
};
Result<BezierPieces> to_bezier(const Curve& curve);

/// One patch a rectangle between distinct knots, within the domain. All patches are rational or none is, as the surface
/// is. Control points are convex combinations of the surface's; those of full multiplicity are the same bits. Time and
/// memory O(output). (Borden, Scott, Evans, Hughes 2011, Isogeometric finite element data structures based on Bezier
/// extraction.)
Result<PatchGrid> to_bezier(const BSplineSurface& surface);

/// Patches (a, b) of a grid with a0 <= a < a1, b0 <= b < b1.
struct PatchRange {
  std::size_t a0 = 0, a1 = 0, b0 = 0, b1 = 0;                              ///< [a0, a1) x [b0, b1)
  bool empty() const { return a0 >= a1 || b0 >= b1; }                      ///< whether there is no patch in it
  friend bool operator==(const PatchRange&, const PatchRange&) = default;  ///< by all four
};
/// The patches of to_bezier(surface) that control point [i][j] touches: at most (degree_u + 1) (degree_v + 1). Empty
/// for a point that acts outside the domain alone. Errors: invalid_argument (no such point).
Result<PatchRange> touched_patches(const BSplineSurface& surface, std::size_t i, std::size_t j);

}  // namespace tessera
#pragma GCC visibility pop
