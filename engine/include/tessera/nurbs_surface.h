#pragma once
// B-spline and NURBS surfaces in double with the scalar reference evaluator; circles and surfaces of revolution as exact
// NURBS.

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
namespace tessera::inline abi_0_1 {

/// s(u,v) = sum_ij N_{i,p}(u) N_{j,q}(v) P_ij or, rational, sum N N w_ij P_ij / sum N N w_ij, of degrees 1 to
/// max_degree (Piegl and Tiller, The NURBS Book, 2nd ed., ch. 3 and 4). Each direction has its knots, as many as
/// points, degree and 1: they do not decrease; a knot within the domain [u_p, u_{m+1}] stands at most p times (p-fold
/// it breaks to C0), one at its ends or outside at most p + 1 times. So they may be clamped, unclamped, uniform;
/// surfaces that close on periodic knots repeat their first p rows at the end. Points are stored [i][j], i along u.
/// Immutable but for assignment; copies share everything.
class BSplineSurface {
 public:
  /// There are knots_u.size() - degree_u - 1 by knots_v.size() - degree_v - 1 points. `domain`: a part of the domain of
  /// the knots; all of it if empty. Errors: unsupported_degree, count_mismatch, non_finite, invalid_argument (index =
  /// the point or the knot).
  static Result<BSplineSurface> polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                           std::span<const double> knots_v, std::span<const Vec3> points,
                                           std::optional<Domain> domain = {});
  /// The same; points that are moved here are kept without a copy.
  static Result<BSplineSurface> polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                           std::span<const double> knots_v, std::vector<Vec3>&& points,
                                           std::optional<Domain> domain = {});
  /// `weights`: one finite weight > 0 a point, at least 1e-100 of the largest; zero and negative ones are refused even
  /// where the denominator stays positive, for the reasons that BezierPatch gives: knot insertion and extraction make
  /// such points. If all are equal by == they are dropped. `points` are not premultiplied.
  /// Errors: as above, and invalid_weight (index = the weight).
  static Result<BSplineSurface> rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                         std::span<const double> knots_v, std::span<const Vec3> points,
                                         std::span<const double> weights, std::optional<Domain> domain = {});
  /// The same; points and weights that are moved here are kept without a copy.
  static Result<BSplineSurface> rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                         std::span<const double> knots_v, std::vector<Vec3>&& points,
                                         std::vector<double>&& weights, std::optional<Domain> domain = {});

  int degree_u() const { return data_->degree_u; }  ///< along u
  int degree_v() const { return data_->degree_v; }  ///< along v
  /// Points along u.
  std::size_t count_u() const { return knots_u().size() - static_cast<std::size_t>(degree_u()) - 1; }
  /// Points along v.
  std::size_t count_v() const { return knots_v().size() - static_cast<std::size_t>(degree_v()) - 1; }
  std::span<const double> knots_u() const { return data_->knots_u; }  ///< as given
  std::span<const double> knots_v() const { return data_->knots_v; }  ///< as given
  bool is_rational() const { return !data_->weights.empty(); }        ///< whether it has weights that differ
  std::span<const Vec3> points() const { return data_->points; }      ///< `[i][j]`, not premultiplied
  std::span<const double> weights() const { return data_->weights; }  ///< empty for a polynomial surface
  /// i < count_u(), j < count_v().
  const Vec3& point(std::size_t i, std::size_t j) const { return data_->points[i * count_v() + j]; }
  /// Of point (i, j); 1 in a polynomial surface.
  double weight(std::size_t i, std::size_t j) const { return is_rational() ? data_->weights[i * count_v() + j] : 1.0; }
  const Domain& domain() const { return data_->domain; }  ///< where it is evaluated

 private:
  struct Data {
    int degree_u, degree_v;
    std::vector<double> knots_u, knots_v, weights;
    std::vector<Vec3> points;
    Domain domain;
  };
  explicit BSplineSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  std::shared_ptr<const Data> data_;
};

/// The reference evaluator, by the surface's own parameters: de Boor's algorithm, rational surfaces in homogeneous
/// form. At a knot the span on its right counts, at the end of the domain the one on its left: so at a knot of full
/// multiplicity derivatives are those of that side. Outside the domain the border pieces go on. Any finite (u,v).
SurfaceJet evaluate_jet(const BSplineSurface& surface, double u, double v);

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

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
