#pragma once
// Bezier, B-spline and NURBS curves in double: profiles of revolution, borders of ruled surfaces and Coons patches.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <optional>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/detail/shared_memory.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// An interval of a parameter, from < to.
struct Interval {
  double from = 0, to = 1;                                             ///< from < to
  friend bool operator==(const Interval&, const Interval&) = default;  ///< by both ends
};

/// A NURBS curve: c(t) = sum_i N_{i,p}(t) P_i or, rational, sum N w_i P_i / sum N w_i, of degree 1 to max_degree (Piegl
/// and Tiller, The NURBS Book, 2nd ed., ch. 3 and 4).
///
/// The knots t_0 .. t_{m+p+1} of points 0 .. m do not decrease. A knot strictly inside [t_p, t_{m+1}] has multiplicity
/// at most p (with p the curve is only C0 there), one at the ends or outside at most p + 1. Curves may be clamped or
/// not; closed curves on periodic knots repeat their first p points at the end. Immutable except for assignment; copies
/// share everything.
class Curve {
 public:
  /// Makes a Bezier curve of degree points.size() - 1, with weights as for nurbs() or none. Errors: as for nurbs().
  static Result<Curve> bezier(std::span<const Vec3> points, std::span<const double> weights = {},
                              const Interval& domain = {});
  /// Makes a polynomial B-spline curve.
  ///
  /// - `knots`: points.size() + degree + 1 of them, as above.
  /// - `domain`: within [t_p, t_{m+1}]; all of it if empty.
  ///
  /// Errors: unsupported_degree, count_mismatch, non_finite, invalid_argument (index = the point or knot).
  static Result<Curve> b_spline(int degree, std::span<const Vec3> points, std::span<const double> knots,
                                std::optional<Interval> domain = {});
  /// Makes a NURBS curve.
  ///
  /// - `points`: not premultiplied.
  /// - `weights`: one finite weight > 0 per point, at least 1e-100 of the largest. They are dropped if all are equal by
  ///   ==. They must be > 0 even if the denominator is anyway, as in BezierPatch::rational(): knot insertion and
  ///   extraction make such points.
  ///
  /// Errors: those of b_spline(), invalid_weight (index = the weight).
  static Result<Curve> nurbs(int degree, std::span<const Vec3> points, std::span<const double> weights,
                             std::span<const double> knots, std::optional<Interval> domain = {});

  int degree() const { return data().degree; }                        ///< degree of every piece
  bool is_rational() const { return !data().weights.empty(); }        ///< whether it has weights that differ
  std::span<const Vec3> points() const { return data().points; }      ///< not premultiplied
  std::span<const double> weights() const { return data().weights; }  ///< empty for a polynomial curve
  /// Returns the weight of point i; 1 in a polynomial curve.
  double weight(std::size_t i) const { return is_rational() ? data().weights[i] : 1.0; }
  std::span<const double> knots() const { return data().knots; }  ///< points().size() + degree() + 1
  const Interval& domain() const { return data().domain; }        ///< interval on which it is evaluated
  /// Compares degree, points, weights, knots and domain, by the == of numbers.
  bool operator==(const Curve& other) const;

 private:
  /// The head of a curve's memory. All that the lists hold lies behind it.
  struct Data {
    int degree;
    std::span<const Vec3> points;
    std::span<const double> weights, knots;
    Interval domain;
  };
  Curve(int degree, std::span<const Vec3> points, std::span<const double> weights, std::span<const double> knots,
        const Interval& domain);
  const Data& data() const { return *static_cast<const Data*>(memory_.data()); }

  SharedMemory memory_;
};

/// Position, first and second derivative by the curve's own parameter.
struct CurveJet {
  Vec3 position, first, second;  ///< c(t) and its derivatives by t
};

/// Evaluates by de Boor's algorithm, rational curves in homogeneous form: the reference evaluator, for any finite t. At
/// a knot it takes the span on the right, and at the end of the domain the span on the left; derivatives that jump
/// there are those of that span. Outside the domain, the first and the last piece continue.
CurveJet evaluate_jet(const Curve& curve, double t);
/// Returns the position alone, with the same bits.
Vec3 position(const Curve& curve, double t);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
