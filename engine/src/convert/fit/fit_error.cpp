#include "convert/fit/fit_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/safe_length.h"
#include "basis/chebyshev_lobatto.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns factor h^(n+1) bound, and 0 for a bound of 0. The bound is multiplied first, because powers of a short h
/// underflow.
double interpolation_error(int degree, double h, double bound) {
  if (bound == 0) return 0;
  double error = lobatto_error_factor(degree) * bound;
  for (int i = 0; i <= degree; ++i) error *= h;
  return std::max(error, std::numeric_limits<double>::min());
}

}  // namespace

Result<CellError> ProvenError::operator()(const Domain& cell) const {
  constexpr double longest_without = 1.0 / 64;
  const auto bounds = surface_.derivative_bounds(cell, degree_ + 1);
  const double u = interpolation_error(degree_, cell.u1 - cell.u0, bounds[0]);
  const double v = interpolation_error(degree_, cell.v1 - cell.v0, bounds[1]);
  const double total = u + v + (lobatto_lebesgue_constant(degree_) - 1) * std::min(u, v);
  if (total < infinity) return CellError{total, u, v};
  const Domain& domain = surface_.domain();
  const bool long_u = cell.u1 - cell.u0 > longest_without * (domain.u1 - domain.u0);
  const bool long_v = cell.v1 - cell.v0 > longest_without * (domain.v1 - domain.v0);
  if (!long_u && !long_v) return Status(StatusCode::unsupported, "there is no bound of the surface's derivatives");
  return CellError{infinity, long_u ? infinity : 0, long_v ? infinity : 0};
}

double ProvenError::rounding(const Domain& cell) const {
  // A node's parameter is a + t (b - a). The difference and the product each round by at most 2^-52 of the largest
  // parameter, since they may be twice as large as it; the sum rounds by 2^-53.
  const double u = 0x1p-50 * std::max(std::abs(cell.u0), std::abs(cell.u1));
  const double v = 0x1p-50 * std::max(std::abs(cell.v0), std::abs(cell.v1));
  const auto bounds = surface_.derivative_bounds(cell, 1);
  const double lebesgue = lobatto_lebesgue_constant(degree_);
  return lebesgue * lebesgue * ((bounds[0] == 0 ? 0 : u * bounds[0]) + (bounds[1] == 0 ? 0 : v * bounds[1]));
}

SampledError::SampledError(const ParametricSurface& surface, int degree)
    : surface_(surface), nodes_(static_cast<std::size_t>(degree) + 1) {
  // In a gap the error of a smooth function is like sin(pi part), with `part` measured in the angle of the nodes.
  const std::vector<double> nodes = lobatto_parameters(degree);
  for (std::size_t i = 0; i + 1 < nodes_; ++i) {
    parameters_.push_back(nodes[i]);
    for (const double part : {0.46, 0.79}) {
      const double sine = std::sin(std::numbers::pi / 2 * (static_cast<double>(i) + part) / degree);
      parameters_.push_back(sine * sine);
    }
  }
  parameters_.push_back(1);
  const Matrix basis = lobatto_evaluation(degree, parameters_);
  for (int a = 0; a < basis.rows(); ++a)
    for (int i = 0; i < basis.columns(); ++i) basis_.push_back(static_cast<double>(basis(a, i)));
  values_.resize(size() * size());
  along_u_.resize(size() * size());
}

Status SampledError::sample(const Domain& cell) {
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t b = 0; b < size(); ++b) {
      const auto point = surface_.position(lobatto_parameter(parameters_, a, cell.u0, cell.u1),
                                           lobatto_parameter(parameters_, b, cell.v0, cell.v1));
      if (!point) return point.status();
      values_[a * size() + b] = *point;
    }
  return {};
}

void SampledError::interpolate_along_u() {
  std::fill(along_u_.begin(), along_u_.end(), Vec3{});
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t i = 0; i < nodes_; ++i)
      for (std::size_t b = 0; b < size(); ++b) along_u_[a * size() + b] += basis_[a * nodes_ + i] * value(3 * i, b);
}

Result<CellError> SampledError::operator()(const Domain& cell) {
  if (Status status = sample(cell); !status.ok()) return status;
  interpolate_along_u();
  CellError error;
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t b = 0; b < size(); ++b) {
      Vec3 along_v, both;
      for (std::size_t j = 0; j < nodes_; ++j) {
        along_v += basis_[b * nodes_ + j] * value(a, 3 * j);
        both += basis_[b * nodes_ + j] * along_u_[a * size() + 3 * j];
      }
      error.along_u = std::max(error.along_u, safe_length(value(a, b) - along_u_[a * size() + b]));
      error.along_v = std::max(error.along_v, safe_length(value(a, b) - along_v));
      error.total = std::max(error.total, safe_length(value(a, b) - both));
    }
  return error;
}

}}  // namespace tessera::abi_0_1
