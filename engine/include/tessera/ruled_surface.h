#pragma once
// Ruled surfaces between two curves.

#include <cstdint>
#include <memory>

#include "tessera/parametric_curve.h"
#include "tessera/parametric_surface.h"

#pragma GCC visibility push(default)
namespace tessera {

/// A direction of parameters.
enum class Direction : std::uint8_t { u, v };

/// r(u,v) = ((b - v) C1(u) + (v - a) C2(u)) / (b - a), v in [a, b]; or, with the straight lines along u, the same of
/// D1(v), D2(v) and u. Immutable but for assignment; copies share their curves.
class RuledSurface {
 public:
  /// `straight`: the direction of the straight lines, over the interval `across`. Errors: invalid_argument (curves on
  /// different intervals: says which; an interval that is empty or reversed), non_finite.
  static Result<RuledSurface> make(const BorderCurve& first, const BorderCurve& second, const Interval& across = {},
                                   Direction straight = Direction::v);

  const BorderCurve& first() const { return data_->first; }    ///< C1, or D1
  const BorderCurve& second() const { return data_->second; }  ///< C2, or D2
  Direction straight() const { return data_->straight; }       ///< the parameter that the straight lines run along
  Domain domain() const;                                       ///< of the curves, and `across`
  /// Both borders are Bezier, B-spline or NURBS curves: to_bezier() is exact.
  bool is_exact() const;

 private:
  struct Data {
    BorderCurve first, second;
    Interval across;
    Direction straight;
  };
  explicit RuledSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  std::shared_ptr<const Data> data_;
};

/// The reference evaluator, by the formula above. Errors: those of functions, non_finite (too large a point; (u, v)).
Result<SurfaceJet> evaluate_jet(const RuledSurface& surface, double u, double v);
/// Its position alone: one call of each function.
Result<Vec3> position(const RuledSurface& surface, double u, double v);

/// Exact for exact borders (FitError 0): made compatible; rational ones of different weight functions over the common
/// denominator, numerators (1 - t) N1 w2 + t N2 w1 over w1 w2, of degree p1 + p2. Otherwise a fit by `options`, broken
/// at inner knots of a border that is a curve. Errors: unsupported_degree (above max_degree), non_finite,
/// invalid_weight (products of weights below 1e-100 of their patch's largest), and those of a fit.
Result<PatchGrid> to_bezier(const RuledSurface& surface, const FitOptions& options = {});

}  // namespace tessera
#pragma GCC visibility pop
