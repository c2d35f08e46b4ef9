#pragma once
// Knot insertion, clamping and degree elevation of many spline curves on the same knots at once: a surface in one
// direction.

#include <cstddef>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

/// A control point and its weight, apart: so what does not move keeps its bits.
struct NetPoint {
  Vec3 point;
  double weight = 1;
};

/// `width` curves: the points of all of them with index i are the row points[i * width ..].
struct SplineNet {
  int degree = 1;
  bool rational = false;
  std::size_t width = 1;
  std::vector<double> knots;
  std::vector<NetPoint> points;

  std::size_t count() const { return points.size() / width; }
};

/// Boehm's algorithm (The NURBS Book, eq. 5.15): t within the domain of the knots, fewer than degree times there.
void insert_knot(SplineNet& net, double t);
/// Inserts t until it stands `times` times.
void raise_multiplicity(SplineNet& net, double t, std::size_t times);
/// Ends at `from` and `to`, (degree + 1)-fold; from < to within the domain of the knots.
void clamp(SplineNet& net, double from, double to);
/// One degree more; of a clamped net.
SplineNet degree_elevated(const SplineNet& net);
/// Rows and curves exchanged; the knots stay with the caller.
std::vector<NetPoint> transposed(const std::vector<NetPoint>& points, std::size_t width);

}  // namespace tessera::inline abi_0_1
