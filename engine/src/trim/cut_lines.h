#pragma once
// The lines between patches, by which loops are cut.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the interval between increasing lines, at least two, that holds x. A line belongs to the interval after it;
/// beyond the lines it is the nearest interval.
inline std::size_t interval_of(std::span<const double> lines, double x) {
  const auto above = std::ranges::upper_bound(lines, x) - lines.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(lines) - 2));
}

/// The lines of one direction, strictly increasing, at least two: the first and the last are sides of the domain.
struct CutAxis {
  std::vector<double> lines;
  bool periodic = false;
  double snap = 0;  ///< coordinates this near to a line are moved onto it

  double from() const { return lines.front(); }
  double to() const { return lines.back(); }
  double period() const { return to() - from(); }

  /// The line within `snap` of x, or x.
  double snapped(double x) const {
    const auto above = std::lower_bound(lines.begin(), lines.end(), x);
    if (above != lines.end() && *above - x <= snap) return *above;
    if (above != lines.begin() && x - *(above - 1) <= snap) return *(above - 1);
    return x;
  }
  bool is_line(double x) const { return std::binary_search(lines.begin(), lines.end(), x); }
};

/// The lines of both directions.
struct CutLines {
  CutAxis u, v;
  ParameterPoint snapped(const ParameterPoint& p) const { return {u.snapped(p.u), v.snapped(p.v)}; }
};

}}  // namespace tessera::abi_0_1
