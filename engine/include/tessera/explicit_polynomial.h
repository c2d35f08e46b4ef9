#pragma once
// Graphs z = sum a_ij x^i y^j over a rectangle. The conversion needs tessera/convert.h as well.

#include <memory>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera {

class PatchGrid;

/// (x, y, sum a_ij x^i y^j) with x = u and y = v over a rectangle. Immutable but for assignment; copies share
/// everything.
class ExplicitPolynomial {
 public:
  /// `coefficients`: a_ij is coefficients[i * (degree_y + 1) + j]; degrees 0 to max_degree; the rectangle finite, with
  /// u0 < u1 and v0 < v1. Errors: unsupported_degree, count_mismatch, non_finite (index = the coefficient),
  /// invalid_argument.
  static Result<ExplicitPolynomial> make(int degree_x, int degree_y, std::span<const double> coefficients,
                                         const Domain& rectangle);

  int degree_x() const { return data_->degree_x; }              ///< of x
  int degree_y() const { return data_->degree_y; }              ///< of y
  const Domain& rectangle() const { return data_->rectangle; }  ///< of x and y
  /// Of x^i y^j.
  double coefficient(int i, int j) const {
    return data_->coefficients[static_cast<std::size_t>(i * (degree_y() + 1) + j)];
  }

 private:
  struct Data {
    int degree_x, degree_y;
    std::vector<double> coefficients;
    Domain rectangle;
  };
  explicit ExplicitPolynomial(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  std::shared_ptr<const Data> data_;
};

/// Position and derivatives at x = u, y = v, inside the rectangle or not: the reference evaluator. Sums carry 106 bits,
/// so that powers that cancel far from zero cost nothing as long as they are below 2^50 times the result.
SurfaceJet evaluate_jet(const ExplicitPolynomial& surface, double u, double v);

/// One polynomial patch of the same degrees (1 where the degree is 0), exact: control heights are the polar forms of
/// the polynomial at the rectangle's ends, summed with 106 bits. Error: non_finite where a height is out of the range
/// of doubles.
Result<PatchGrid> to_bezier(const ExplicitPolynomial& surface);

}  // namespace tessera
#pragma GCC visibility pop
