#include "section/height_patch.h"

#include <array>
#include <cmath>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {

HeightPatch::HeightPatch(const BezierPatch& patch, const Levels& levels)
    : m_(patch.degree_u()),
      n_(patch.degree_v()),
      rational_(patch.is_rational()),
      count_(patch.points().size()),
      origin_(levels.origin),
      values_(count_ * (rational_ ? 5 : 4)) {
  for (std::size_t k = 0; k < count_; ++k) {
    const double weight = rational_ ? patch.weights()[k] : 1;
    const Vec3 p = weight * (patch.points()[k] - levels.origin);
    values_[k] = p.x, values_[count_ + k] = p.y, values_[2 * count_ + k] = p.z;
    values_[h * count_ + k] = weight * levels.height(patch.points()[k]);
    if (rational_) values_[w * count_ + k] = weight;
  }
}

/// Writes the control values of the curve with a constant u (or v), whose Bernstein values are `basis`.
void HeightPatch::reduce(int component, bool over_u, const double* basis, double* curve) const {
  const double* const net = this->component(component);
  if (over_u) {
    for (int j = 0; j <= n_; ++j) curve[j] = basis[0] * net[j];
    for (int i = 1; i <= m_; ++i)
      for (int j = 0; j <= n_; ++j) curve[j] += basis[i] * net[i * (n_ + 1) + j];
  } else {
    for (int i = 0; i <= m_; ++i) {
      const double* const row = net + i * (n_ + 1);
      double sum = basis[0] * row[0];
      for (int j = 1; j <= n_; ++j) sum += basis[j] * row[j];
      curve[i] = sum;
    }
  }
}

Vec3 HeightPatch::position(const ParameterPoint& at) const {
  std::array<double, max_degree + 1> u, v, curve;
  bernstein_values(m_, at.u, u.data());
  bernstein_values(n_, at.v, v.data());
  // A border is one curve for the patches on both sides, so the parameter along it comes last.
  const bool over_u = at.u == 0 || at.u == 1;
  std::array<double, 5> sums{};
  for (int k = x; k < (rational_ ? 5 : 3); ++k) {
    reduce(k, over_u, over_u ? u.data() : v.data(), curve.data());
    const double* const basis = over_u ? v.data() : u.data();
    for (int i = 0; i <= (over_u ? n_ : m_); ++i)
      sums[static_cast<std::size_t>(k)] += basis[i] * curve[static_cast<std::size_t>(i)];
  }
  const Vec3 sum{sums[0], sums[1], sums[2]};
  return origin_ + (rational_ ? (1 / sums[w]) * sum : sum);
}

double HeightPatch::solve(const double* heights, const double* weights, int degree, double height, double low,
                          double high, double guess) const {
  std::array<double, max_degree + 1> net{};
  const auto value = [&](double t, double& slope) {
    for (int k = 0; k <= degree; ++k)
      net[static_cast<std::size_t>(k)] = heights[k] - height * (weights ? weights[k] : 1);
    for (std::size_t last = static_cast<std::size_t>(degree); last > 1; --last)
      for (std::size_t k = 0; k < last; ++k) net[k] = net[k] + t * (net[k + 1] - net[k]);
    slope = degree * (net[1] - net[0]);
    return net[0] + t * (net[1] - net[0]);
  };
  double slope = 0;
  const double first = value(low, slope), last = value(high, slope);
  if (first == 0 || last == 0 || (first < 0) == (last < 0)) return std::abs(first) <= std::abs(last) ? low : high;
  double t = guess > low && guess < high ? guess : low + (high - low) * (first / (first - last));
  for (int step = 0; step < 100; ++step) {
    const double at = value(t, slope);
    if (at == 0) return t;
    ((at < 0) == (first < 0) ? low : high) = t;
    double next = t - at / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 0x1p-53 || next == low || next == high) return next;
    t = next;
  }
  return t;
}

HeightPoint HeightPatch::point(bool over_u, double along, double height, double low, double high, double guess) const {
  std::array<double, max_degree + 1> basis, heights, weights, curve;
  bernstein_values(over_u ? m_ : n_, along, basis.data());
  reduce(h, over_u, basis.data(), heights.data());
  if (rational_) reduce(w, over_u, basis.data(), weights.data());
  const int degree = over_u ? n_ : m_;
  const double across =
      low == high ? low : solve(heights.data(), rational_ ? weights.data() : nullptr, degree, height, low, high, guess);
  std::array<double, max_degree + 1> other;
  bernstein_values(degree, across, other.data());
  std::array<double, 3> sums{};
  double weight = rational_ ? 0 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    reduce(static_cast<int>(k), over_u, basis.data(), curve.data());
    for (int i = 0; i <= degree; ++i)
      sums[k] += other[static_cast<std::size_t>(i)] * curve[static_cast<std::size_t>(i)];
  }
  if (rational_)
    for (int i = 0; i <= degree; ++i)
      weight += other[static_cast<std::size_t>(i)] * weights[static_cast<std::size_t>(i)];
  const Vec3 sum{sums[0], sums[1], sums[2]};
  return {origin_ + (rational_ ? (1 / weight) * sum : sum),
          over_u ? ParameterPoint{along, across} : ParameterPoint{across, along}};
}

}}  // namespace tessera::abi_0_1
