#pragma once
// Curves that are functions of the caller's, and the two forms in which borders of ruled surfaces and Coons patches
// come.

#include <functional>
#include <memory>
#include <variant>

#include "tessera/curve.h"
#include "tessera/status.h"
#include "tessera/vec.h"

#pragma GCC visibility push(default)
namespace tessera {

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

}  // namespace tessera
#pragma GCC visibility pop
