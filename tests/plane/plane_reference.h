#pragma once
// Checks triangles of plane polygons in 128-bit integers. Shares no code with the library: all coordinates are integers
// below 2^50, so every sign and every area is exact.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "plane/polygon_triangles.h"

namespace tessera::test {

__extension__ typedef __int128 Wide;  // the standard has no name for it
using Points = std::vector<ParameterPoint>;
using PlaneSegments = std::vector<PlaneSegment>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// A random number below `end`.
template <class Random>
std::uint32_t below(Random& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}

/// Twice the area of a triangle.
inline Wide twice_area(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  const auto whole = [](double x) { return static_cast<Wide>(std::llround(x)); };
  return (whole(b.u) - whole(a.u)) * (whole(c.v) - whole(a.v)) - (whole(b.v) - whole(a.v)) * (whole(c.u) - whole(a.u));
}
inline int sign(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
inline int side(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  return sign(twice_area(a, b, c));
}
/// Whether two segments cross within both.
inline bool crosses(const Points& points, PlaneSegment a, PlaneSegment b) {
  const ParameterPoint &p = points[a.start], &q = points[a.end], &r = points[b.start], &s = points[b.end];
  return side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0;
}
inline bool is_on(const ParameterPoint& p, const ParameterPoint& a, const ParameterPoint& b) {
  return side(a, b, p) == 0 && p.u >= std::min(a.u, b.u) && p.u <= std::max(a.u, b.u) && p.v >= std::min(a.v, b.v) &&
         p.v <= std::max(a.v, b.v);
}

/// Whether a point that lies on no segment is inside by parity.
inline bool is_inside(const ParameterPoint& p, const Points& points, const PlaneSegments& borders) {
  bool inside = false;
  for (const auto& [start, end] : borders) {
    const ParameterPoint &a = points[start], &b = points[end];
    if ((a.v <= p.v) == (b.v <= p.v)) continue;
    if (side(a, b, p) * (b.v > a.v ? 1 : -1) > 0) inside = !inside;
  }
  return inside;
}

/// The segments of closed rings. Ring k holds the points from ends[k - 1] up to ends[k].
inline PlaneSegments segments_of(std::span<const std::uint32_t> ends) {
  PlaneSegments segments;
  std::uint32_t first = 0;
  for (const std::uint32_t end : ends) {
    for (std::uint32_t k = first; k < end; ++k) segments.push_back({k, k + 1 < end ? k + 1 : first});
    first = end;
  }
  return segments;
}

/// Twice the area that rings enclose in the direction in which they run.
inline Wide twice_enclosed(const Points& points, const PlaneSegments& borders) {
  Wide sum = 0;
  for (const auto& [start, end] : borders) sum += twice_area({0, 0}, points[start], points[end]);
  return sum;
}
inline Wide twice_area(const Points& points, const Triangles& triangles) {
  Wide sum = 0;
  for (const auto& [a, b, c] : triangles) sum += twice_area(points[a], points[b], points[c]);
  return sum;
}

/// The edges without a partner, and the first fault: a triangle without an area, an edge that two triangles use in one
/// direction.
struct Surface {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  std::string fault;
};
inline Surface surface_of(const Points& points, const Triangles& triangles) {
  Surface surface;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : triangles) {
    if (twice_area(points[t[0]], points[t[1]], points[t[2]]) <= 0) surface.fault = "a triangle without an area";
    for (std::size_t k = 0; k < 3; ++k)
      if (++uses[{t[k], t[(k + 1) % 3]}] > 1) surface.fault = "an edge is used twice";
  }
  for (const auto& [edge, count] : uses)
    if (!uses.contains({edge.second, edge.first})) surface.open.push_back(edge);
  return surface;
}

/// Empty if the triangles fit together and their open edges are the borders, each once, in the direction that has the
/// inside on the left; no segment may overlap another.
inline std::string fault_of(const Points& points, const Triangles& triangles, const PlaneSegments& borders) {
  Surface surface = surface_of(points, triangles);
  if (!surface.fault.empty()) return surface.fault;
  const auto sorted = [](std::uint32_t a, std::uint32_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted, found;
  for (const auto& [start, end] : borders) wanted.push_back(sorted(start, end));
  for (const auto& [start, end] : surface.open) found.push_back(sorted(start, end));
  std::ranges::sort(wanted);
  std::ranges::sort(found);
  return wanted == found ? "" : "the open edges are not the borders";
}

/// A number of triangles that hold a point which lies on no edge.
inline int cover(const Points& points, const Triangles& triangles, const ParameterPoint& p) {
  int count = 0;
  for (const auto& [a, b, c] : triangles)
    count +=
        side(points[a], points[b], p) > 0 && side(points[b], points[c], p) > 0 && side(points[c], points[a], p) > 0;
  return count;
}

/// Adds a ring of a star's points around a centre, at radii from `inner` to `outer`, as integers.
template <class Random>
void add_star(Points& points, std::vector<std::uint32_t>& ends, Random& random, ParameterPoint centre, double inner,
              double outer, int count, bool backward = false) {
  std::uniform_real_distribution<double> radius(inner, outer);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * (backward ? -k : k) / count, r = radius(random);
    points.push_back({std::round(centre.u + r * std::cos(angle)), std::round(centre.v + r * std::sin(angle))});
  }
  ends.push_back(static_cast<std::uint32_t>(points.size()));
}

}  // namespace tessera::test
