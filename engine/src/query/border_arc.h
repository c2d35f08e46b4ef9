#pragma once
// Arcs of the borders of open surfaces, and their share of the solid angle of the surface, seen from a point.
//
// Seen from the origin, a surface covers the flux of r / |r|^3 through it. With a unit vector d, let
//
//   A(r) = -(d x r) / (|r| (|r| - d.r)),  for which  curl A = r / |r|^3 - 4 pi d delta,
//
// where delta is that of the half-line from the origin along d: the vector potential of a magnetic monopole, whose
// string carries the flux back (Dirac 1931, Quantised singularities in the electromagnetic field). By Stokes' theorem
// the solid angle is the integral of A.dl along the surface's border, plus 4 pi for each point where the half-line
// leaves through the surface along its normal, less 4 pi for each where it passes against it. Spainhour, Kreidler,
// Gunderman, Weiss 2024, Robust containment queries over collections of trimmed NURBS surfaces via generalized winding
// numbers, rotate the surface instead until a ray along an axis meets it well.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/function_ref.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A Bezier curve that is nearly straight and of nearly constant speed.
struct BorderArc {
  static constexpr int degree = 7;
  static constexpr std::size_t count = degree + 1;
  std::array<Vec3, count> points;  ///< control points
  /// Points at the five nodes of a Gauss rule, and the derivatives there times the weights.
  std::array<Vec3, 5> nodes, steps;
  std::uint32_t patch = no_id;  ///< whose border it is
  std::int8_t sign = 1;         ///< -1: the border runs from the end to the start
  double bend = 0;              ///< how far control points are from where those of the chord would be

  Vec3 from() const { return sign > 0 ? points.front() : points.back(); }
  Vec3 to() const { return sign > 0 ? points.back() : points.front(); }
};

/// Appends arcs that are as good as a curve over [0, 1]: within `tolerance`, as samples tell, with the same ends. Where
/// a curve takes more than 20 halves or 4096 arcs, these are farther from it. A curve that is a point has none.
void append_arcs(FunctionRef<Vec3(double)> curve, double tolerance, std::uint32_t patch, std::int8_t sign,
                 std::vector<BorderArc>& arcs);

/// A half-line, and how near a border may be to it before it is not sure on which side it passes.
struct HalfLine {
  Vec3 origin, direction;  ///< the direction is a unit vector
  double near = 0;
};
/// A part of the solid angle, in units of 4 pi.
struct AngleShare {
  double value = 0;
  bool is_sure = true;  ///< whether the half-line is farther from the arcs than HalfLine::near
};
/// Adds the integral of A.dl / 4 pi along an arc, right to about 1e-9. The arc is halved where the half-line is near.
void add_share(const BorderArc& arc, const HalfLine& line, AngleShare& share);

}}  // namespace tessera::abi_0_1
