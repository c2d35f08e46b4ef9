#pragma once
// Surfaces as grids of Bezier patches, and the map between a surface's parameters and its patches'; B-splines rewritten
// exactly with more knots, a higher degree, clamped ends, or as Bezier pieces; conversions of all kinds of surfaces.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/status.h"
#include "tessera/surface.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A place in a grid of patches.
struct PatchLocation {
  std::size_t patch = 0;  ///< index into PatchGrid::patches()
  double u = 0, v = 0;    ///< local parameters, in [0,1]
};

/// Bound of the distance between patches and the surface that they represent.
struct FitError {
  double distance = 0;    ///< 0 for an exact conversion, which is right up to rounding
  bool certified = true;  ///< whether it is proven, not only sampled
};

/// One surface as patches over the rectangles between breakpoints; the result of every conversion. Patch (a, b) covers
/// [breaks_u[a], breaks_u[a+1]] x [breaks_v[b], breaks_v[b+1]] and has the index a * count_v() + b. Neighbours share
/// their border's control points (and weights) by ==.
class PatchGrid {
 public:
  /// Makes a grid.
  ///
  /// - `breaks_u`, `breaks_v`: breakpoints, at least two in each direction, finite, strictly increasing.
  /// - `patches`: (breaks_u.size() - 1) * (breaks_v.size() - 1) of them.
  ///
  /// Errors: invalid_argument (breakpoints, `error`), non_finite (index = the breakpoint), count_mismatch.
  static Result<PatchGrid> make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                std::vector<BezierPatch> patches, FitError error = {});

  std::size_t count_u() const { return breaks_u_.size() - 1; }       ///< number of patches along u
  std::size_t count_v() const { return breaks_v_.size() - 1; }       ///< number of patches along v
  std::span<const double> breaks_u() const { return breaks_u_; }     ///< strictly increasing, count_u() + 1
  std::span<const double> breaks_v() const { return breaks_v_; }     ///< strictly increasing, count_v() + 1
  std::span<const BezierPatch> patches() const { return patches_; }  ///< `[a][b]`
  /// Moves the patches out of a grid that is no longer used. Errors: none. Memory: allocates nothing.
  std::vector<BezierPatch> take_patches() && { return std::move(patches_); }
  /// Returns patch (a, b); a < count_u(), b < count_v().
  const BezierPatch& patch(std::size_t a, std::size_t b) const { return patches_[a * count_v() + b]; }
  /// Returns the rectangle between the first and the last breakpoints.
  Domain domain() const { return {breaks_u_.front(), breaks_u_.back(), breaks_v_.front(), breaks_v_.back()}; }
  Domain patch_domain(std::size_t patch) const;         ///< rectangle of a patch; patch < patches().size()
  const FitError& fit_error() const { return error_; }  ///< the largest over all patches
  /// Returns the box of all control points.
  const Box3& box() const { return box_; }

  /// Returns the patch that contains (u,v) and the local parameters there: at an inner breakpoint the patch on its
  /// right, at the end of the domain the last one. Returns nothing for NaN and outside the domain.
  std::optional<PatchLocation> locate(double u, double v) const;
  /// Returns position and derivatives by the surface's own parameters, at (u,v) as located. Returns nothing outside the
  /// domain.
  std::optional<SurfaceJet> evaluate_jet(double u, double v) const;

 private:
  PatchGrid() = default;
  /// Makes a grid whose box of all control points is known.
  static Result<PatchGrid> make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                std::vector<BezierPatch> patches, FitError error, const Box3& box);
  friend Result<PatchGrid> to_bezier(const BSplineSurface& surface);  // it has just computed the box

  std::vector<double> breaks_u_, breaks_v_;
  std::vector<BezierPatch> patches_;
  FitError error_;
  Box3 box_;
};

/// Returns the image of a grid under an affine map, exact up to rounding: control points are mapped, and weights are
/// unchanged (affine invariance). Points that are shared or collapsed remain so. A fit error grows with the map's norm,
/// and by the rounding of the points. A map with a negative determinant flips normals.
///
/// Errors: non_finite (the map, or a point too large; index = the patch).
Result<PatchGrid> transform(const PatchGrid& grid, const Affine& map);

/// @name Operations on splines
/// Results are the same curve or surface on the same domain, right up to rounding. Unchanged control points keep their
/// bits. Rational splines remain rational.
/// @{

/// Inserts knots.
///
/// - `knots`: each as often as listed, strictly inside the domain. With the knots already there, the multiplicity of
///   each is at most the degree.
///
/// Errors: non_finite, invalid_argument (index = the knot), out_of_memory.
///
/// Source: Boehm 1980; Piegl and Tiller, The NURBS Book, sec. 5.2, 5.3.
Result<Curve> insert_knots(const Curve& curve, std::span<const double> knots);
/// Inserts knots in both directions. Errors: as above.
Result<BSplineSurface> insert_knots(const BSplineSurface& surface, std::span<const double> knots_u,
                                    std::span<const double> knots_v);

/// Clamps: knots end where the domain ends, (degree + 1)-fold. An unclamped spline, or one with a smaller domain than
/// its knots, becomes clamped, and the border points become control points of its border curves. Errors: out_of_memory.
Result<Curve> clamp_ends(const Curve& curve);
/// Clamps both directions. Errors: out_of_memory.
Result<BSplineSurface> clamp_ends(const BSplineSurface& surface);

/// Clamps, and raises the degree by `by` >= 0. Each knot's multiplicity rises by as much. Errors: invalid_argument,
/// unsupported_degree. Source: blossoms (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 8.7).
Result<Curve> elevate_degree(const Curve& curve, int by);
/// Raises both degrees. Errors: as above.
Result<BSplineSurface> elevate_degree(const BSplineSurface& surface, int by_u, int by_v);

/// Returns both curves clamped, of the higher degree of the two, and on the union of their knots (by ==: knots that
/// differ by rounding are both kept). One may be rational and the other not. Errors: invalid_argument (different
/// domains), out_of_memory.
Result<std::pair<Curve, Curve>> make_compatible(const Curve& a, const Curve& b);

/// @}

/// A curve as Bezier pieces that share their end points: piece k has the points k * degree .. (k + 1) * degree and
/// covers [breaks[k], breaks[k+1]].
struct BezierPieces {
  int degree = 1;               ///< degree of every piece
  std::vector<double> breaks;   ///< strictly increasing
  std::vector<Vec3> points;     ///< (breaks.size() - 1) * degree + 1
  std::vector<double> weights;  ///< one per point, also if all are equal; empty if the curve is polynomial
};
/// Converts a curve to Bezier pieces. Errors: out_of_memory.
Result<BezierPieces> to_bezier(const Curve& curve);

/// Converts a surface to one patch per rectangle between distinct knots, within the domain. All patches are rational if
/// the surface is, otherwise none. Control points are convex combinations of the surface's; a control point of full
/// multiplicity keeps its bits. Errors: out_of_memory. Memory and time: O(output). Source: Borden, Scott, Evans, Hughes
/// 2011, Isogeometric finite element data structures based on Bezier extraction.
Result<PatchGrid> to_bezier(const BSplineSurface& surface);

/// The patches (a, b) of a grid with a0 <= a < a1, b0 <= b < b1.
struct PatchRange {
  std::size_t a0 = 0, a1 = 0, b0 = 0, b1 = 0;          ///< [a0, a1) x [b0, b1)
  bool empty() const { return a0 >= a1 || b0 >= b1; }  ///< whether the range has no patch
  friend bool operator==(const PatchRange&, const PatchRange&) = default;
};
/// Returns the patches of to_bezier(surface) that control point [i][j] affects: at most (degree_u + 1) (degree_v + 1).
/// The range is empty for a point that acts only outside the domain. Errors: invalid_argument (no such point).
Result<PatchRange> touched_patches(const BSplineSurface& surface, std::size_t i, std::size_t j);

/// @name Conversions of the other kinds of surfaces
/// Neighbours in a grid share their borders by ==. Memory: O(output); the surface is not kept. Threads: any number of
/// calls at once; functions of the caller are called as their surface says.
/// @{

/// Converts a tensor patch to one Bezier patch over the patch's domain; exact up to rounding. Errors: non_finite
/// (points too large).
Result<PatchGrid> to_bezier(const TensorPatch& patch);

/// Converts a Hermite patch to one bicubic patch over the patch's domain; exact up to rounding. Errors: non_finite (too
/// large).
Result<PatchGrid> to_bezier(const HermitePatch& patch);

/// Converts a Hermite network to one bicubic patch per cell, over the knots; exact up to rounding. Errors: non_finite
/// (too large).
Result<PatchGrid> to_bezier(const HermiteNetwork& network);

/// Converts an explicit polynomial to one polynomial patch of the same degrees (1 for degree 0), exactly: control
/// heights are the polar forms of the polynomial at the rectangle's ends, summed with 106 bits. Errors: non_finite (a
/// height is out of the range of doubles).
Result<PatchGrid> to_bezier(const ExplicitPolynomial& surface);

/// Converts a piece exactly to rational patches: degree 2 along circles, hyperbolas and parabolas, degree 1 along
/// straight lines. Angular ranges are split into arcs of at most 90 degrees, ranges of cosh into pieces of at most 2.
/// Breakpoints are canonical parameters; between two of them, the patch covers the same strip at another pace, which
/// grid_parameters() undoes. Errors: non_finite (points too large), out_of_memory. Source: rational quadratics in
/// standard form (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 12.2 to 12.4).
Result<PatchGrid> to_bezier(const QuadricPiece& piece);

/// How to_bezier() fits surfaces that it cannot convert exactly.
struct FitOptions {
  /// The largest distance from the surface at equal parameters, in the model's unit; 0 for 1e-6 of the diagonal of the
  /// box of 17 x 17 points.
  double tolerance = 0;
  int degree = 3;                      ///< degree of the patches in each direction, 2 to max_degree
  std::size_t max_patches = 1u << 16;  ///< more are an error
  /// Whether to use the surface's bounds, if any. Sampled fits take fewer patches and more calls.
  bool certify = true;
  /// Inner parameters where the surface is not smooth: breakpoints from the start, so that no patch crosses them.
  /// Finite, increasing, within the open range of u (or v).
  std::vector<double> breaks_u = {}, breaks_v = {};
};

/// Converts a ruled surface.
///
/// - Exact borders give an exact result (FitError 0): curves are made compatible, rational ones with different weight
///   functions over a common denominator, with numerators (1 - t) N1 w2 + t N2 w1 over w1 w2, of degree p1 + p2.
/// - Other borders are fitted by `options`, with breakpoints at inner knots of a border that is a curve.
///
/// Errors: unsupported_degree (above max_degree), non_finite, invalid_weight (products of weights below 1e-100 of their
/// patch's largest), those of a fit.
Result<PatchGrid> to_bezier(const RuledSurface& surface, const FitOptions& options = {});

/// Converts a Coons patch, with blends of degree a in u and b in v.
///
/// - If is_exact(), the result is exact (FitError 0). Polynomial borders give bidegree (max(n_C, a), max(n_D, b)) over
///   merged knots; rational ones by clearing denominators, in general (p_C1 + p_C2 + a, p_D1 + p_D2 + b).
/// - Otherwise it is a fit by `options`, certified if all borders have bounds and the blends are polynomials, with
///   breakpoints at inner knots of borders that are curves.
///
/// Errors: unsupported_degree (above max_degree: says which), non_finite, invalid_weight (products of weights below
/// 1e-100 of their patch's largest), those of a fit.
Result<PatchGrid> to_bezier(const CoonsPatch& patch, const FitOptions& options = {});

/// Fits a surface by patches that interpolate it at Chebyshev-Lobatto parameters. Intervals between breakpoints are
/// halved where the tolerance is not reached, as often as needed next to a border with infinite derivatives. Only
/// positions are evaluated. Neighbours share their borders by ==, and edges on which all positions are equal by == are
/// collapsed.
///
/// PatchGrid::fit_error() of the result is one of two:
///
/// - a proven bound, where the surface has bounds on its derivatives that suffice, taking the function's values as
///   exact. The function is called once for each of (n cu + 1)(n cv + 1) points of cu x cv patches of degree n.
/// - otherwise the largest deviation found at (3 n + 1)^2 points of every patch, with about fifteen to forty times as
///   many calls. Features narrower than the gaps between these points can be missed; fit sub-rectangles around them.
///
/// Errors: invalid_argument (options; a tolerance below what rounding leaves; one that is not reached with the largest
/// number of patches, or at a jump: says what was reached, and where), those of position().
Result<PatchGrid> to_bezier(const ParametricSurface& surface, const FitOptions& options = {});

/// Converts by the kind's own conversion, exactly; only callables are fitted by `options`. Errors: those of the kind.
Result<PatchGrid> to_bezier(const Surface& surface, const FitOptions& options = {});

/// @}

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
