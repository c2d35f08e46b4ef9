#pragma once
// Splines that run straight along a parameter, written with more control points than that takes.

#include <vector>

#include "tessera/curve.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// One direction of a spline surface.
struct SplineDirection {
  int degree = 1;
  std::vector<double> knots;
  Interval part;  ///< of its parameters: the domain of the surface
};

/// The net of a spline surface, `[i][j]`, i along u.
struct StraightenedNet {
  SplineDirection u, v;
  std::vector<Vec3> points;
  std::vector<double> weights;  ///< empty if the surface is polynomial
};

/// Replaces a direction in which all lines of the net run straight, at the pace of the parameter, by degree 1 with one
/// span: files write planes and ruled surfaces with hundreds of spans. By linear precision, such lines have their
/// control points at the Greville abscissae (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 8.7), and splines
/// move by no more than their control points: by at most 2^-44 of the largest coordinate here.
void shorten_straight_lines(StraightenedNet& net);

}}  // namespace tessera::abi_0_1
