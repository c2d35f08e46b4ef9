#pragma once
// Proven maxima along a border of functions made of a vector and a scalar polynomial.

#include "basis/bernstein_net.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A vector curve and a scalar curve, both on [0,1].
struct VectorRatio {
  BernsteinNet<Vec3> numerator;
  BernsteinNet<double> denominator;
};

/// An upper bound; `sharp` says that it is within 0.1 % or `floor` of the true maximum.
struct Maximum {
  double bound = 0;
  bool sharp = true;
};

/// Bounds max |numerator| / denominator, for a positive denominator.
Maximum largest_length(const VectorRatio& ratio, double floor);
/// Bounds the maximum of the angle atan2(|numerator|, denominator), for numerator = a x b and denominator = a . b.
Maximum largest_angle(const VectorRatio& ratio, double floor);

}}  // namespace tessera::abi_0_1
