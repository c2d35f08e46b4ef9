#pragma once
// Bounds on the second derivatives of rational patches and curves themselves, by exact numerators, lanes = patches, in
// double. No multiply-add is fused, so that every instruction set finds the same bounds.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/rational_nets.inl.h"

/// A polynomial in two parameters as Bernstein coefficients times their binomials, C(m,i) C(n,j) c_ij, `[i][j]`.
/// Products are then plain convolutions, degree elevation by one adds neighbours, and the factors cancel in quotients
/// of equal degrees.
template <class L>
struct ScaledNet {
  using Batch = typename L::Batch;
  static constexpr int order_limit = 3 * max_exact_degree + 1, capacity = order_limit * order_limit;

  int rows = 0, columns = 0;
  Batch at[capacity];

  int count() const { return rows * columns; }
};

/// Adds a b to `sum`, or with `Minus` subtracts it; `sum` has the shape of the product.
template <class L, bool Minus = false>
[[gnu::noinline]] void add_product(const ScaledNet<L>& a, const ScaledNet<L>& b, ScaledNet<L>& sum) {
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.columns; ++j) {
      const auto x = a.at[i * a.columns + j];
      for (int k = 0; k < b.rows; ++k)
        for (int l = 0; l < b.columns; ++l) {
          auto& to = sum.at[(i + k) * sum.columns + j + l];
          to = Minus ? to - x * b.at[k * b.columns + l] : to + x * b.at[k * b.columns + l];
        }
    }
}

/// Sets `sum` to zeros in the shape of a product.
template <class L>
void clear_for_product(const ScaledNet<L>& a, const ScaledNet<L>& b, ScaledNet<L>& sum) {
  sum.rows = a.rows + b.rows - 1;
  sum.columns = a.columns + b.columns - 1;
  for (int k = 0; k < sum.count(); ++k) sum.at[k] = L::broadcast(0);
}

/// Raises the degree in u, or in v, by one.
template <class L>
void elevate(ScaledNet<L>& net, bool along_u) {
  if (along_u) {
    for (int j = 0; j < net.columns; ++j) net.at[net.count() + j] = L::broadcast(0);
    ++net.rows;
    for (int k = net.count() - 1; k >= net.columns; --k) net.at[k] = net.at[k] + net.at[k - net.columns];
    return;
  }
  const int n = net.columns;
  for (int i = net.rows - 1; i >= 0; --i) {
    auto* const to = net.at + i * (n + 1);
    const auto* const from = net.at + i * n;
    to[n] = from[n - 1];
    for (int j = n - 1; j > 0; --j) to[j] = from[j] + from[j - 1];
    to[0] = from[0];
  }
  ++net.columns;
}

/// Splits p = (1 - t) low + t high into two polynomials of one degree less, where t is u or v.
template <class L>
void split(const ScaledNet<L>& p, bool along_u, ScaledNet<L>& low, ScaledNet<L>& high) {
  const int degree = (along_u ? p.rows : p.columns) - 1;
  low.rows = high.rows = along_u ? p.rows - 1 : p.rows;
  low.columns = high.columns = along_u ? p.columns : p.columns - 1;
  const int step = along_u ? p.columns : 1;
  for (int i = 0; i < low.rows; ++i)
    for (int j = 0; j < low.columns; ++j) {
      const int k = along_u ? i : j;
      const auto share = [&](int of) { return L::broadcast(static_cast<double>(of) / static_cast<double>(degree)); };
      const auto* const from = p.at + i * p.columns + j;
      low.at[i * low.columns + j] = share(degree - k) * from[0];
      high.at[i * low.columns + j] = share(k + 1) * from[step];
    }
}

/// A homogeneous net, `[i][j]`, in ScaledNets.
template <class L>
struct HomogeneousNet {
  ScaledNet<L> point[3], weight;
};

/// The largest second derivatives of S = P / w, w > 0, over all parameters. With P = (1 - u) P0 + u P1 and w likewise,
///   S_u = N / w^2, N = m (w0 P1 - w1 P0), of degree (2 m - 2, 2 n);
///   S_uu = N_uu / w^3, N_uu = (2 m - 2) (w0 N1 - w1 N0) - 2 (w1 - w0) N, of degree (3 m - 3, 3 n);
///   S_uv = N_uv / w^3, N_uv = 2 n (w0 N1 - w1 N0), rows along v, of degree (3 m - 2, 3 n - 2)
/// by the quotient rule; leading terms cancel before anything is multiplied. Raised to the degree of w^3, N / w^3 is a
/// rational Bezier form, and its points, coefficient over coefficient, bound it.
template <class L>
class ExactDerivatives {
 public:
  using Batch = typename L::Batch;
  using Net = ScaledNet<L>;

  /// Finds the largest |S_uu| and, if `with_uv`, |S_uv|, without the rounding.
  void find(const HomogeneousNet<L>& patch, bool with_uv) {
    const Net& w = patch.weight;
    const int m = w.rows - 1, n = w.columns - 1;
    uu = uv = L::broadcast(0);
    if (m == 0) return;
    split(w, true, low_, high_);
    slope_ = high_;
    for (int k = 0; k < slope_.count(); ++k) slope_.at[k] = slope_.at[k] - low_.at[k];
    clear_for_product(w, w, square_);
    add_product(w, w, square_);
    clear_for_product(square_, w, cube_);
    add_product(square_, w, cube_);
    for (int k = 0; k < cube_.count(); ++k) {
      cube_.at[k] = L::broadcast(1) / cube_.at[k];
      squared_[0][k] = squared_[1][k] = L::broadcast(0);
    }
    for (const Net& point : patch.point) {
      split(point, true, point_low_, point_high_);
      clear_for_product(low_, point_high_, first_);
      add_product(low_, point_high_, first_);
      add_product<L, true>(high_, point_low_, first_);
      for (int k = 0; k < first_.count(); ++k) first_.at[k] = L::broadcast(m) * first_.at[k];
      add_uu(m);
      if (with_uv && n > 0) add_uv(w, n);
    }
    uu = largest(squared_[0]);
    if (with_uv && n > 0) uv = largest(squared_[1]);
  }

  Batch uu, uv;

 private:
  void add_uu(int m) {
    clear_for_product(slope_, first_, second_);
    if (m > 1) {
      split(first_, true, point_low_, point_high_);
      clear_for_product(low_, point_high_, sum_);
      add_product(low_, point_high_, sum_);
      add_product<L, true>(high_, point_low_, sum_);
      elevate(sum_, true);
      for (int k = 0; k < second_.count(); ++k) second_.at[k] = L::broadcast(m - 1) * sum_.at[k];
    }
    add_product<L, true>(slope_, first_, second_);
    for (int times = 0; times < 3; ++times) elevate(second_, true);
    add_squares(L::broadcast(2), squared_[0]);
  }
  void add_uv(const Net& w, int n) {
    split(first_, false, point_low_, point_high_);
    split(w, false, weight_low_, weight_high_);
    clear_for_product(weight_low_, point_high_, second_);
    add_product(weight_low_, point_high_, second_);
    add_product<L, true>(weight_high_, point_low_, second_);
    for (int times = 0; times < 2; ++times) {
      elevate(second_, true);
      elevate(second_, false);
    }
    add_squares(L::broadcast(2 * n), squared_[1]);
  }
  void add_squares(const Batch& factor, Batch* squares) const {
    for (int k = 0; k < second_.count(); ++k) {
      const Batch x = factor * second_.at[k] * cube_.at[k];
      squares[k] = squares[k] + x * x;
    }
  }
  Batch largest(const Batch* squares) const {
    Batch most = L::broadcast(0);
    for (int k = 0; k < cube_.count(); ++k) most = xsimd::max(most, squares[k]);
    return xsimd::sqrt(most);
  }

  Net low_, high_, slope_, square_, cube_, point_low_, point_high_, weight_low_, weight_high_, first_, second_, sum_;
  Batch squared_[2][Net::capacity];
};

inline double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

/// A rational curve in homogeneous numbers.
template <class L>
struct HomogeneousCurve {
  typename L::Batch point[3][max_order], weight[max_order];
};

/// Returns the largest second derivative of a curve, without the rounding: ExactDerivatives in one parameter. `Degree`
/// is 0 for any degree.
template <class L, int Degree>
typename L::Batch largest_second_derivative(const HomogeneousCurve<L>& curve, int degree) {
  using Batch = typename L::Batch;
  constexpr int most = Degree > 0 ? Degree : max_order - 1;
  const int n = Degree > 0 ? Degree : degree;
  double share[most + 1], first_share[2 * most - 1];
  Batch low[most], high[most], slope[most], square[2 * most + 1], cube[3 * most + 1], squares[3 * most + 1];
  for (int i = 0; i <= n; ++i) share[i] = binomial(n, i);
  for (int i = 0; i <= 2 * n - 2; ++i) first_share[i] = 2 * n > 2 ? double(i) / (2 * n - 2) : 0;
  const auto scaled = [&](const Batch* from, int i) { return L::broadcast(share[i]) * from[i]; };
  const auto lower = [&](const Batch* from, int i) { return L::broadcast(double(n - i) / n) * scaled(from, i); };
  const auto upper = [&](const Batch* from, int i) { return L::broadcast(double(i + 1) / n) * scaled(from, i + 1); };
  for (int i = 0; i <= 2 * n; ++i) square[i] = L::broadcast(0);
  for (int i = 0; i <= 3 * n; ++i) cube[i] = squares[i] = L::broadcast(0);
  for (int i = 0; i < n; ++i) {
    low[i] = lower(curve.weight, i);
    high[i] = upper(curve.weight, i);
    slope[i] = high[i] - low[i];
  }
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) square[i + j] = square[i + j] + scaled(curve.weight, i) * scaled(curve.weight, j);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= 2 * n; ++j) cube[i + j] = cube[i + j] + scaled(curve.weight, i) * square[j];
  for (const auto& point : curve.point) {
    Batch first[2 * most - 1], bend[3 * most + 1];
    for (int i = 0; i <= 2 * n - 2; ++i) first[i] = L::broadcast(0);
    for (int i = 0; i <= 3 * n; ++i) bend[i] = L::broadcast(0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) first[i + j] = first[i + j] + (low[i] * upper(point, j) - high[i] * lower(point, j));
    for (int j = 0; j <= 2 * n - 2; ++j) first[j] = L::broadcast(n) * first[j];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2 * n - 2; ++j)
        bend[i + j] = bend[i + j] + (low[i] * (L::broadcast(first_share[j + 1]) * first[j + 1]) -
                                     high[i] * (L::broadcast(1 - first_share[j]) * first[j]));
    for (int i = 3 * n - 3; i >= 0; --i) bend[i] = L::broadcast(n - 1) * (i > 0 ? bend[i] + bend[i - 1] : bend[i]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= 2 * n - 2; ++j) bend[i + j] = bend[i + j] - slope[i] * first[j];
    for (int times = 0; times < 3; ++times)
      for (int i = 3 * n - 2 + times; i > 0; --i) bend[i] = bend[i] + bend[i - 1];
    for (int i = 0; i <= 3 * n; ++i) squares[i] = squares[i] + bend[i] * bend[i];
  }
  Batch largest = L::broadcast(0);
  for (int i = 0; i <= 3 * n; ++i) largest = xsimd::max(largest, squares[i] / (cube[i] * cube[i]));
  return L::broadcast(2) * xsimd::sqrt(largest);
}
template <class L>
typename L::Batch largest_second_derivative(const HomogeneousCurve<L>& curve, int degree) {
  if (degree == 2) return largest_second_derivative<L, 2>(curve, 2);
  if (degree == 3) return largest_second_derivative<L, 3>(curve, 3);
  return largest_second_derivative<L, 0>(curve, degree);
}
