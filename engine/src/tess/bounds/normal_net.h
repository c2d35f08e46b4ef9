#pragma once
// Computes the normal of a patch as a Bezier net.

#include <vector>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Control points `[i][j]` of a vector field of the given degrees over [0,1]^2.
struct VectorNet {
  int degree_u = 0, degree_v = 0;
  std::vector<Vec3> at;

  const Vec3& operator()(int i, int j) const { return at[index(i, j)]; }
  Vec3& operator()(int i, int j) { return at[index(i, j)]; }

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (degree_v + 1) + j); }
};

struct NormalNet {
  VectorNet net;
  double rounding = 0;  ///< the largest error of a control point
};

/// Returns a field that points everywhere in the direction of r_u x r_v, scaled to sizes near 1.
///
/// For a rational patch A / w the field is the numerator of that product, w A_u x A_v - w_v A_u x A - w_u A x A_v. At a
/// collapsed edge both vanish; the edge is divided out, so that the field points along the limit of the normal there.
/// Where the field is zero the patch has no normal.
NormalNet normal_net(const BezierPatch& patch);

}}  // namespace tessera::abi_0_1
