#include "measure/scalar_net.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {

ScalarNet::ScalarNet(const BezierPatch& patch, int axis, double sign) : m_(patch.degree_u()), n_(patch.degree_v()) {
  double largest = 1;
  if (patch.is_rational()) largest = *std::ranges::max_element(patch.weights());
  const double scale = std::ldexp(1.0, -std::ilogb(largest));
  for (std::size_t k = 0; k < patch.points().size(); ++k) {
    const Vec3& p = patch.points()[k];
    const double x = sign * (axis == 0 ? p.x : axis == 1 ? p.y : p.z);
    const double w = patch.is_rational() ? scale * patch.weights()[k] : 1;
    values_.push_back(w * x);
    if (patch.is_rational()) weights_.push_back(w);
  }
}

ScalarNet ScalarNet::restricted(const Domain& to) const {
  ScalarNet net = *this;
  cut_net(net.values_, m_, n_, to);
  if (!net.weights_.empty()) cut_net(net.weights_, m_, n_, to);
  return net;
}

double ScalarNet::highest() const {
  double most = value(0);
  for (std::size_t k = 1; k < values_.size(); ++k) most = std::max(most, value(k));
  return most;
}

double ScalarNet::size() const {
  double most = 0;
  for (std::size_t k = 0; k < values_.size(); ++k) most = std::max(most, std::abs(value(k)));
  return most;
}

double ScalarNet::corner(bool last_u, bool last_v) const {
  return value((last_u ? static_cast<std::size_t>(m_) * count_of(n_) : 0) +
               (last_v ? static_cast<std::size_t>(n_) : 0));
}

double ScalarNet::variation(bool along_u) const {
  double most = 0;
  for (std::size_t i = 0; i < count_of(m_); ++i)
    for (std::size_t j = 0; j < count_of(n_); ++j)
      most = std::max(most, std::abs(value(i * count_of(n_) + j) - value(along_u ? j : i * count_of(n_))));
  return most;
}

ScalarRange ScalarNet::slope(bool along_u) const {
  // r_u = (X_u - r w_u) / w, with r and X relative to a value of the net, so that r is small.
  const double middle = value(0);
  double low = std::numeric_limits<double>::infinity(), high = -low, weight_slope = 0, reach = 0;
  double least = 1, most = 1;
  if (!weights_.empty()) {
    const auto [a, b] = std::ranges::minmax_element(weights_);
    least = *a, most = *b;
  }
  const auto weight = [&](std::size_t k) { return weights_.empty() ? 1 : weights_[k]; };
  const std::size_t step = along_u ? count_of(n_) : 1;
  for (std::size_t i = 0; i < count_of(m_); ++i)
    for (std::size_t j = 0; j < count_of(n_); ++j) {
      const std::size_t k = i * count_of(n_) + j;
      reach = std::max(reach, std::abs(value(k) - middle));
      if ((along_u ? i : j) == 0) continue;
      const double by = (values_[k] - middle * weight(k)) - (values_[k - step] - middle * weight(k - step));
      low = std::min(low, by), high = std::max(high, by);
      weight_slope = std::max(weight_slope, std::abs(weight(k) - weight(k - step)));
    }
  // Cut control values are off by roundings of the values' size.
  const double slack = reach * weight_slope + 0x1p-46 * size() * most;
  const int degree = along_u ? m_ : n_;
  low = degree * (low - slack), high = degree * (high + slack);
  return {low / (low < 0 ? least : most), high / (high > 0 ? least : most)};
}

}}  // namespace tessera::abi_0_1
