#pragma once
// Surfaces and curves given by the caller's functions: evaluated directly, and fitted by Bezier patches to a stated
// tolerance.
//
// Memory: surfaces and curves share their functions with their copies. Threads: any number of calls at once on const
// objects, if their functions allow it.

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
namespace tessera { inline namespace abi_0_1 {

/// The caller's functions for a surface p(u,v). Threads: one thread calls the functions at a time, unless you make
/// const calls on the surface from several threads. An exception becomes a Status; if a bound throws one, there is no
/// bound.
struct SurfaceFunctions {
  std::function<Vec3(double u, double v)> position;  ///< p(u,v); required
  /// Position and derivatives up to the second order. If empty, derivatives are computed by differences.
  std::function<SurfaceJet(double u, double v)> jet = {};
  /// Bounds of |d^k p / du^k| and |d^k p / dv^k| over a rectangle within the domain, k from 1 to 16; infinity where
  /// there is none. If empty, fits are sampled, not certified. A bound that is too small makes a certificate false.
  std::function<std::array<double, 2>(const Domain& part, int k)> derivative_bounds = {};
};

/// A disc of parameters.
struct Disc {
  double x = 0, y = 0, radius = 1;  ///< centre, and radius > 0
};

/// The polar map of a disc: x = x0 + s rho cos(theta), y = y0 + s rho sin(theta), rho from 0 to the radius R and theta
/// from 0 to 2 pi. The centre is one point for all theta, and theta = 2 pi gives the point of theta = 0, by ==.
///
/// The factor s is a little below 1, so that points lie within the disc even after rounding: the rim is short of R by
/// at most 7 units of 2^-52 of R and two of |x0| + |y0|. So R*R - dx*dx - dy*dy with dx = x - x0, dy = y - y0, in
/// doubles and in any order, is never negative. (Its root at the rim is noise below 1e-7 R.)
class PolarMap {
 public:
  /// Makes the map of a disc. Errors: non_finite (the disc, or its box), invalid_argument (a radius that is not
  /// positive, or is lost beside the centre).
  static Result<PolarMap> make(const Disc& disc);
  Domain domain() const;                                             ///< [0, R] x [0, 2 pi]
  const Disc& disc() const { return disc_; }                         ///< the mapped disc
  double scale() const { return scale_; }                            ///< the factor s
  std::array<double, 2> operator()(double rho, double theta) const;  ///< returns x and y
  /// Returns the derivatives by rho and theta, from position and derivatives by x and y at the same point.
  SurfaceJet chain_rule(const SurfaceJet& by_xy, double rho, double theta) const;

 private:
  PolarMap() = default;
  Disc disc_;
  double scale_ = 1;
};

/// A surface p(u,v) on a rectangle. Immutable except for assignment; copies share their functions.
class ParametricSurface {
 public:
  /// Makes a surface from functions. generic_surface() of tessera/generic_callable.h makes all three functions from an
  /// expression over any scalar type.
  ///
  /// Errors: invalid_argument (no position, a rectangle that is empty or reversed), non_finite (the rectangle; the
  /// position at a corner).
  static Result<ParametricSurface> make(SurfaceFunctions functions, const Domain& domain = {});
  /// Makes a surface p(x,y) over a disc by its polar map: u is rho, v is theta. The edge u = 0 is collapsed; v0 and v1
  /// are one curve. Given derivatives are by x and y, and the chain rule is applied. Bounds are dropped: pure
  /// derivatives do not bound the mixed ones that polar curves need (generic_surface_over_disc() finds them).
  ///
  /// Errors: those of make() and PolarMap::make().
  static Result<ParametricSurface> over_disc(SurfaceFunctions functions, const Disc& disc = {});

  const Domain& domain() const { return data_->domain; }  ///< rectangle on which it is evaluated
  /// Returns p(u,v). Errors: non_finite (names u and v), invalid_argument (the function threw: its message).
  Result<Vec3> position(double u, double v) const;
  bool has_derivatives() const { return data_->functions.jet != nullptr; }  ///< if false, differences are used
  /// Whether there are bounds; if not, fits are sampled, not certified.
  bool has_bounds() const { return data_->functions.derivative_bounds != nullptr; }
  /// Returns bounds over a part of the domain, k >= 0; infinity where none is known.
  std::array<double, 2> derivative_bounds(const Domain& part, int k) const;

 private:
  struct Data {
    SurfaceFunctions functions;
    Domain domain;
  };
  explicit ParametricSurface(Data data);
  std::shared_ptr<const Data> data_;
  friend Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);
};

/// Returns position and derivatives, from the caller's function or else by differences within the domain in 64 calls.
///
/// Error bounds of differences, where L is the domain's length along u (or v), h = L / 256, k is the h of v, F is a
/// bound of |p| near (u,v) and F_ab a bound of |d^(a+b) p / du^a dv^b|:
///
/// - away from the domain's edges p_u: h^6 F_70 / 140 + 2^-42 F / L; p_uu: h^6 F_80 / 560 + 2^-33 F / L^2;
///   p_uv: h^6 F_71 / 140 + k^6 F_17 / 63 + 2^-33 F / (L_u L_v);
/// - within three steps of them p_u: h^6 F_70 / 7 + 2^-39 F / L; p_uu: 0.7 h^5 F_70 + 2^-29 F / L^2;
///   p_uv: h^6 F_71 / 7 + 9 k^6 F_17 + 2^-25 F / (L_u L_v).
///
/// The terms with F_ab are the truncation errors of the sextic through 7 values, central or one-sided; the others are
/// the rounding of values times the sum of the weights' sizes.
///
/// Errors: those of position(), non_finite (a derivative: names it and (u,v)).
///
/// Source: Fornberg 1988, Generation of finite difference formulas on arbitrarily spaced grids, Mathematics of
/// Computation 51.
Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v);

/// The caller's functions for a curve c(t). Threads: one thread calls the functions at a time, unless you make const
/// calls on the curve from several threads. An exception becomes a Status; if a bound throws one, there is no bound.
struct CurveFunctions {
  std::function<Vec3(double t)> position;  ///< c(t); required
  /// Position, first and second derivative. If empty, derivatives are computed by differences.
  std::function<CurveJet(double t)> jet = {};
  /// A bound of |d^k c / dt^k| over an interval within the domain, k from 0 (|c| itself) to 16; infinity where there is
  /// none. If empty, fits are not certified. A bound that is too small makes a certificate false.
  std::function<double(const Interval& part, int k)> derivative_bound = {};
};

/// A curve c(t) on an interval. Immutable except for assignment; copies share their functions.
class ParametricCurve {
 public:
  /// Makes a curve from functions. generic_curve() of tessera/generic_callable.h makes all three functions from an
  /// expression over any scalar type.
  ///
  /// Errors: invalid_argument (no position, an interval that is empty or reversed), non_finite (the interval; the
  /// position at an end).
  static Result<ParametricCurve> make(CurveFunctions functions, const Interval& domain = {});

  const Interval& domain() const { return data_->domain; }  ///< interval on which it is evaluated
  /// Returns c(t). Errors: non_finite (names t), invalid_argument (the function threw: its message).
  Result<Vec3> position(double t) const;
  bool has_derivatives() const { return data_->functions.jet != nullptr; }  ///< if false, differences are used
  /// Whether there are bounds; if not, fits are sampled, not certified.
  bool has_bounds() const { return data_->functions.derivative_bound != nullptr; }
  /// Returns a bound of |d^k c / dt^k| over a part of the domain, k >= 0; infinity where none is known.
  double derivative_bound(const Interval& part, int k) const;

 private:
  struct Data {
    CurveFunctions functions;
    Interval domain;
  };
  explicit ParametricCurve(Data data);
  std::shared_ptr<const Data> data_;
  friend Result<CurveJet> evaluate_jet(const ParametricCurve& curve, double t);
};

/// Returns position and derivatives at t in the domain, from the caller's function or else by differences as for
/// ParametricSurface. Errors: those of position(), non_finite (a derivative).
Result<CurveJet> evaluate_jet(const ParametricCurve& curve, double t);

/// A border: an exact curve, or a function.
using BorderCurve = std::variant<Curve, ParametricCurve>;
/// Returns the border's interval.
const Interval& domain(const BorderCurve& border);
/// Returns the border's point at t. Errors: those of the function, non_finite (t).
Result<Vec3> position(const BorderCurve& border, double t);
/// Returns the border's point and derivatives at t. Errors: as for position().
Result<CurveJet> evaluate_jet(const BorderCurve& border, double t);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
