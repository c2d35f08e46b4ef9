#pragma once
// B-spline and NURBS surfaces in double, with the scalar reference evaluator.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"
#include "tessera/vec.h"

#pragma GCC visibility push(default)
namespace tessera {

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

}  // namespace tessera
#pragma GCC visibility pop
