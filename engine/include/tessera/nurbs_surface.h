#pragma once
// B-spline and NURBS surfaces in double with their scalar reference evaluator; circles and surfaces of revolution as
// exact NURBS.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A NURBS surface: s(u,v) = sum_ij N_{i,p}(u) N_{j,q}(v) P_ij or, rational, sum N N w_ij P_ij / sum N N w_ij, of
/// degrees 1 to max_degree (Piegl and Tiller, The NURBS Book, 2nd ed., ch. 3 and 4).
///
/// Each direction has its knots, as many as points plus degree plus 1. They do not decrease. A knot strictly inside the
/// domain [u_p, u_{m+1}] has multiplicity at most p (with p the surface is only C0 there), one at its ends or outside
/// at most p + 1. So knots may be clamped, unclamped or uniform; surfaces that close on periodic knots repeat their
/// first p rows at the end. Points are stored [i][j], i along u. Immutable except for assignment; copies share
/// everything.
class BSplineSurface {
 public:
  /// Makes a polynomial surface.
  ///
  /// - `points`: knots_u.size() - degree_u - 1 by knots_v.size() - degree_v - 1 points.
  /// - `domain`: a part of the domain of the knots; all of it if empty.
  ///
  /// Errors: unsupported_degree, count_mismatch, non_finite, invalid_argument (index = the point or the knot).
  static Result<BSplineSurface> polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                           std::span<const double> knots_v, std::span<const Vec3> points,
                                           std::optional<Domain> domain = {});
  /// Makes a polynomial surface and keeps the points without a copy. Errors: as above.
  static Result<BSplineSurface> polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                           std::span<const double> knots_v, std::vector<Vec3>&& points,
                                           std::optional<Domain> domain = {});
  /// Makes a rational surface.
  ///
  /// - `points`: not premultiplied.
  /// - `weights`: one finite weight > 0 per point, at least 1e-100 of the largest. They are dropped if all are equal by
  ///   ==. They must be > 0 even if the denominator is anyway, as in BezierPatch::rational(): knot insertion and
  ///   extraction make such points.
  ///
  /// Errors: those of polynomial(), invalid_weight (index = the weight).
  static Result<BSplineSurface> rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                         std::span<const double> knots_v, std::span<const Vec3> points,
                                         std::span<const double> weights, std::optional<Domain> domain = {});
  /// Makes a rational surface and keeps the points and weights without a copy. Errors: as above.
  static Result<BSplineSurface> rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                         std::span<const double> knots_v, std::vector<Vec3>&& points,
                                         std::vector<double>&& weights, std::optional<Domain> domain = {});

  int degree_u() const { return data_->degree_u; }
  int degree_v() const { return data_->degree_v; }
  /// Number of points along u.
  std::size_t count_u() const { return knots_u().size() - static_cast<std::size_t>(degree_u()) - 1; }
  /// Number of points along v.
  std::size_t count_v() const { return knots_v().size() - static_cast<std::size_t>(degree_v()) - 1; }
  std::span<const double> knots_u() const { return data_->knots_u; }  ///< count_u() + degree_u() + 1
  std::span<const double> knots_v() const { return data_->knots_v; }  ///< count_v() + degree_v() + 1
  bool is_rational() const { return !data_->weights.empty(); }        ///< whether it has weights that differ
  std::span<const Vec3> points() const { return data_->points; }      ///< `[i][j]`, not premultiplied
  std::span<const double> weights() const { return data_->weights; }  ///< empty for a polynomial surface
  /// Returns point (i, j); i < count_u(), j < count_v().
  const Vec3& point(std::size_t i, std::size_t j) const { return data_->points[i * count_v() + j]; }
  /// Returns the weight of point (i, j); 1 in a polynomial surface.
  double weight(std::size_t i, std::size_t j) const { return is_rational() ? data_->weights[i * count_v() + j] : 1.0; }
  const Domain& domain() const { return data_->domain; }  ///< rectangle on which it is evaluated

 private:
  struct Data {
    int degree_u, degree_v;
    std::vector<double> knots_u, knots_v, weights;
    std::vector<Vec3> points;
    Domain domain;
  };
  explicit BSplineSurface(Data data);
  std::shared_ptr<const Data> data_;
};

/// Evaluates by de Boor's algorithm, by the surface's own parameters, rational surfaces in homogeneous form: the
/// reference evaluator, for any finite (u,v). At a knot it takes the span on the right, and at the end of the domain
/// the span on the left; at a knot of full multiplicity derivatives are those of that span. Outside the domain the
/// border pieces continue.
SurfaceJet evaluate_jet(const BSplineSurface& surface, double u, double v);

/// An axis of revolution, and the direction of angle zero. Angles grow counter-clockwise as seen from the tip of
/// `direction`.
struct Axis {
  Vec3 origin{0, 0, 0};     ///< a point of the axis
  Vec3 direction{0, 0, 1};  ///< any length > 0
  Vec3 zero{1, 0, 0};       ///< not parallel to direction; only its part across the axis counts
};

/// Number of rational quadratic arcs in a full circle (Piegl and Tiller, The NURBS Book, 2nd ed., sec. 7.5): four
/// through the corners of a square with inner weights sqrt(2)/2, or three through the corners of a triangle with inner
/// weights 1/2.
enum class CircleArcs : std::uint8_t { three = 3, four = 4 };

/// @name Makers of circles and surfaces of revolution
/// u in [0, 1] is the full turn, and arc k of n is on [k/n, (k+1)/n]. Inner knots are double: the point set is C1, but
/// the parametrisation is only C0.
/// @{

/// Makes a circle about the axis's origin, from the direction of angle zero. Errors: invalid_argument (a radius that is
/// not positive, an axis without a direction or parallel to its `zero`), non_finite (the radius, the axis, a point too
/// large).
Result<Curve> make_nurbs_circle(const Axis& axis, double radius, CircleArcs arcs = CircleArcs::four);
/// Revolves `profile` about the axis: u is the turn, and v the profile's parameter with its degree and knots. Weights
/// are products. Points of the profile on the axis make poles. Errors: invalid_argument (the axis, as above),
/// non_finite (the axis, a point too large). Source: The NURBS Book, sec. 8.5, in closed form.
Result<BSplineSurface> make_surface_of_revolution(const Curve& profile, const Axis& axis,
                                                  CircleArcs arcs = CircleArcs::four);
/// Makes a sphere about the axis's origin. v in [0, 1] runs from the pole at -direction to the pole at +direction, over
/// two arcs. The normal points outwards. Errors: as for make_nurbs_circle().
Result<BSplineSurface> make_nurbs_sphere(const Axis& axis, double radius, CircleArcs arcs = CircleArcs::four);
/// Makes a torus: the tube of radius `minor` about the circle of radius `major` > minor. v in [0, 1] runs around the
/// tube from its outermost circle towards +direction. The normal points outwards. Errors: as for make_nurbs_circle(),
/// and invalid_argument (a tube as thick as its ring).
Result<BSplineSurface> make_nurbs_torus(const Axis& axis, double major, double minor,
                                        CircleArcs arcs = CircleArcs::four);
/// Makes a cylinder from the origin to origin + height * direction / |direction|, with v in [0, 1] along it. Errors: as
/// for make_nurbs_circle(), invalid_argument (a height of 0), non_finite (the height).
Result<BSplineSurface> make_nurbs_cylinder(const Axis& axis, double radius, double height,
                                           CircleArcs arcs = CircleArcs::four);
/// Makes a cone like make_nurbs_cylinder(), with radius `bottom` at the origin and `top` at the height. One of the
/// radii may be zero: an apex. Errors: as for make_nurbs_cylinder(), and invalid_argument (two radii of 0, one below
/// 0).
Result<BSplineSurface> make_nurbs_cone(const Axis& axis, double bottom, double top, double height,
                                       CircleArcs arcs = CircleArcs::four);

/// @}

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
