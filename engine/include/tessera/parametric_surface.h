#pragma once
// Surfaces and curves that are functions of the caller's: evaluated as they are, and fitted by Bezier patches to a stated
// tolerance.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

class PatchGrid;  // tessera/convert.h

/// What the caller knows of a surface p(u,v). Functions are called from one thread at a time, or from several if const
/// calls on the surface are; what they throw becomes a Status.
struct SurfaceFunctions {
  std::function<Vec3(double u, double v)> position;  ///< p(u,v); must be given
  /// Position and derivatives to the second order; by differences if empty.
  std::function<SurfaceJet(double u, double v)> jet = {};
  /// Bounds of |d^k p / du^k| and |d^k p / dv^k| over a rectangle within the domain, k from 1 to 16; infinity where there
  /// is none. If empty, fits are sampled, not certified. One that is too small makes a certificate false.
  std::function<std::array<double, 2>(const Domain& part, int k)> derivative_bounds = {};
};

/// A disc of parameters.
struct Disc {
  double x = 0, y = 0, radius = 1;  ///< centre and radius, above 0
};

/// The polar map of a disc: x = x0 + s rho cos(theta), y = y0 + s rho sin(theta), rho from 0 to the radius R and theta
/// from 0 to 2 pi. The factor s is a little below 1, so that the points lie within the disc also after rounding: the
/// rim is short of R by at most 7 units of 2^-52 of R and two of |x0| + |y0|, and R*R - dx*dx - dy*dy with dx = x - x0,
/// dy = y - y0, in doubles and in any order, is never negative. (The root of it at the rim is noise below 1e-7 R.) The
/// centre is one point for all theta, and theta = 2 pi is theta = 0, by ==.
class PolarMap {
 public:
  /// Errors: non_finite (the disc, or its box), invalid_argument (a radius that is not positive, or lost beside the
  /// centre).
  static Result<PolarMap> make(const Disc& disc);
  Domain domain() const;                                             ///< [0, R] x [0, 2 pi]
  const Disc& disc() const { return disc_; }                         ///< as given
  double scale() const { return scale_; }                            ///< s
  std::array<double, 2> operator()(double rho, double theta) const;  ///< x and y
  /// By rho and theta, from position and derivatives by x and y at the same point.
  SurfaceJet chain_rule(const SurfaceJet& by_xy, double rho, double theta) const;

 private:
  PolarMap() = default;
  Disc disc_;
  double scale_ = 1;
};

/// p(u,v) on a rectangle. Immutable but for assignment; copies share their functions.
class ParametricSurface {
 public:
  /// Errors: invalid_argument (no position, a rectangle that is empty or reversed), non_finite (the rectangle; the
  /// position at a corner). Functions made of expressions over any scalar type get all three by generic_surface() of
  /// tessera/generic_callable.h.
  static Result<ParametricSurface> make(SurfaceFunctions functions, const Domain& domain = {});
  /// p(x,y) over a disc by its polar map: u is rho, v theta. The edge u = 0 is collapsed, v0 and v1 are one curve.
  /// Derivatives given are by x and y; those of the map are put in. Bounds are left out, for those of pure derivatives
  /// say nothing of the mixed ones that polar lines need (generic_surface_over_disc() finds them). Errors: as above,
  /// and those of PolarMap.
  static Result<ParametricSurface> over_disc(SurfaceFunctions functions, const Disc& disc = {});

  const Domain& domain() const { return data_->domain; }  ///< where it is evaluated
  /// Errors: non_finite (names u and v), invalid_argument (the function threw: its message).
  Result<Vec3> position(double u, double v) const;
  bool has_derivatives() const { return data_->functions.jet != nullptr; }  ///< false: differences are taken
  /// False: fits are sampled, not certified.
  bool has_bounds() const { return data_->functions.derivative_bounds != nullptr; }
  /// Bounds over a part of the domain, k >= 0; infinity where none is known.
  std::array<double, 2> derivative_bounds(const Domain& part, int k) const;

 private:
  struct Data {
    SurfaceFunctions functions;
    Domain domain;
  };
  explicit ParametricSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  std::shared_ptr<const Data> data_;
  friend Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);
};

/// By the caller's derivatives, else by differences within the domain: 64 calls. With L the domain's length along u (or
/// v), h = L / 256, F a bound of |p| near (u,v) and F_ab one of |d^(a+b) p / du^a dv^b|, the errors are at most
///   p_u: h^6 F_70 / 140 + 2^-42 F / L,  p_uu: h^6 F_80 / 560 + 2^-33 F / L^2,
///   p_uv: h^6 F_71 / 140 + k^6 F_17 / 63 + 2^-33 F / (L_u L_v), k being v's h;
/// within three steps of the domain's edges
///   p_u: h^6 F_70 / 7 + 2^-39 F / L,  p_uu: 0.7 h^5 F_70 + 2^-29 F / L^2,
///   p_uv: h^6 F_71 / 7 + 9 k^6 F_17 + 2^-25 F / (L_u L_v).
/// Errors: as of position(); non_finite (a derivative: names it and (u,v)).
Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);

/// How closely, and by how many patches, a callable is fitted.
struct FitOptions {
  /// How far patches may lie from the surface at equal parameters, in the model's unit; 0 for 1e-6 of the diagonal of
  /// the box of 17 x 17 points.
  double tolerance = 0;
  int degree = 3;                      ///< of the patches, each way; 2 to max_degree
  std::size_t max_patches = 1u << 16;  ///< more are an error
  /// By the surface's bounds, where it has them. Else by sampling, which takes fewer patches and more calls.
  bool certify = true;
  /// Inner parameters at which the surface is not smooth: breakpoints from the start, so that no patch goes across.
  /// Finite, increasing, within the open range of u (or v).
  std::vector<double> breaks_u = {}, breaks_v = {};
};

/// Patches that interpolate the surface at Chebyshev-Lobatto parameters, over breakpoints that are halved where the
/// tolerance is not kept: towards a border where derivatives are infinite they get as close as it needs. Only positions
/// are asked for. Neighbours share their borders by ==, and edges on which all positions are equal by == are collapsed.
/// PatchGrid::fit_error() is a proven bound where the surface has bounds on its derivatives that suffice, taking the
/// function's values as exact; then the function is called once for each of (n cu + 1)(n cv + 1) points of cu x cv
/// patches of degree n. Else it is the largest deviation found at (3 n + 1)^2 points of every patch, with about fifteen
/// to forty times as many calls. What is narrower than the gaps between these points can be missed: a caller who knows
/// of such features fits sub-rectangles. Errors: invalid_argument (options; a tolerance below what rounding leaves; one
/// that is not kept by the largest count of patches, or at a jump: says what was reached, and where), and those of
/// position().
Result<PatchGrid> to_bezier(const ParametricSurface& surface, const FitOptions& options = {});

/// What the caller knows of a curve c(t). Functions are called from one thread at a time, or from several if const
/// calls on the curve are; what they throw becomes a Status.
struct CurveFunctions {
  std::function<Vec3(double t)> position;  ///< c(t); must be given
  /// Position, first and second derivative; by differences if empty.
  std::function<CurveJet(double t)> jet = {};
  /// A bound of |d^k c / dt^k| over an interval within the domain, k from 0 (|c| itself) to 16; infinity where there is
  /// none. If empty, fits are not certified. One that is too small makes a certificate false.
  std::function<double(const Interval& part, int k)> derivative_bound = {};
};

/// c(t) on an interval. Immutable but for assignment; copies share their functions.
class ParametricCurve {
 public:
  /// Errors: invalid_argument (no position, an interval that is empty or reversed), non_finite (the interval; the
  /// position at an end). Functions made of expressions over any scalar type get all three by generic_curve() of
  /// tessera/generic_callable.h.
  static Result<ParametricCurve> make(CurveFunctions functions, const Interval& domain = {});

  const Interval& domain() const { return data_->domain; }  ///< where it is evaluated
  /// Errors: non_finite (names t), invalid_argument (the function threw: its message).
  Result<Vec3> position(double t) const;
  bool has_derivatives() const { return data_->functions.jet != nullptr; }  ///< false: differences are taken
  /// False: fits are sampled, not certified.
  bool has_bounds() const { return data_->functions.derivative_bound != nullptr; }
  /// A bound of |d^k c / dt^k| over a part of the domain, k >= 0; infinity where none is known.
  double derivative_bound(const Interval& part, int k) const;

 private:
  struct Data {
    CurveFunctions functions;
    Interval domain;
  };
  explicit ParametricCurve(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  std::shared_ptr<const Data> data_;
  friend Result<CurveJet> evaluate_jet(const ParametricCurve& curve, double t);
};

/// By the caller's derivatives, else by differences as ParametricSurface takes them. t in the domain. Errors: as of
/// position().
Result<CurveJet> evaluate_jet(const ParametricCurve& curve, double t);

/// A border: exact, or a function.
using BorderCurve = std::variant<Curve, ParametricCurve>;
const Interval& domain(const BorderCurve& border);
/// Errors: those of the function; non_finite (t).
Result<Vec3> position(const BorderCurve& border, double t);
Result<CurveJet> evaluate_jet(const BorderCurve& border, double t);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
