#include "surface/net/validate.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Weights below this share of the largest one underflow in their products and ratios.
constexpr double smallest_weight_ratio = 1e-100;

}  // namespace

std::string place_in_rows(std::size_t k, std::size_t row) {
  return "[" + std::to_string(k / row) + "][" + std::to_string(k % row) + "]";
}

Status check_degree(int degree, const char* name) {
  if (degree >= 1 && degree <= max_degree) return {};
  return {StatusCode::unsupported_degree,
          std::string(name) + " is " + std::to_string(degree) + ", it must be 1 to " + std::to_string(max_degree)};
}

Status check_points(std::span<const Vec3> points, Place place) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k];
    if (is_finite(p)) continue;
    return {StatusCode::non_finite,
            "control point " + place(k) + " is (" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) +
                "), its coordinates must be finite",
            static_cast<std::ptrdiff_t>(k)};
  }
  return {};
}

Status check_weights(std::span<const double> weights, Place place) {
  const auto bad = [&](std::size_t k, const std::string& wanted) {
    return Status(StatusCode::invalid_weight, "weight " + place(k) + " is " + text(weights[k]) + ", " + wanted,
                  static_cast<std::ptrdiff_t>(k));
  };
  double largest = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(std::isfinite(weights[k]) && weights[k] > 0)) return bad(k, "it must be finite and greater than 0");
    largest = std::max(largest, weights[k]);
  }
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (weights[k] < smallest_weight_ratio * largest)
      return bad(k, "it must be at least " + text(smallest_weight_ratio) + " of the largest weight, " + text(largest));
  return {};
}

bool all_equal(std::span<const double> weights) {
  return std::all_of(weights.begin(), weights.end(), [&](double weight) { return weight == weights[0]; });
}

}}  // namespace tessera::abi_0_1
