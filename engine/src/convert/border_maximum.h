#pragma once
// Proven maxima along a border of figures made of a vector and a scalar polynomial.

#include "basis/bernstein_net.h"
#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

/// A vector curve over a scalar one, both on [0,1].
struct VectorRatio {
  BernsteinNet<Vec3> numerator;
  BernsteinNet<double> denominator;
};

/// An upper bound, and whether it is within 0.1 % or `floor` of the true maximum.
struct Maximum {
  double bound = 0;
  bool sharp = true;
};

/// max |numerator| / denominator, for a positive denominator.
Maximum largest_length(const VectorRatio& ratio, double floor);
/// max of the angle atan2(|numerator|, denominator), for numerator = a x b and denominator = a . b.
Maximum largest_angle(const VectorRatio& ratio, double floor);

}  // namespace tessera::inline abi_0_1
