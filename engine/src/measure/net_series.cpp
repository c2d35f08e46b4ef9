// Bounds of a patch at complex parameters, from its power coefficients about the middle.

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/local_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Power coefficients about the middle, [i][j], by x and y in [-1, 1].
template <class T>
std::vector<T> centred(const std::vector<T>& values, int m, int n) {
  const std::size_t rows = count_of(m), columns = count_of(n);
  const PowerMatrix &along_u = centred_power(m), &along_v = centred_power(n);
  std::vector<T> half(values.size(), T{}), all(values.size(), T{});
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) half[k * columns + j] += along_u[k][i] * values[i * columns + j];
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < columns; ++k)
      for (std::size_t j = 0; j < columns; ++j) all[i * columns + k] += along_v[k][j] * half[i * columns + j];
  return all;
}

/// A polynomial of degrees m and n by its coefficients [i][j].
template <class T>
struct Series {
  int m, n;
  std::vector<T> values;

  Series(int of_m, int of_n) : m(of_m), n(of_n), values(count_of(of_m) * count_of(of_n), T{}) {}
  T& at(int i, int j) { return values[static_cast<std::size_t>(i) * count_of(n) + static_cast<std::size_t>(j)]; }
  const T& at(int i, int j) const {
    return values[static_cast<std::size_t>(i) * count_of(n) + static_cast<std::size_t>(j)];
  }
  Series by_x() const {
    Series result(std::max(m - 1, 0), n);
    for (int i = 1; i <= m; ++i)
      for (int j = 0; j <= n; ++j) result.at(i - 1, j) = double(i) * at(i, j);
    return result;
  }
  Series by_y() const {
    Series result(m, std::max(n - 1, 0));
    for (int i = 0; i <= m; ++i)
      for (int j = 1; j <= n; ++j) result.at(i, j - 1) = double(j) * at(i, j);
    return result;
  }
};

/// Adds factor * a b to a polynomial whose degrees suffice.
template <class A, class B, class Times>
void add_product(Series<Vec3>& sum, double factor, const Series<A>& a, const Series<B>& b, Times times) {
  for (int i = 0; i <= a.m; ++i)
    for (int j = 0; j <= a.n; ++j)
      for (int k = 0; k <= b.m; ++k)
        for (int l = 0; l <= b.n; ++l) sum.at(i + k, j + l) += factor * times(a.at(i, j), b.at(k, l));
}

std::vector<double> lengths(const std::vector<Vec3>& values) {
  std::vector<double> all;
  for (const Vec3& value : values) all.push_back(length(value));
  return all;
}

}  // namespace

NetSeries::NetSeries(const LocalNet& net, bool normals) : m_(net.m_), n_(net.n_) {
  std::vector<Vec3> points = centred(net.points_, m_, n_);
  std::vector<double> weights;
  middle_ = points[0];
  if (net.is_rational_) {
    weights = centred(net.weights_, m_, n_);
    middle_ = (1 / weights[0]) * middle_;
    for (std::size_t k = 0; k < points.size(); ++k) points[k] = points[k] - weights[k] * middle_;
    for (const double w : weights) weights_.push_back(std::abs(w));
  }
  points[0] = {};
  points_ = lengths(points);
  bound_hull(net);
  if (normals) make_normals(points, weights);
}

void NetSeries::bound_hull(const LocalNet& net) {
  double least = 1, x = 0, xu = 0, xv = 0, wu = 0, wv = 0;
  if (net.is_rational_) least = *std::ranges::min_element(net.weights_);
  const auto weight = [&](std::size_t k) { return net.is_rational_ ? net.weights_[k] : 1; };
  const auto point = [&](std::size_t k) { return net.points_[k] - weight(k) * middle_; };
  for (std::size_t i = 0; i < count_of(m_); ++i)
    for (std::size_t j = 0; j < count_of(n_); ++j) {
      const std::size_t k = net.index(i, j);
      x = std::max(x, length(point(k)) / weight(k));
      if (i > 0) {
        const std::size_t before = net.index(i - 1, j);
        xu = std::max(xu, length(point(k) - point(before))), wu = std::max(wu, std::abs(weight(k) - weight(before)));
      }
      if (j > 0) {
        xv = std::max(xv, length(point(k) - point(k - 1))), wv = std::max(wv, std::abs(weight(k) - weight(k - 1)));
      }
    }
  constexpr double slack = 1.001;
  x *= slack;
  real_ = {x, slack * m_ * (xu + x * wu) / least, slack * n_ * (xv + x * wv) / least};
}

void NetSeries::make_normals(const std::vector<Vec3>& points, const std::vector<double>& weights) {
  Series<Vec3> x(m_, n_);
  x.values = points;
  const Series<Vec3> xu = x.by_x(), xv = x.by_y();
  Series<Vec3> plain(2 * m_, 2 * n_);
  add_product(plain, 1, xu, xv, [](const Vec3& a, const Vec3& b) { return cross(a, b); });
  if (weights.empty()) {
    mn_ = plain.m, nn_ = plain.n;
    normals_ = lengths(plain.values);
    return;
  }
  // w^3 r_u x r_v = w X_u x X_v - w_v X_u x X - w_u X x X_v with r = X / w.
  Series<double> w(m_, n_);
  w.values = weights;
  const auto scaled = [](double a, const Vec3& b) { return a * b; };
  const auto crossed = [](const Vec3& a, const Vec3& b) { return cross(a, b); };
  Series<Vec3> from_u(2 * m_, 2 * n_), from_v(2 * m_, 2 * n_), all(3 * m_, 3 * n_);
  add_product(from_u, 1, xu, x, crossed);
  add_product(from_v, 1, x, xv, crossed);
  add_product(all, 1, w, plain, scaled);
  add_product(all, -1, w.by_y(), from_u, scaled);
  add_product(all, -1, w.by_x(), from_v, scaled);
  mn_ = all.m, nn_ = all.n;
  normals_ = lengths(all.values);
}

NetSeries::Powers NetSeries::powers(double reach_u, double reach_v, int degree_u, int degree_v) {
  Powers all;
  all.u[0] = all.v[0] = 1;
  for (std::size_t k = 1; k < count_of(degree_u); ++k) all.u[k] = all.u[k - 1] * reach_u;
  for (std::size_t k = 1; k < count_of(degree_v); ++k) all.v[k] = all.v[k - 1] * reach_v;
  return all;
}

double NetSeries::least_weight(const Powers& powers) const {
  if (weights_.empty()) return 1;
  double sum = 0;
  for (std::size_t i = 0; i < count_of(m_); ++i)
    for (std::size_t j = 0; j < count_of(n_); ++j) sum += weights_[i * count_of(n_) + j] * powers.u[i] * powers.v[j];
  return weights_[0] - bound_slack * (sum - weights_[0]) - 0x1p-40 * weights_[0];
}

NetSeries::Sizes NetSeries::sizes(double reach_u, double reach_v) const {
  const Powers p = powers(reach_u, reach_v, m_, n_);
  const double least = least_weight(p);
  const bool is_real = reach_u <= 1 && reach_v <= 1;
  if (!(least > 0)) return is_real ? real_ : Sizes{infinity, infinity, infinity};
  double x = 0, xu = 0, xv = 0, wu = 0, wv = 0;
  for (std::size_t i = 0; i < count_of(m_); ++i)
    for (std::size_t j = 0; j < count_of(n_); ++j) {
      const std::size_t k = i * count_of(n_) + j;
      const double by_u = i > 0 ? static_cast<double>(i) * p.u[i - 1] * p.v[j] : 0,
                   by_v = j > 0 ? static_cast<double>(j) * p.u[i] * p.v[j - 1] : 0;
      x += points_[k] * p.u[i] * p.v[j], xu += points_[k] * by_u, xv += points_[k] * by_v;
      if (!weights_.empty()) wu += weights_[k] * by_u, wv += weights_[k] * by_v;
    }
  // r_u = (X_u - r w_u) / w, and d/du = 2 d/dx. The slack covers the coefficients' rounding too.
  constexpr double slack = 1.001;
  x *= slack / least;
  const Sizes size{x, 2 * slack * (xu + x * wu) / least, 2 * slack * (xv + x * wv) / least};
  if (!is_real) return size;
  return {std::min(size.position, real_.position), std::min(size.du, real_.du), std::min(size.dv, real_.dv)};
}

double NetSeries::turn(double reach_u, double reach_v, double least) const {
  const Powers p = powers(reach_u, reach_v, mn_, nn_);
  double sum = 0;
  for (std::size_t i = 0; i < count_of(mn_); ++i)
    for (std::size_t j = 0; j < count_of(nn_); ++j) sum += normals_[i * count_of(nn_) + j] * p.u[i] * p.v[j];
  // Products and sums of the coefficients are rounded: a share of what they would be if nothing cancelled.
  const Sizes size = sizes(reach_u, reach_v);
  const double weight = weights_.empty() ? 1 : 2 * weights_[0] - least;
  return sum * (1 + 0x1p-30) - normals_[0] + 0x1p-44 * 0.25 * size.du * size.dv * weight * weight * weight;
}

double NetSeries::normal(double reach_u, double reach_v) const {
  const double least = least_weight(powers(reach_u, reach_v, m_, n_));
  if (!(least > 0)) return infinity;
  const double middle = normals_[0], by = turn(reach_u, reach_v, least);
  if (!(2 * middle * by + by * by < 0.99 * middle * middle)) return infinity;
  return 4 * (middle + by) / (least * least * least);
}

double NetSeries::real_normal() const {
  const Sizes size = sizes(1, 1);
  const double least = least_weight(powers(1, 1, m_, n_));
  if (!(least > 0)) return size.du * size.dv;
  return std::min(size.du * size.dv, 4 * (normals_[0] + turn(1, 1, least)) / (least * least * least));
}

double NetSeries::normal_turn(bool along_u) const {
  double sum = 0;
  for (std::size_t i = 0; i < count_of(mn_); ++i)
    for (std::size_t j = 0; j < count_of(nn_); ++j)
      if ((along_u ? i : j) > 0) sum += normals_[i * count_of(nn_) + j];
  return sum;
}

}}  // namespace tessera::abi_0_1
