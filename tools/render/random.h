#pragma once
// Random numbers without state: functions of the pixel, the sample and the purpose, so that a picture does not depend
// on the order in which it is made.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tessera/geometry.h"

namespace tessera::render {

/// The use of a random number.
enum class Purpose : std::uint32_t { pixel, sun, ambient, bounce_sun };

struct Point2 {
  double x = 0, y = 0;
};

/// The finaliser of SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
inline std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Sample `index` of side x side in the unit square, one in each cell of a grid; each pixel and purpose has its own
/// order.
inline Point2 stratified(std::uint32_t pixel, int index, int side, Purpose purpose) {
  const std::uint64_t key = scramble((std::uint64_t{pixel} << 8) | static_cast<std::uint64_t>(purpose));
  const auto count = static_cast<std::uint64_t>(side * side);
  // A rotated order is enough to break the correlation of pixel, sun and ambient samples.
  const std::uint64_t cell = purpose == Purpose::pixel ? static_cast<std::uint64_t>(index)
                                                       : (static_cast<std::uint64_t>(index) + key % count) % count;
  const std::uint64_t bits = scramble(key ^ (static_cast<std::uint64_t>(index) * 0x2545f4914f6cdd1du));
  const double x = static_cast<double>(bits >> 40) * 0x1p-24, y = static_cast<double>(bits & 0xffffff) * 0x1p-24;
  const auto width = static_cast<std::uint64_t>(side);
  return {(static_cast<double>(cell % width) + x) / side, (static_cast<double>(cell / width) + y) / side};
}

/// Two unit vectors that complete the unit vector n to an orthonormal frame
/// (Duff et al., Building an orthonormal basis, revisited, JCGT 6(1), 2017).
struct Frame {
  Vec3 x, y, n;
  explicit Frame(const Vec3& normal) : n(normal) {
    const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    x = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 at(double a, double b, double c) const { return a * x + b * y + c * n; }
};

/// A direction about n with density cos / pi.
inline Vec3 cosine_direction(const Vec3& n, const Point2& sample) {
  const double radius = std::sqrt(sample.x), angle = 2 * std::numbers::pi * sample.y;
  return Frame(n).at(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - sample.x));
}

/// A direction within a cone of the given tangent about n.
inline Vec3 cone_direction(const Vec3& n, double tangent, const Point2& sample) {
  const double radius = tangent * std::sqrt(sample.x), angle = 2 * std::numbers::pi * sample.y;
  return normalized(Frame(n).at(radius * std::cos(angle), radius * std::sin(angle), 1));
}

}  // namespace tessera::render
