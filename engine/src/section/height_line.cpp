#include "section/height_line.h"

#include <array>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Cuts Bernstein coefficients at 1/2; equal ones stay equal.
std::vector<double> take_left_half(std::vector<double>& net) {
  std::vector<double> left(net.size());
  for (std::size_t last = net.size(); last-- > 0;) {
    left[net.size() - 1 - last] = net[0];
    for (std::size_t i = 0; i < last; ++i) net[i] = 0.5 * net[i] + 0.5 * net[i + 1];
  }
  return left;
}

double ratio(const std::vector<double>& weighted, const std::vector<double>& weights, std::size_t k) {
  return weights.empty() ? weighted[k] : weighted[k] / weights[k];
}

}  // namespace

struct HeightLine::Part {
  std::vector<double> weighted, weights;
  double from, to;
  int depth;
};

bool HeightLine::is_simple(const Part& part, const Levels& levels) const {
  const std::size_t count = part.weighted.size();
  double low = ratio(part.weighted, part.weights, 0), high = low;
  for (std::size_t k = 1; k < count; ++k) {
    const double height = ratio(part.weighted, part.weights, k);
    low = std::min(low, height), high = std::max(high, height);
  }
  const std::span<const double> near = levels.within(low, high);
  if (near.empty() || high - low <= levels.rounding) return true;
  for (const double height : {near.front(), near.back()}) {
    double least = 0, most = 0;
    for (std::size_t k = 0; k + 1 < count; ++k) {
      const double weights = part.weights.empty() ? 0 : part.weights[k + 1] - part.weights[k];
      const double step = part.weighted[k + 1] - part.weighted[k] - height * weights;
      least = std::min(least, step), most = std::max(most, step);
    }
    const double first = part.weighted[0] - height * (part.weights.empty() ? 1 : part.weights[0]);
    const double last = part.weighted[count - 1] - height * (part.weights.empty() ? 1 : part.weights[count - 1]);
    if ((first < last ? -least : most) > levels.rounding) return false;
  }
  // Both planes must see the same direction, or those between would not.
  const auto rises = [&](double height) {
    const double first = part.weighted[0] - height * (part.weights.empty() ? 1 : part.weights[0]);
    return first < part.weighted[count - 1] - height * (part.weights.empty() ? 1 : part.weights[count - 1]);
  };
  return rises(near.front()) == rises(near.back());
}

void HeightLine::divide(const Levels& levels) {
  places_.assign(1, 0);
  heights_.assign(1, ratio(weighted_, weights_, 0));
  std::vector<Part> parts{{weighted_, weights_, 0, 1, 0}};
  while (!parts.empty()) {
    Part part = std::move(parts.back());
    parts.pop_back();
    const bool is_deep = part.depth >= max_depth || places_.size() >= max_intervals;
    if (is_deep || is_simple(part, levels)) {
      is_shallow_ = is_shallow_ || (places_.size() >= max_intervals && !is_simple(part, levels));
      places_.push_back(part.to);
      heights_.push_back(ratio(part.weighted, part.weights, part.weighted.size() - 1));
      continue;
    }
    const double middle = 0.5 * (part.from + part.to);
    Part left{take_left_half(part.weighted), {}, part.from, middle, part.depth + 1};
    if (!part.weights.empty()) left.weights = take_left_half(part.weights);
    part.from = middle;
    ++part.depth;
    parts.push_back(std::move(part));
    parts.push_back(std::move(left));
  }
}

std::size_t HeightLine::interval_at(double place) const {
  const auto above = std::upper_bound(places_.begin(), places_.end(), place);
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - places_.begin() - 1, 0, std::ssize(places_) - 2));
}

/// Returns weight * (height of the line - height) at t, and its derivative.
double HeightLine::value(double t, double height, double& slope) const {
  std::array<double, 16> small;
  std::vector<double> large;
  double* net = small.data();
  const std::size_t count = weighted_.size();
  if (count > small.size()) {
    large.resize(count);
    net = large.data();
  }
  for (std::size_t k = 0; k < count; ++k) net[k] = weighted_[k] - height * (weights_.empty() ? 1 : weights_[k]);
  for (std::size_t last = count - 1; last > 1; --last)
    for (std::size_t k = 0; k < last; ++k) net[k] = net[k] + t * (net[k + 1] - net[k]);
  if (count == 1) return slope = 0, net[0];
  slope = static_cast<double>(count - 1) * (net[1] - net[0]);
  return net[0] + t * (net[1] - net[0]);
}

double HeightLine::root(std::size_t interval, double height) const {
  double low = places_[interval], high = places_[interval + 1], slope = 0;
  const double first = value(low, height, slope), last = value(high, height, slope);
  if (first == 0 || last == 0 || (first < 0) == (last < 0)) return std::abs(first) <= std::abs(last) ? low : high;
  double t = low + (high - low) * (first / (first - last));
  if (weighted_.size() == 2) return std::clamp(t, low, high);
  for (int step = 0; step < 100; ++step) {
    const double at = value(t, height, slope);
    if (at == 0) return t;
    ((at < 0) == (first < 0) ? low : high) = t;
    double next = t - at / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 0x1p-53 || next == low || next == high) return next;
    t = next;
  }
  return t;
}

}}  // namespace tessera::abi_0_1
