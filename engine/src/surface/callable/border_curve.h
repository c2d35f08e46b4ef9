#pragma once
// Access to the borders of ruled surfaces and Coons patches: names, derivative bounds, evaluation and checks.

#include "tessera/parametric_surface.h"

namespace tessera { inline namespace abi_0_1 {

/// Names in messages: borders in the order of CoonsBorders, and the curves of ruled surfaces.
inline constexpr const char* coons_border_names[] = {"border C1", "border C2", "border D1", "border D2"};
inline constexpr const char* ruled_curve_names[] = {"the first curve", "the second curve"};

inline bool is_exact(const BorderCurve& border) { return std::holds_alternative<Curve>(border); }

/// Returns true if derivative_bound() may be finite.
inline bool has_bounds(const BorderCurve& border) {
  const auto* function = std::get_if<ParametricCurve>(&border);
  return function == nullptr || function->has_bounds();
}
/// Bounds |d^k c / dt^k| over a part of the domain, k >= 0:
/// - function: its own bound;
/// - polynomial curve: the hull of its derivative's control points, or infinity across knots where the derivative
///   jumps;
/// - rational curve: infinity for derivatives.
double derivative_bound(const BorderCurve& border, const Interval& part, int k);

/// Evaluate like position() and evaluate_jet(), with messages that name the border.
Result<Vec3> position(const BorderCurve& border, double t, const char* name);
Result<CurveJet> evaluate_jet(const BorderCurve& border, double t, const char* name);

/// Checks that both are on the same interval. Errors: invalid_argument (names both).
Status check_same_interval(const BorderCurve& a, const char* name_a, const BorderCurve& b, const char* name_b);

}}  // namespace tessera::abi_0_1
