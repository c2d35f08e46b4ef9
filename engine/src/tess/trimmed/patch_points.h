#pragma once
// Points and normals of a patch in double, one by one and along lines of a grid.

#include <array>
#include <limits>

#include "surface/net/homogeneous.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Evaluates a patch at parameters in [0,1]^2. On a side only the side's control points count, because Bernstein values
/// at 0 and 1 are exact; so neighbours with the same control points get the same bits. Corners are control points.
/// Rounding: f64_vertex_rounding().
class PatchPoints {
 public:
  /// Prepares points relative to `origin`. The patch must outlive this object.
  PatchPoints(const BezierPatch& patch, const Vec3& origin) : patch_(patch), origin_(origin), net_(patch, origin) {}

  /// Returns the point. Fastest for one u after the other.
  Vec3 at(const ParameterPoint& local);
  /// Returns the unit normal, zero where there is none. Its direction is within 1e-8 of unit_normal(), which decides
  /// where rounding could move it farther.
  Vec3 normal(const ParameterPoint& local);

 private:
  using Row = std::array<Homogeneous, max_degree + 1>;
  void begin_row(double u);
  void begin_row_du(double u);

  const BezierPatch& patch_;
  Vec3 origin_;
  HomogeneousNet net_;
  double row_u_ = std::numeric_limits<double>::quiet_NaN(), row_du_u_ = row_u_;  ///< the u of `row_`, and of `row_du_`
  Row row_, row_du_;  ///< control points of the line u = const, their u-derivatives
};

}}  // namespace tessera::abi_0_1
