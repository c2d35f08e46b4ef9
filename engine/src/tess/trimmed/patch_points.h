#pragma once
// Points of a patch in double, one by one and along lines of a grid.

#include <array>
#include <limits>

#include "surface/net/homogeneous.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Evaluates a patch at parameters in [0,1]^2. On a side only the side's control points count, because Bernstein values
/// at 0 and 1 are exact; so neighbours with the same control points get the same bits. Corners are control points.
/// Rounding: f64_vertex_rounding().
class PatchPoints {
 public:
  /// Prepares points relative to `origin`. The patch must outlive this object.
  PatchPoints(const BezierPatch& patch, const Vec3& origin) : patch_(patch), origin_(origin), net_(patch, origin) {}

  /// Fastest for one u after the other.
  Vec3 at(const ParameterPoint& local);

 private:
  void begin_row(double u);

  const BezierPatch& patch_;
  Vec3 origin_;
  HomogeneousNet net_;
  double row_u_ = std::numeric_limits<double>::quiet_NaN();  ///< the u of `row_`
  std::array<Homogeneous, max_degree + 1> row_;
};

}  // namespace tessera::inline abi_0_1
