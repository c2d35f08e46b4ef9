#pragma once
// Surfaces as grids of Bezier patches, and the map between a surface's parameters and its patches'.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tessera/affine.h"
#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera {

class BSplineSurface;

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

}  // namespace tessera
#pragma GCC visibility pop
