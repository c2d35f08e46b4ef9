#pragma once
// Graphs z = sum a_ij x^i y^j over a rectangle. The conversion needs tessera/convert.h as well.

#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"

namespace tessera {

class PatchGrid;

/// (x, y, sum a_ij x^i y^j) with x = u and y = v over a rectangle. Immutable but for assignment.
class ExplicitPolynomial {
 public:
  /// `coefficients`: a_ij is coefficients[i * (degree_y + 1) + j]; degrees 0 to max_degree; the rectangle finite, with
  /// u0 < u1 and v0 < v1. Errors: unsupported_degree, count_mismatch, non_finite (index = the coefficient),
  /// invalid_argument.
  static Result<ExplicitPolynomial> make(int degree_x, int degree_y, std::span<const double> coefficients,
                                         const Domain& rectangle);

  int degree_x() const { return degree_x_; }
  int degree_y() const { return degree_y_; }
  const Domain& rectangle() const { return rectangle_; }
  double coefficient(int i, int j) const { return coefficients_[static_cast<std::size_t>(i * (degree_y_ + 1) + j)]; }

 private:
  ExplicitPolynomial() = default;
  int degree_x_ = 0, degree_y_ = 0;
  std::vector<double> coefficients_;
  Domain rectangle_;
};

/// Position and derivatives at x = u, y = v, inside the rectangle or not: the reference evaluator. Sums carry 106 bits,
/// so that powers that cancel far from zero cost nothing as long as they are below 2^50 times the result.
SurfaceJet evaluate_jet(const ExplicitPolynomial& surface, double u, double v);

/// One polynomial patch of the same degrees (1 where the degree is 0), exact: control heights are the polar forms of
/// the polynomial at the rectangle's ends, summed with 106 bits. Error: non_finite where a height is out of the range
/// of doubles.
Result<PatchGrid> to_bezier(const ExplicitPolynomial& surface);

}  // namespace tessera
