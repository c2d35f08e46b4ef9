#pragma once
// What ruled surfaces and Coons patches ask of their borders.

#include "tessera/parametric_surface.h"

namespace tessera::inline abi_0_1 {

/// What messages call borders, in the order of CoonsBorders, and curves of ruled surfaces.
inline constexpr const char* coons_border_names[] = {"border C1", "border C2", "border D1", "border D2"};
inline constexpr const char* ruled_curve_names[] = {"the first curve", "the second curve"};

inline bool is_exact(const BorderCurve& border) { return std::holds_alternative<Curve>(border); }

/// derivative_bound() may be finite.
inline bool has_bounds(const BorderCurve& border) {
  const auto* function = std::get_if<ParametricCurve>(&border);
  return function == nullptr || function->has_bounds();
}
/// A bound of |d^k c / dt^k| over a part of the domain, k >= 0: of a function its own; of a polynomial curve the hull
/// of its derivative's control points; infinity for derivatives of rational curves and across knots where they jump.
double derivative_bound(const BorderCurve& border, const Interval& part, int k);

/// As position() and evaluate_jet(), with messages that say which border.
Result<Vec3> position(const BorderCurve& border, double t, const char* name);
Result<CurveJet> evaluate_jet(const BorderCurve& border, double t, const char* name);

/// Both on the same interval. Errors: invalid_argument (names both).
Status check_same_interval(const BorderCurve& a, const char* name_a, const BorderCurve& b, const char* name_b);

}  // namespace tessera::inline abi_0_1
