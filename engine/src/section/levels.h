#pragma once
// The heights of a set along the normal of parallel planes, and the heights of the planes.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// The planes of a call. Heights are relative to `origin`, so that they are as precise as the points.
struct Levels {
  Vec3 normal;  ///< of length 1
  Vec3 origin;
  std::vector<double> heights;  ///< growing
  double contact = 0;           ///< points this near to a plane count as its own
  double rounding = 0;          ///< of heights and positions
  double chord = 0;             ///< the distance that chords may have
  double point_size = 0;        ///< what is smaller is a point
  std::size_t max_points = 0;   ///< of all sections

  double height(const Vec3& p) const { return dot(normal, p - origin); }
  /// The planes that may meet points of these heights.
  std::span<const double> within(double low, double high) const {
    const auto first = std::ranges::lower_bound(heights, low - 2 * contact);
    const auto end = std::upper_bound(first, heights.end(), high + 2 * contact);
    return {first, end};
  }
};

/// A plane that is cut: `at` is where points are, `side` divides points below from points above.
struct Level {
  double at, side;
  bool is_above(double height) const { return height >= side; }
};

}}  // namespace tessera::abi_0_1
