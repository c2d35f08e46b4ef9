#pragma once
// Points of a patch by both parameters, or by one parameter and the height.

#include <vector>

#include "section/levels.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// A point of a patch, with its parameters from 0 to 1.
struct HeightPoint {
  Vec3 position;
  ParameterPoint at;
};

class HeightPatch {
 public:
  HeightPatch(const BezierPatch& patch, const Levels& levels);

  /// The point at (u,v). Borders with equal control points have equal points at equal parameters.
  Vec3 position(const ParameterPoint& at) const;
  /// The point with a parameter (u, if `over_u`) and a height. `low`, `high`: of the other parameter, which lies there;
  /// an end of it if no point has this height. `guess`: near it.
  HeightPoint point(bool over_u, double along, double height, double low, double high, double guess) const;

 private:
  static constexpr int x = 0, h = 3, w = 4;  ///< components
  const double* component(int k) const { return values_.data() + static_cast<std::size_t>(k) * count_; }
  void reduce(int component, bool over_u, const double* basis, double* curve) const;
  double solve(const double* heights, const double* weights, int degree, double height, double low, double high,
               double guess) const;

  int m_, n_;
  bool rational_;
  std::size_t count_;
  Vec3 origin_;
  std::vector<double> values_;  ///< `[x, y, z, height, weight][i][j]`, times weights; relative to the levels' origin
};

}}  // namespace tessera::abi_0_1
