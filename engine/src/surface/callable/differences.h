#pragma once
// Derivatives of a function of which only values are known, by finite differences.

#include <algorithm>
#include <array>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {

/// Seven parameters around t that stay within an interval, and the weights of the values there in the first and second
/// derivative at t. The weights are those of the sextic through the values (Fornberg, Generation of finite difference
/// formulas on arbitrarily spaced grids, 1988), with a step h of 2^-8 of the interval's length L. They sum to zero, so
/// derivative() takes values relative to the one at t, and constants have derivative 0. With F a bound of |f| near t
/// and F_k a bound of its k-th derivative:
///   |error of f'| <= h^6 F_7 / 140 + 2^-42 F / L,  |error of f''| <= h^6 F_8 / 560 + 2^-33 F / L^2;
/// next to the ends, where t is not the middle parameter,
///   |error of f'| <= h^6 F_7 / 7 + 2^-39 F / L,    |error of f''| <= 0.7 h^5 F_7 + 2^-29 F / L^2.
struct DifferenceStencil {
  static constexpr std::size_t size = 7;
  std::array<double, size> at, first, second;

  DifferenceStencil(double t, double from, double to) {
    const double step = 0x1p-8 * (to - from);
    const double start = std::clamp(t - 3 * step, from, to - 6 * step);
    std::array<double, size> offset;  // in steps from t, from the rounded parameters
    for (std::size_t k = 0; k < size; ++k) {
      at[k] = std::min(start + static_cast<double>(k) * step, to);
      offset[k] = (at[k] - t) / step;
    }
    for (std::size_t k = 0; k < size; ++k) set_weights(k, offset, step);
  }

  /// Returns sum_k weights[k] (values[k] - value), where `value` is the one at t; T is double or Vec3.
  template <class T>
  static T derivative(const std::array<double, size>& weights, const std::array<T, size>& values, const T& value) {
    T sum{};
    for (std::size_t k = 0; k < size; ++k) sum = sum + weights[k] * (values[k] - value);
    return sum;
  }

 private:
  /// Sets weight k from the coefficients of x and x^2 of its Lagrange polynomial prod_{j != k} (x - x_j) / (x_k - x_j).
  void set_weights(std::size_t k, const std::array<double, size>& offset, double step) {
    std::array<double, 3> c{1, 0, 0};
    double denominator = 1;
    for (std::size_t j = 0; j < size; ++j) {
      if (j == k) continue;
      c = {-offset[j] * c[0], c[0] - offset[j] * c[1], c[1] - offset[j] * c[2]};
      denominator *= offset[k] - offset[j];
    }
    first[k] = c[1] / denominator / step;
    second[k] = 2 * c[2] / denominator / step / step;
  }
};

}}  // namespace tessera::abi_0_1
