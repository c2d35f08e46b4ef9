#pragma once
// Surfaces as grids of Bezier patches, and the map between a surface's parameters and its patches'; B-splines rewritten
// exactly with more knots, a higher degree, clamped ends, or as Bezier pieces.

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

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// A place in a grid of patches.
struct PatchLocation {
  std::size_t patch = 0;  ///< index into PatchGrid::patches()
  double u = 0, v = 0;    ///< local parameters, in [0,1]
};

/// How far the patches may lie from the surface that they stand for.
struct FitError {
  double distance = 0;    ///< 0 for an exact conversion, which is right to rounding
  bool certified = true;  ///< proven, not only sampled
};

/// One surface as patches over the rectangles between breakpoints: patch (a, b) covers [breaks_u[a], breaks_u[a+1]] x
/// [breaks_v[b], breaks_v[b+1]] and has the index a * count_v() + b. Every conversion ends in one. Neighbours share their border's
/// control points (and weights) by ==.
class PatchGrid {
 public:
  /// Breakpoints: at least two each way, finite, strictly increasing; (breaks_u - 1) * (breaks_v - 1) patches.
  /// Errors: invalid_argument, non_finite (index = the breakpoint), count_mismatch.
  static Result<PatchGrid> make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                std::vector<BezierPatch> patches, FitError error = {});

  std::size_t count_u() const { return breaks_u_.size() - 1; }       ///< patches along u
  std::size_t count_v() const { return breaks_v_.size() - 1; }       ///< patches along v
  std::span<const double> breaks_u() const { return breaks_u_; }     ///< strictly increasing, count_u() + 1
  std::span<const double> breaks_v() const { return breaks_v_; }     ///< strictly increasing, count_v() + 1
  std::span<const BezierPatch> patches() const { return patches_; }  ///< `[a][b]`
  /// The patches, taken out of a grid that is done with.
  std::vector<BezierPatch> take_patches() && { return std::move(patches_); }
  /// a < count_u(), b < count_v().
  const BezierPatch& patch(std::size_t a, std::size_t b) const { return patches_[a * count_v() + b]; }
  /// Between the first and the last breakpoints.
  Domain domain() const { return {breaks_u_.front(), breaks_u_.back(), breaks_v_.front(), breaks_v_.back()}; }
  Domain patch_domain(std::size_t patch) const;         ///< patch < patches().size()
  const FitError& fit_error() const { return error_; }  ///< of all patches
  /// Of all control points.
  const Box3& box() const { return box_; }

  /// The patch that holds (u,v) and the local parameters there. At an inner breakpoint the patch on its right; at the end
  /// of the domain the last one. Nothing for (u,v) outside the domain or NaN.
  std::optional<PatchLocation> locate(double u, double v) const;
  /// Position and derivatives by the surface's own parameters, at (u,v) as located. Nothing outside the domain.
  std::optional<SurfaceJet> evaluate_jet(double u, double v) const;

 private:
  PatchGrid() = default;
  /// `box`: of all control points.
  static Result<PatchGrid> make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                std::vector<BezierPatch> patches, FitError error, const Box3& box);
  friend Result<PatchGrid> to_bezier(const BSplineSurface& surface);  // knows the box of what it has just computed

  std::vector<double> breaks_u_, breaks_v_;
  std::vector<BezierPatch> patches_;
  FitError error_;
  Box3 box_;
};

/// The image of a grid, exact to rounding: control points are mapped, weights stay (affine invariance). What was shared
/// or collapsed stays so. A fit error grows with the map's norm, and by the rounding of the points. A map with a negative determinant turns normals over.
/// Errors: non_finite (the map, or a point too large; index = the patch).
Result<PatchGrid> transformed(const PatchGrid& grid, const Affine& map);

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

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
