#include "ray/net/cubic_net.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t most = max_degree + 1;
constexpr double reach = kernel::RayLeaf::reach;

using Cubic = std::array<double, 4>;

/// Returns B_{i,n}(1/2 + x) as coefficients of x^k, `[i][k]`, by B_{i,n} = (1/2 - x) B_{i,n-1} + (1/2 + x) B_{i-1,n-1}.
std::array<Cubic, 4> centred_powers(int degree) {
  std::array<Cubic, 4> row{};
  row[0][0] = 1;
  for (int n = 1; n <= degree; ++n) {
    std::array<Cubic, 4> next{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
        next[i][k] += 0.5 * row[i][k], next[i + 1][k] += 0.5 * row[i][k];
        next[i][k + 1] -= row[i][k], next[i + 1][k + 1] += row[i][k];
      }
    }
    row = next;
  }
  return row;
}

/// The Chebyshev series of the Bernstein polynomials of one degree: coefficients of T_k(x / reach) in B_i(1/2 + x).
struct Series {
  std::array<std::array<double, most>, most> of{};  ///< [i][k]
  double sizes = 0;                                 ///< the sum of magnitudes
};

/// Uses the same recursion, with t T_k = (T_{k+1} + T_{|k-1|}) / 2. Its terms are up to 1e4 times as large as their
/// sums, so it needs more digits than double has.
Series series(int degree) {
  using Rows = std::array<std::array<long double, most>, most>;
  Rows row{};
  row[0][0] = 1;
  for (int n = 1; n <= degree; ++n) {
    Rows next{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
        const long double half = row[i][k] / 2, by_t = static_cast<long double>(reach) * half;
        const std::size_t below = k == 0 ? 1 : k - 1;
        next[i][k] += half, next[i + 1][k] += half;
        next[i][k + 1] -= by_t, next[i + 1][k + 1] += by_t;
        next[i][below] -= by_t, next[i + 1][below] += by_t;
      }
    }
    row = next;
  }
  Series out;
  for (std::size_t i = 0; i < most; ++i) {
    for (std::size_t k = 0; k < most; ++k) {
      out.of[i][k] = static_cast<double>(row[i][k]);
      out.sizes += std::abs(out.of[i][k]);
    }
  }
  return out;
}

const Series& series_of(int degree) {
  static const std::array<Series, most> all = [] {
    std::array<Series, most> made;
    for (std::size_t k = 0; k < most; ++k) made[k] = series(static_cast<int>(k));
    return made;
  }();
  return all[static_cast<std::size_t>(degree)];
}

/// Adds sum_ij net[i][j] by_u[i][a] by_v[j][b] to out[a][b], for the first `rows` x `columns` of [a][b].
template <class ByU, class ByV, class Out>
void transform(const NetShape<0, 0>& shape, const double* net, const ByU& by_u, const ByV& by_v, std::size_t rows,
               std::size_t columns, Out& out) {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(shape.m()); ++i) {
    std::array<double, most> row{};
    for (std::size_t j = 0; j <= static_cast<std::size_t>(shape.n()); ++j, ++net) {
      for (std::size_t b = 0; b < columns; ++b) row[b] += *net * by_v[j][b];
    }
    for (std::size_t a = 0; a < rows; ++a) {
      for (std::size_t b = 0; b < columns; ++b) out[a][b] += by_u[i][a] * row[b];
    }
  }
}

/// The polynomials T_0 to T_3 in powers of x, `[k][power]`.
constexpr std::array<Cubic, 4> chebyshev = [] {
  constexpr double r = 1 / reach;
  return std::array<Cubic, 4>{{{1, 0, 0, 0}, {0, r, 0, 0}, {-1, 0, 2 * r * r, 0}, {0, -3 * r, 0, 4 * r * r * r}}};
}();

CubicNet economised(const NetShape<0, 0>& shape, const FourNets& net) {
  const Series &by_u = series_of(shape.m()), &by_v = series_of(shape.n());
  CubicNet out;
  for (std::size_t c = 0; c < 4; ++c) {
    std::array<std::array<double, most>, most> terms{};
    transform(shape, net[c].data(), by_u.of, by_v.of, most, most, terms);
    double value = 0, slope_u = 0, slope_v = 0;
    for (std::size_t a = 0; a < most; ++a) {
      for (std::size_t b = a < 4 ? 4 : 0; b < most; ++b) {
        const double size = std::abs(terms[a][b]);
        value += size, slope_u += static_cast<double>(a * a) * size, slope_v += static_cast<double>(b * b) * size;
      }
    }
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        for (std::size_t i = 0; i <= a; ++i) {
          for (std::size_t j = 0; j <= b; ++j) out.power[c][i][j] += terms[a][b] * chebyshev[a][i] * chebyshev[b][j];
        }
      }
    }
    // Terms are sums of products, fewer than 64 roundings each; those of the series are in `sizes`, at most 2^15.
    double largest = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(shape.size()); ++k)
      largest = std::max(largest, std::abs(net[c][k]));
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * largest * by_u.sizes * by_v.sizes;
    out.value_error[c] = value + rounding;
    out.slope_error[c] = (std::max(slope_u, slope_v) + most * most * rounding) / reach;
  }
  return out;
}

}  // namespace

CubicNet cubic_net(const NetShape<0, 0>& shape, const FourNets& net) {
  if (shape.m() > 3 || shape.n() > 3) return economised(shape, net);
  const auto by_u = centred_powers(shape.m()), by_v = centred_powers(shape.n());
  CubicNet out;
  for (std::size_t c = 0; c < 4; ++c) transform(shape, net[c].data(), by_u, by_v, 4, 4, out.power[c]);
  return out;
}

}}  // namespace tessera::abi_0_1
