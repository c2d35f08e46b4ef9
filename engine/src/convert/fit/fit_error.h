#pragma once
// Error of tensor-product interpolation at Chebyshev-Lobatto parameters on a cell of a surface: proven by bounds of
// derivatives, or sampled.
//
// Iu and Iv are the interpolation in u and v, eu bounds |f - Iu f|, ev bounds |f - Iv f|, and L is the Lebesgue
// constant.
// 1. f - Iu Iv f = (f - Iu f) + Iu (f - Iv f), so |f - Iu Iv f| <= eu + L ev.
// 2. With u and v exchanged, |f - Iu Iv f| <= ev + L eu.
// 3. Together: |f - Iu Iv f| <= eu + ev + (L - 1) min(eu, ev).

#include <array>
#include <vector>

#include "convert/fit/tensor_refinement.h"
#include "tessera/parametric_surface.h"

namespace tessera { inline namespace abi_0_1 {

/// The proven error, by bounds of the derivatives of order n + 1. Without such a bound, the cell should be halved while
/// it is longer than a 64th of the domain; then the error is `unsupported`.
class ProvenError {
 public:
  ProvenError(const ParametricSurface& surface, int degree) : surface_(surface), degree_(degree) {}
  Result<CellError> operator()(const Domain& cell) const;
  /// Bounds what the rounding of the nodes' parameters adds, by bounds of the first derivatives.
  double rounding(const Domain& cell) const;

 private:
  const ParametricSurface& surface_;
  int degree_;
};

/// The error found at the (3 n + 1)^2 points of a grid: the nodes, and two parameters in each gap between them, one
/// near the largest error of a smooth function and one off it.
class SampledError {
 public:
  SampledError(const ParametricSurface& surface, int degree);
  Result<CellError> operator()(const Domain& cell);

 private:
  using Grid = std::vector<Vec3>;
  std::size_t size() const { return parameters_.size(); }
  Status sample(const Domain& cell);
  void interpolate_along_u();
  const Vec3& value(std::size_t a, std::size_t b) const { return values_[a * size() + b]; }

  const ParametricSurface& surface_;
  std::size_t nodes_;               // n + 1; node i is parameter 3 i
  std::vector<double> parameters_;  // in [0,1]
  std::vector<double> basis_;       // [parameter][node]: Lagrange's polynomials
  Grid values_, along_u_;           // f and Iu f, [a][b]
};

}}  // namespace tessera::abi_0_1
