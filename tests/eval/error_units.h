#pragma once
// The sizes by which evaluate.h states its error bounds.

#include <algorithm>

#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test {

/// One unit of the errors at one point of a patch whose points are relative to the set's origin.
struct ErrorUnits {
  double degree;            ///< the higher one
  double position;          ///< the precision's unit times the largest |V - origin|
  double weight_ratio = 1;  ///< of the largest weight to the weight at the point

  ErrorUnits(const BezierPatch& patch, double u, double v, double precision_unit)
      : degree(std::max(patch.degree_u(), patch.degree_v())), position(precision_unit * largest_coefficient(patch)) {
    if (!patch.is_rational()) return;
    Real weight;
    reference_sum(patch, u, v, 0, 0, weight);
    weight_ratio = static_cast<double>(*std::max_element(patch.weights().begin(), patch.weights().end()) / weight);
  }
  double first() const { return position * weight_ratio; }  ///< of first derivatives
  double second() const { return first() * weight_ratio; }  ///< of second derivatives
};

}  // namespace tessera::test
