#pragma once
// The relation between the parameter of an edge and that of its curve in a face, as a coedge states it.

#include <functional>
#include <vector>

#include "tessera/brep.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A monotone function of an edge's parameter.
struct MonotoneFunction {
  Interval range;
  std::function<double(double)> at;
  std::vector<double> breaks;  ///< where it is not smooth, within the range and in order
};

/// Drops breaks that lie at the ends of the range or nearly coincide, and orders them.
void settle_breaks(MonotoneFunction& f);
/// States in `coedge` that the parameter of its curve is f(s) at the edge's parameter s: nothing where f runs evenly
/// from one end of `domain`, the curve's, to the other. Otherwise fractions of linear functions, a rational spline of
/// degree 1, within `tolerance` of the range of their values. A function that is not monotone takes the edge from the
/// coedge.
void state_parameter(const MonotoneFunction& f, const Interval& domain, Coedge& coedge, double tolerance = 1e-10);

}}  // namespace tessera::abi_0_1
