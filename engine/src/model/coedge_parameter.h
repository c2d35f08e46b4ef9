#pragma once
// The parameter of an edge and that of a loop's curve along it.

#include <algorithm>

#include "base/internal_export.h"
#include "tessera/brep.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// The results of curve_parameter() and edge_parameter() for a coedge with a table of parameters.
TESSERA_INTERNAL_EXPORT double tabled_curve_parameter(const Coedge& coedge, const Curve& curve, double s);
TESSERA_INTERNAL_EXPORT double tabled_edge_parameter(const Coedge& coedge, double t);

/// Returns the parameter of the loop's curve at the edge's parameter s, within the curve's domain.
inline double curve_parameter(const Coedge& coedge, const Curve& curve, double s) {
  if (coedge.parameter) return tabled_curve_parameter(coedge, curve, s);
  const Interval& d = curve.domain();
  return std::clamp(coedge.reversed ? d.from + d.to - s : s, d.from, d.to);
}
/// Returns the edge's parameter at t of the loop's curve: the inverse of curve_parameter(), up to rounding.
inline double edge_parameter(const Coedge& coedge, const Curve& curve, double t) {
  if (coedge.parameter) return tabled_edge_parameter(coedge, t);
  const Interval& d = curve.domain();
  return coedge.reversed ? d.from + d.to - t : t;
}

}}  // namespace tessera::abi_0_1
