#pragma once
// Position and first derivatives of a Bezier patch, as quickly as scalar double code gives them: what Newton's method
// asks for.

#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

struct FirstOrder {
  Vec3 position, du, dv;
  bool valid = true;  ///< false where, outside [0,1]^2, the weight function of a rational patch is not positive
};

/// Any finite (u,v). The position is less `origin`, which is taken off the control points. Agrees with evaluate_jet up to
/// rounding.
FirstOrder first_order(const BezierPatch& patch, double u, double v, const Vec3& origin = {});

}  // namespace tessera::inline abi_0_1
