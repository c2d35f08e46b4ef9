#include "tessera/tensor_patch.h"

#include <array>
#include <cmath>
#include <string>

#include "basis/double_double.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check_degree(const char* direction, int degree) {
  if (degree >= 0 && degree <= max_degree) return {};
  return {StatusCode::unsupported_degree, std::string("the degree of the polynomial in ") + direction + " is " +
                                              std::to_string(degree) + ", it must be 0 to " +
                                              std::to_string(max_degree)};
}

Status check_coefficients(int degree_x, int degree_y, std::span<const double> coefficients) {
  const std::size_t row = static_cast<std::size_t>(degree_y) + 1, wanted = static_cast<std::size_t>(degree_x + 1) * row;
  if (coefficients.size() != wanted)
    return {StatusCode::count_mismatch, "a polynomial of these degrees has " + std::to_string(wanted) +
                                            " coefficients, found " + std::to_string(coefficients.size())};
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    if (!std::isfinite(coefficients[k]))
      return {StatusCode::non_finite,
              "coefficient [" + std::to_string(k / row) + "][" + std::to_string(k % row) +
                  "] of the polynomial is not finite",
              static_cast<std::ptrdiff_t>(k)};
  return {};
}

Status check_interval(const char* direction, double from, double to) {
  if (!std::isfinite(from) || !std::isfinite(to) || !std::isfinite(to - from))
    return {StatusCode::non_finite, std::string("the rectangle's range of ") + direction + " is not finite"};
  if (from < to) return {};
  return {StatusCode::invalid_argument, std::string("the rectangle's range of ") + direction + " from " +
                                            std::to_string(from) + " to " + std::to_string(to) +
                                            " is empty or reversed"};
}

/// The values p(t), p'(t) and p''(t)/2.
using Taylor = std::array<DoubleDouble, 3>;

/// Takes one step of Horner's scheme for value and derivatives, from p to p t + a, where a is itself a value.
void horner_step(Taylor& p, double t, const DoubleDouble& a) {
  p[2] = p[2] * t + p[1];
  p[1] = p[1] * t + p[0];
  p[0] = p[0] * t + a;
}

}  // namespace

ExplicitPolynomial::ExplicitPolynomial(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<ExplicitPolynomial> ExplicitPolynomial::make(int degree_x, int degree_y, std::span<const double> coefficients,
                                                    const Domain& rectangle) {
  return guarded([&]() -> Result<ExplicitPolynomial> {
    if (Status status = check_degree("x", degree_x); !status.ok()) return status;
    if (Status status = check_degree("y", degree_y); !status.ok()) return status;
    if (Status status = check_coefficients(degree_x, degree_y, coefficients); !status.ok()) return status;
    if (Status status = check_interval("x", rectangle.u0, rectangle.u1); !status.ok()) return status;
    if (Status status = check_interval("y", rectangle.v0, rectangle.v1); !status.ok()) return status;
    return ExplicitPolynomial({degree_x, degree_y, {coefficients.begin(), coefficients.end()}, rectangle});
  });
}

SurfaceJet evaluate_jet(const ExplicitPolynomial& surface, double u, double v) {
  // Row i is a polynomial in y; its value and y-derivatives are coefficients of x^i.
  std::array<Taylor, 3> along{};
  for (int i = surface.degree_x(); i >= 0; --i) {
    Taylor row{};
    for (int j = surface.degree_y(); j >= 0; --j) horner_step(row, v, {surface.coefficient(i, j), 0});
    for (std::size_t order = 0; order < 3; ++order) horner_step(along[order], u, row[order]);
  }
  const auto z = [&](std::size_t x_order, std::size_t y_order) { return along[y_order][x_order].rounded(); };
  return {{u, v, z(0, 0)}, {1, 0, z(1, 0)}, {0, 1, z(0, 1)}, {0, 0, 2 * z(2, 0)}, {0, 0, z(1, 1)}, {0, 0, 2 * z(0, 2)}};
}

}}  // namespace tessera::abi_0_1
