#include "measure/local_net.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Cuts a curve of coefficients `stride` apart to [a, b] by de Casteljau's algorithm.
template <class T>
void cut(T* values, std::size_t count, std::size_t stride, double a, double b) {
  if (a > 0)
    for (std::size_t last = count - 1; last > 0; --last)
      for (std::size_t i = 0; i < last; ++i)
        values[i * stride] = (1 - a) * values[i * stride] + a * values[(i + 1) * stride];
  const double to = (b - a) / (1 - a);
  if (!(b < 1)) return;
  for (std::size_t first = 1; first < count; ++first)
    for (std::size_t i = count - 1; i >= first; --i)
      values[i * stride] = (1 - to) * values[(i - 1) * stride] + to * values[i * stride];
}

}  // namespace

template <class T>
void cut_net(std::vector<T>& values, int degree_u, int degree_v, const Domain& to) {
  const std::size_t rows = count_of(degree_u), columns = count_of(degree_v);
  for (std::size_t j = 0; j < columns; ++j) cut(&values[j], rows, columns, to.u0, to.u1);
  for (std::size_t i = 0; i < rows; ++i) cut(&values[i * columns], columns, 1, to.v0, to.v1);
}
template void cut_net(std::vector<double>&, int, int, const Domain&);
template void cut_net(std::vector<Vec3>&, int, int, const Domain&);

LocalNet::LocalNet(const BezierPatch& patch, const Vec3& centre, double data_error)
    : m_(patch.degree_u()), n_(patch.degree_v()), is_rational_(patch.is_rational()), data_error_(data_error) {
  const std::span<const Vec3> points = patch.points();
  double largest = 0;
  for (const double w : patch.weights()) largest = std::max(largest, w);
  // A power of two leaves the weights' digits as they are.
  const double scale = is_rational_ ? std::ldexp(1.0, -std::ilogb(largest)) : 1;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double w = is_rational_ ? scale * patch.weights()[k] : 1;
    points_.push_back(w * (points[k] - centre));
    if (is_rational_) weights_.push_back(w);
  }
}

LocalNet LocalNet::restricted(const Domain& to) const {
  if (to == Domain{}) return *this;
  LocalNet net = *this;
  cut_net(net.points_, m_, n_, to);
  if (is_rational_) cut_net(net.weights_, m_, n_, to);
  net.cuts_ = 1;
  return net;
}

NetRounding LocalNet::rounding() const {
  double least = 1, most = 1, reach = 0;
  if (is_rational_) {
    const auto [low, high] = std::ranges::minmax_element(weights_);
    least = *low, most = *high;
  }
  for (std::size_t k = 0; k < points_.size(); ++k)
    reach = std::max(reach, length(points_[k]) / (is_rational_ ? weights_[k] : 1));
  // Weights are positive, so w P passes cuts and sums of at most m + n levels, 4 roundings each, with an error that is
  // a share of w times the largest |P|. Differences of neighbours lose what their weights differ by.
  const double unit = (8 * (m_ + n_) + 32) * (1 + cuts_) * 0x1p-53, ratio = most / least;
  const double position = 2 * unit * reach + data_error_;
  const auto slope = [&](int degree) {
    return degree * (ratio * (12 * unit * reach + 2 * data_error_) + 2 * (ratio - 1) * position);
  };
  return {position, slope(m_), slope(n_)};
}

double LocalNet::weight_ratio(bool along_u) const {
  double most = 1;
  if (!is_rational_) return most;
  for (std::size_t a = 0; a < count_of(along_u ? n_ : m_); ++a) {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (std::size_t b = 0; b < count_of(along_u ? m_ : n_); ++b) {
      const double w = weights_[along_u ? index(b, a) : index(a, b)];
      low = std::min(low, w), high = std::max(high, w);
    }
    most = std::max(most, high / low);
  }
  return most;
}

LocalNet::Row LocalNet::row(double v) const {
  Row row;
  std::array<double, max_order> basis, slopes;
  bernstein_values(n_, v, basis.data());
  bernstein_derivatives(n_, v, slopes.data());
  for (std::size_t i = 0; i < count_of(m_); ++i) {
    row.points[i] = row.slopes[i] = {};
    row.weights[i] = row.weight_slopes[i] = 0;
    for (std::size_t j = 0; j < count_of(n_); ++j) {
      row.points[i] += basis[j] * points_[index(i, j)];
      row.slopes[i] += slopes[j] * points_[index(i, j)];
      if (!is_rational_) continue;
      row.weights[i] += basis[j] * weights_[index(i, j)];
      row.weight_slopes[i] += slopes[j] * weights_[index(i, j)];
    }
  }
  return row;
}

LocalNetPoint LocalNet::at(const Row& row, double u) const {
  std::array<double, max_order> basis, slopes;
  bernstein_values(m_, u, basis.data());
  bernstein_derivatives(m_, u, slopes.data());
  LocalNetPoint point{};
  double w = 0, wu = 0, wv = 0;
  for (std::size_t i = 0; i < count_of(m_); ++i) {
    point.position += basis[i] * row.points[i];
    point.du += slopes[i] * row.points[i];
    point.dv += basis[i] * row.slopes[i];
    if (!is_rational_) continue;
    w += basis[i] * row.weights[i];
    wu += slopes[i] * row.weights[i];
    wv += basis[i] * row.weight_slopes[i];
  }
  if (!is_rational_) return point;
  const double inverse = 1 / w;
  point.position = inverse * point.position;
  point.du = inverse * (point.du - wu * point.position);
  point.dv = inverse * (point.dv - wv * point.position);
  return point;
}

}}  // namespace tessera::abi_0_1
