#pragma once
// Knot vectors and the B-spline basis on them (de Boor, A Practical Guide to Splines; Piegl and Tiller, The NURBS
// Book, 2nd ed., ch. 2).

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// One direction of a spline: the knots u_0 .. u_{m+p+1} for degree p and points 0 .. m, and the parameter interval in
/// use, [from, to] within [u_p, u_{m+1}]. A view: it does not own the knots, which have passed check_knots.
struct KnotLine {
  int degree = 0;
  std::span<const double> knots;
  double from = 0, to = 1;

  std::size_t order() const { return static_cast<std::size_t>(degree) + 1; }
  std::size_t point_count() const { return knots.size() - order(); }
};

/// Checks the knots of a spline of degree >= 1. They must be:
/// - at least 2 (degree + 1), finite and non-decreasing, with u_p < u_{m+1};
/// - repeated at most `degree` times within the domain and at most degree + 1 times elsewhere.
///
/// `name` is what messages call them ("knots u"). Errors: count_mismatch, non_finite, invalid_argument (index = the
/// knot).
Status check_knots(int degree, std::span<const double> knots, std::string_view name);
/// Checks that [from, to] lies within [u_p, u_{m+1}] and from < to. Errors: non_finite, invalid_argument.
Status check_range(int degree, std::span<const double> knots, double from, double to, std::string_view name);

/// Returns how many knots equal t.
std::size_t multiplicity(std::span<const double> knots, double t);

/// Returns the k with u_k <= t < u_{k+1}. At a knot this is the span on its right; at the end of the interval, the last
/// span that it meets. For t outside the interval it is the first or the last span. The span is not empty; points k-p
/// .. k act on it.
std::size_t find_span(const KnotLine& line, double t);
/// Returns the spans that the interval meets in more than a point, in order.
std::vector<std::size_t> distinct_spans(const KnotLine& line);

/// Computes the weights c of the blossom on one span: f(t_1, .., t_p) = sum_j c_j P_{span-p+j}, where f is the
/// symmetric multiaffine form with f(t, .., t) = the curve (Ramshaw, Blossoming, 1987; Farin, Curves and Surfaces for
/// CAGD, 5th ed., sec. 8.6). Any order of the arguments gives the same blossom. Steps with an argument within the span
/// are convex; arguments outside of it do the least harm in the last steps. `arguments` holds `degree` values,
/// `weights` degree + 1. Real is double or long double.
template <class Real>
void blossom_weights(int degree, std::span<const double> knots, std::size_t span, const Real* arguments, Real* weights);

}}  // namespace tessera::abi_0_1
