#pragma once
// Knot insertion, clamping and degree elevation of many spline curves on the same knots at once: a surface in one
// direction.

#include <cstddef>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A control point and its weight, kept apart so that what does not move keeps its bits.
struct NetPoint {
  Vec3 point;
  double weight = 1;
};

/// A net of `width` curves. The points with index i of all curves are the row points[i * width ..].
struct SplineNet {
  int degree = 1;
  bool rational = false;
  std::size_t width = 1;
  std::vector<double> knots;
  std::vector<NetPoint> points;

  std::size_t count() const { return points.size() / width; }
};

/// Inserts t by Boehm's algorithm (The NURBS Book, eq. 5.15). t must be within the domain of the knots and have a
/// multiplicity below the degree.
void insert_knot(SplineNet& net, double t);
/// Inserts t until its multiplicity is `times`.
void raise_multiplicity(SplineNet& net, double t, std::size_t times);
/// Makes `from` and `to` the ends, (degree + 1)-fold; from < to within the domain of the knots.
void clamp(SplineNet& net, double from, double to);
/// Returns the net with one degree more; `net` must be clamped.
SplineNet elevate_degree(const SplineNet& net);
/// Returns the points with rows and curves exchanged. The caller keeps the knots.
std::vector<NetPoint> transposed(const std::vector<NetPoint>& points, std::size_t width);

}}  // namespace tessera::abi_0_1
