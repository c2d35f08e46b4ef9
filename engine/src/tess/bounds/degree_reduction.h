#pragma once
// Polynomials of lower degrees that are near to others.

#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// The map from the Bernstein coefficients of polynomials to those of the nearest ones of a lower degree, and back.
/// Nearest by the sum of squared differences of coefficients, once the degree is raised again: that is nearest in the
/// L2 norm (Lutterkort, Peters and Reif, Polynomial degree reduction in the L2-norm equals best Euclidean approximation
/// of Bezier coefficients, CAGD 16, 1999).
class DegreeReduction {
 public:
  /// Requires 0 <= to <= from.
  DegreeReduction(int from, int to);

  int from() const { return from_; }
  int to() const { return to_; }

 private:
  friend class NetReduction;
  int from_, to_;
  std::vector<double> lower_, raise_;                ///< `[to + 1][from + 1]` and `[from + 1][to + 1]`
  std::vector<double> lower_across_, raise_across_;  ///< the transposes of these
};

/// Lowers the degrees of a net along both of its parameters.
class NetReduction {
 public:
  /// Both must outlive this object.
  NetReduction(const DegreeReduction& u, const DegreeReduction& v) : u_(u), v_(v) {}

  /// Writes the lower net of numbers `[u.from + 1][v.from + 1]`, `[u.to + 1][v.to + 1]` of them. Returns a bound on the
  /// differences of coefficients once the degrees are raised again, and thus on those of values: 2^-40 of the largest
  /// number, or more. `room`: for 2 (u.from + 1) (v.from + 1) numbers.
  double apply(const double* net, double* lower, double* room) const;

 private:
  const DegreeReduction &u_, &v_;
};

}}  // namespace tessera::abi_0_1
