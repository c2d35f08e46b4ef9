#pragma once
// Surfaces that are functions of the caller's: evaluated as they are, and fitted by Bezier patches to a stated
// tolerance.

#include <array>
#include <cstddef>
#include <functional>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"
#include "tessera/vec.h"

namespace tessera {

class PatchGrid;  // tessera/convert.h

/// What the caller knows of a surface p(u,v). What functions throw becomes a Status.
struct SurfaceFunctions {
  std::function<Vec3(double u, double v)> position;
  /// Position and derivatives to the second order; by differences if empty.
  std::function<SurfaceJet(double u, double v)> jet = {};
  /// Bounds of |d^k p / du^k| and |d^k p / dv^k| over a rectangle; infinity where there is none. If empty, fits are
  /// sampled, not certified.
  std::function<std::array<double, 2>(const Domain& part, int k)> derivative_bounds = {};
};

/// A disc of parameters.
struct Disc {
  double x = 0, y = 0, radius = 1;
};

/// p(u,v) on a rectangle. Immutable but for assignment; copies share their functions.
class ParametricSurface {
 public:
  /// Errors: invalid_argument (no position, a rectangle that is empty or reversed), non_finite (the rectangle; the
  /// position at a corner). Functions made of expressions over any scalar type get all three by generic_surface() of
  /// tessera/generic_callable.h.
  static Result<ParametricSurface> make(SurfaceFunctions functions, const Domain& domain = {});
  /// p over a disc by the polar map x = x0 + rho cos(theta), y = y0 + rho sin(theta): u is rho from 0 to the radius, v
  /// theta from 0 to 2 pi. The map stays within the disc in rounded arithmetic: its rim is short of the radius by at most
  /// 4 units of 2^-52, so that sqrt(R^2 - x^2 - y^2) is defined everywhere. The edge u = 0 is collapsed.
  /// Derivatives given are by x and y; those of the map are put in. Errors: as above.
  static Result<ParametricSurface> over_disc(SurfaceFunctions functions, const Disc& disc = {});

  const Domain& domain() const { return domain_; }
  /// Errors: non_finite (names u and v), invalid_argument (the function threw: its message).
  Result<Vec3> position(double u, double v) const;
  bool has_derivatives() const { return functions_.jet != nullptr; }
  bool has_bounds() const { return functions_.derivative_bounds != nullptr; }
  /// Bounds over a part of the domain, k >= 0; infinity where none is known.
  std::array<double, 2> derivative_bounds(const Domain& part, int k) const;

 private:
  ParametricSurface() = default;
  SurfaceFunctions functions_;
  Domain domain_;
  friend Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);
};

/// By the caller's derivatives, else by differences that stay within the domain. Errors: as of position().
Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);

struct FitOptions {
  /// How far patches may lie from the surface at equal parameters, in the model's unit; 0 for 1e-6 of the diagonal of
  /// the box of the surface's points.
  double tolerance = 0;
  int degree = 3;  ///< of the patches, each way; 2 to max_degree
  std::size_t largest_patch_count = 1u << 16;
};

/// Patches that interpolate the surface, over breakpoints that are halved where the tolerance is not kept. Neighbours
/// share their borders. PatchGrid::fit_error() is a proven bound where the surface has bounds on its derivatives, else
/// the largest deviation found by sampling. Errors: invalid_argument (options; the tolerance is not kept by the largest
/// count of patches: says what was reached), and those of position().
Result<PatchGrid> to_bezier(const ParametricSurface& surface, const FitOptions& options = {});

}  // namespace tessera
