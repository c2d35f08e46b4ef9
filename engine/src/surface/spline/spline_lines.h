#pragma once
// Conversions from the directions of curves and surfaces to knot lines, and copies of their lists.

#include <span>
#include <vector>

#include "basis/knots.h"
#include "tessera/curve.h"
#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {

inline KnotLine line_of(const Curve& curve) {
  return {curve.degree(), curve.knots(), curve.domain().from, curve.domain().to};
}
inline KnotLine line_u(const BSplineSurface& surface) {
  return {surface.degree_u(), surface.knots_u(), surface.domain().u0, surface.domain().u1};
}
inline KnotLine line_v(const BSplineSurface& surface) {
  return {surface.degree_v(), surface.knots_v(), surface.domain().v0, surface.domain().v1};
}

template <class T>
std::vector<T> copied(std::span<const T> values) {
  return {values.begin(), values.end()};
}

}}  // namespace tessera::abi_0_1
