#include <cmath>
#include <string>

#include "base/text.h"
#include "basis/bernstein.h"
#include "basis/small_matrix.h"
#include "surface/net/validate.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/tensor_patch.h"

// A basis holds three matrices: M itself, C = M_B^{-1} M, and C^{-1}. Each named basis has closed forms of all three,
// with entries that are whole numbers or right to the last bit. Only the user's own matrices are inverted.

namespace tessera { inline namespace abi_0_1 {
namespace {

using Entries = std::vector<double>;

/// Returns value(k, i) for each entry, row by row.
template <class Value>
Entries entries_of(int degree, Value&& value) {
  Entries entries;
  for (int k = 0; k <= degree; ++k)
    for (int i = 0; i <= degree; ++i) entries.push_back(value(k, i));
  return entries;
}

Entries identity(int degree) {
  return entries_of(degree, [](int k, int i) { return k == i ? 1.0 : 0.0; });
}

/// Returns M_B: B_{i,n} = sum_k (-1)^(k-i) C(n,k) C(k,i) t^k (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 5.8).
Entries power_of_bernstein(int n) {
  return entries_of(n, [n](int k, int i) { return ((k - i) % 2 == 0 ? 1 : -1) * binomial(n, k) * binomial(k, i); });
}

/// Returns M_B^{-1}: t^i = sum_k C(k,i) / C(n,i) B_{k,n} (Farin, sec. 5.8).
Entries bernstein_of_power(int n) {
  return entries_of(n, [n](int k, int i) { return binomial(k, i) / binomial(n, i); });
}

/// Returns n! times the blending functions of one uniform B-spline span, one function per row. They grow from degree 0
/// by the recurrence n N_i^n(t) = (t + n - i) N_{i-1}^{n-1}(t) + (1 + i - t) N_i^{n-1}(t) (de Boor, A Practical Guide
/// to Splines, ch. X). `step(function, at_0, at_1, target)` adds to target the product of a function and the linear
/// factor with these values at 0 and 1.
template <class Step>
std::vector<std::vector<long double>> uniform_functions(int degree, Step&& step) {
  std::vector<std::vector<long double>> functions{{1}};
  for (int n = 1; n <= degree; ++n) {
    const std::size_t size = static_cast<std::size_t>(n) + 1;
    std::vector<std::vector<long double>> next(size, std::vector<long double>(size, 0));
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      if (i > 0) step(functions[k - 1], n - i, n - i + 1, next[k]);
      if (i < n) step(functions[k], 1 + i, i, next[k]);
    }
    functions = std::move(next);
  }
  return functions;
}

Entries over_factorial(int degree, const std::vector<std::vector<long double>>& functions) {
  long double factorial = 1;
  for (int k = 2; k <= degree; ++k) factorial *= k;
  return entries_of(degree, [&](int k, int i) {
    return static_cast<double>(functions[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] / factorial);
  });
}

/// Computes with whole numbers below 2^53 until the one division by n!.
Entries power_of_uniform(int degree) {
  const auto step = [](const std::vector<long double>& function, int at_0, int at_1, std::vector<long double>& target) {
    for (std::size_t k = 0; k < function.size(); ++k) {
      target[k] += at_0 * function[k];
      target[k + 1] += (at_1 - at_0) * function[k];
    }
  };
  return over_factorial(degree, uniform_functions(degree, step));
}

/// All factors are positive, so nothing cancels.
Entries bernstein_of_uniform(int degree) {
  const auto step = [](const std::vector<long double>& function, int at_0, int at_1, std::vector<long double>& target) {
    const int n = static_cast<int>(function.size());
    for (int k = 0; k < n; ++k) {
      const std::size_t i = static_cast<std::size_t>(k);
      target[i] += static_cast<long double>((n - k) * at_0) / n * function[i];
      target[i + 1] += static_cast<long double>((k + 1) * at_1) / n * function[i];
    }
  };
  return over_factorial(degree, uniform_functions(degree, step));
}

/// De Boor point i is the blossom at the knots i-n+1 .. i (Farin, ch. 8). Its coefficient of Bezier point k is the
/// coefficient of x^k in the product of (1 - t + t x) over these knots: whole numbers below 2^53 up to degree 15.
Entries uniform_of_bernstein(int degree) {
  Entries entries;
  for (int i = 0; i <= degree; ++i) {
    Entries product(static_cast<std::size_t>(degree) + 1, 0.0);
    product[0] = 1;
    for (int t = i - degree + 1; t <= i; ++t)
      for (std::size_t k = product.size(); k-- > 0;)
        product[k] = (1 - t) * product[k] + (k > 0 ? t * product[k - 1] : 0);
    entries.insert(entries.end(), product.begin(), product.end());
  }
  return entries;
}

/// Returns the rounded inverse of C, or nothing for a singular one.
Entries inverse_entries(int degree, const Entries& bernstein) {
  Matrix matrix(degree + 1, degree + 1);
  for (int k = 0; k <= degree; ++k)
    for (int i = 0; i <= degree; ++i) matrix(k, i) = bernstein[static_cast<std::size_t>(k * (degree + 1) + i)];
  const auto inverted = inverse(matrix);
  if (!inverted) return {};
  Entries entries = entries_of(degree, [&](int i, int k) { return static_cast<double>((*inverted)(i, k)); });
  for (const double entry : entries)
    if (!std::isfinite(entry)) return {};
  return entries;
}

Status check_entries(int degree, std::span<const double> entries) {
  const std::size_t size = static_cast<std::size_t>(degree) + 1;
  if (entries.size() != size * size)
    return {StatusCode::count_mismatch, "a basis matrix of degree " + std::to_string(degree) + " has " +
                                            std::to_string(size) + " x " + std::to_string(size) + " entries, found " +
                                            std::to_string(entries.size())};
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (!std::isfinite(entries[k]))
      return {StatusCode::non_finite,
              "entry " + place_in_rows(k, size) + " of the basis matrix is " + text(entries[k]) + ", it must be finite",
              static_cast<std::ptrdiff_t>(k)};
  return {};
}

}  // namespace

BasisMatrix::BasisMatrix(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

bool BasisMatrix::operator==(const BasisMatrix& other) const { return data_ == other.data_ || *data_ == *other.data_; }

Result<BasisMatrix> BasisMatrix::bezier(int degree) {
  return guarded([&]() -> Result<BasisMatrix> {
    if (Status status = check_degree(degree, "degree of a basis matrix"); !status.ok()) return status;
    Data basis;
    basis.degree = degree;
    basis.power = power_of_bernstein(degree);
    basis.bernstein = basis.from_bernstein = identity(degree);
    return BasisMatrix(std::move(basis));
  });
}

Result<BasisMatrix> BasisMatrix::power(int degree) {
  return guarded([&]() -> Result<BasisMatrix> {
    if (Status status = check_degree(degree, "degree of a basis matrix"); !status.ok()) return status;
    Data basis;
    basis.degree = degree;
    basis.power = identity(degree);
    basis.bernstein = bernstein_of_power(degree);
    basis.from_bernstein = power_of_bernstein(degree);
    return BasisMatrix(std::move(basis));
  });
}

Result<BasisMatrix> BasisMatrix::hermite() {
  return guarded([]() -> Result<BasisMatrix> {
    constexpr double third = 1.0 / 3;
    Data basis;
    basis.degree = 3;
    basis.power = {1, 0, 0, 0, 0, 1, 0, 0, -3, -2, -1, 3, 2, 1, 1, -2};
    basis.bernstein = {1, 0, 0, 0, 1, third, 0, 0, 0, 0, -third, 1, 0, 0, 0, 1};
    basis.from_bernstein = {1, 0, 0, 0, -3, 3, 0, 0, 0, 0, -3, 3, 0, 0, 0, 1};
    return BasisMatrix(std::move(basis));
  });
}

Result<BasisMatrix> BasisMatrix::uniform_b_spline(int degree) {
  return guarded([&]() -> Result<BasisMatrix> {
    if (Status status = check_degree(degree, "degree of a basis matrix"); !status.ok()) return status;
    Data basis;
    basis.degree = degree;
    basis.power = power_of_uniform(degree);
    basis.bernstein = bernstein_of_uniform(degree);
    basis.from_bernstein = uniform_of_bernstein(degree);
    return BasisMatrix(std::move(basis));
  });
}

Result<BasisMatrix> BasisMatrix::catmull_rom() {
  return guarded([]() -> Result<BasisMatrix> {
    constexpr double sixth = 1.0 / 6;
    Data basis;
    basis.degree = 3;
    basis.power = {0, 1, 0, 0, -0.5, 0, 0.5, 0, 1, -2.5, 2, -0.5, -0.5, 1.5, -1.5, 0.5};
    basis.bernstein = {0, 1, 0, 0, -sixth, 1, sixth, 0, 0, sixth, 1, -sixth, 0, 0, 1, 0};
    basis.from_bernstein = {6, -6, 0, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0, -6, 6};
    return BasisMatrix(std::move(basis));
  });
}

Result<BasisMatrix> BasisMatrix::custom(int degree, std::span<const double> entries) {
  return guarded([&]() -> Result<BasisMatrix> {
    if (Status status = check_degree(degree, "degree of a basis matrix"); !status.ok()) return status;
    if (Status status = check_entries(degree, entries); !status.ok()) return status;
    Data basis;
    basis.degree = degree;
    basis.power.assign(entries.begin(), entries.end());
    basis.bernstein = entries_of(degree, [&](int k, int i) {
      long double sum = 0;
      for (int l = 0; l <= k; ++l)
        sum += static_cast<long double>(binomial(k, l)) / binomial(degree, l) *
               entries[static_cast<std::size_t>(l * (degree + 1) + i)];
      return static_cast<double>(sum);
    });
    for (const double value : basis.bernstein)
      if (!std::isfinite(value)) return Status(StatusCode::non_finite, "the entries of the basis matrix are too large");
    basis.from_bernstein = inverse_entries(degree, basis.bernstein);
    return BasisMatrix(std::move(basis));
  });
}

}}  // namespace tessera::abi_0_1
