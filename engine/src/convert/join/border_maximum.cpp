#include "convert/join/border_maximum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

// Branch and bound: the hull of the coefficients bounds the function on a piece from above, the ends of the piece bound
// the maximum from below, and pieces that may still hold the maximum are halved. The hull converges with the square of
// the length (Farin, sec. 6.9).

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_halvings = 40;
constexpr int max_pieces = 20000;

struct Piece {
  VectorRatio ratio;
  int depth = 0;
};

template <class Upper, class Lower>
Maximum maximum(const VectorRatio& whole, double floor, Upper upper, Lower lower) {
  Maximum result;
  double attained = 0;
  std::vector<Piece> open{{whole, 0}};
  for (int count = 0; !open.empty(); ++count) {
    const Piece piece = std::move(open.back());
    open.pop_back();
    const VectorRatio& r = piece.ratio;
    attained = std::max({attained, lower(r.numerator.values.front(), r.denominator.values.front()),
                         lower(r.numerator.values.back(), r.denominator.values.back())});
    const double bound = upper(r);
    const bool settled = bound <= std::max(1.001 * attained, attained + floor);
    if (settled || piece.depth == max_halvings || count >= max_pieces) {
      result.bound = std::max(result.bound, bound);
      result.sharp = result.sharp && settled;
      continue;
    }
    auto [first, second] = halves(r.numerator);
    auto [first_below, second_below] = halves(r.denominator);
    open.push_back({{std::move(second), std::move(second_below)}, piece.depth + 1});
    open.push_back({{std::move(first), std::move(first_below)}, piece.depth + 1});
  }
  return result;
}

double largest(const BernsteinNet<Vec3>& net) {
  double value = 0;
  for (const Vec3& p : net.values) value = std::max(value, length(p));
  return value;
}

/// Returns a lower bound of |p| over the hull: the least distance from zero along the mean direction.
double smallest(const BernsteinNet<Vec3>& net) {
  Vec3 mean;
  for (const Vec3& p : net.values) mean += p;
  mean = normalized(mean);
  double value = std::numeric_limits<double>::infinity();
  for (const Vec3& p : net.values) value = std::min(value, dot(p, mean));
  return std::max(value, 0.0);
}

}  // namespace

Maximum largest_length(const VectorRatio& ratio, double floor) {
  const auto upper = [](const VectorRatio& r) {
    const double top = largest(r.numerator),
                 least = *std::min_element(r.denominator.values.begin(), r.denominator.values.end());
    return top == 0 ? 0 : least > 0 ? top / least : std::numeric_limits<double>::infinity();
  };
  return maximum(ratio, floor, upper, [](const Vec3& p, double w) { return w > 0 ? length(p) / w : 0; });
}

Maximum largest_angle(const VectorRatio& ratio, double floor) {
  const auto upper = [](const VectorRatio& r) {
    // The angle falls as the denominator grows. For a fixed denominator the maximum is at an end of the numerator's
    // range.
    const double least = *std::min_element(r.denominator.values.begin(), r.denominator.values.end());
    const double far = largest(r.numerator), near = smallest(r.numerator);
    if (far == 0 && least == 0) return std::numbers::pi;  // a normal vanishes
    return std::max(std::atan2(far, least), std::atan2(near, least));
  };
  return maximum(ratio, floor, upper, [](const Vec3& p, double x) { return std::atan2(length(p), x); });
}

}}  // namespace tessera::abi_0_1
