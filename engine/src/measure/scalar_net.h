#pragma once
// One coordinate of a patch over a rectangle of its parameters, with its sign: what a side of a box is the maximum of.

#include <vector>

#include "measure/local_curve.h"
#include "measure/local_net.h"

namespace tessera { inline namespace abi_0_1 {

class ScalarNet {
 public:
  /// `axis`: 0 to 2; `sign`: 1 or -1.
  ScalarNet(const BezierPatch& patch, int axis, double sign);
  /// Returns the net over a rectangle within [0, 1]^2 of this one.
  ScalarNet restricted(const Domain& to) const;

  /// The largest control value, which no point exceeds.
  double highest() const;
  /// Ranges of the derivatives by the net's own parameters.
  ScalarRange by_u() const { return slope(true); }
  ScalarRange by_v() const { return slope(false); }
  double corner(bool last_u, bool last_v) const;
  /// How much the control values vary along u, and along v.
  double variation(bool along_u) const;
  /// The size of the values, for bounds of rounding.
  double size() const;

 private:
  double value(std::size_t k) const { return weights_.empty() ? values_[k] : values_[k] / weights_[k]; }
  ScalarRange slope(bool along_u) const;

  int m_, n_;
  std::vector<double> values_, weights_;  ///< homogeneous
};

}}  // namespace tessera::abi_0_1
