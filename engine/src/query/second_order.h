#pragma once
// Position, first and second derivatives of a Bezier patch in fast scalar double code, for Newton's method.

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// A point of a patch and its derivatives by the patch's parameters.
struct SecondOrder {
  Vec3 position, du, dv, duu, duv, dvv;
};

/// Evaluates at (u,v) in [0,1]^2. The position is less `origin`, which is subtracted from the control points.
SecondOrder second_order(const BezierPatch& patch, double u, double v, const Vec3& origin);

}}  // namespace tessera::abi_0_1
