#pragma once
// Position, first and second derivatives of a Bezier patch in double, for Newton's method.

#include "kernel/ray/nearest_kernels.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// A patch to be evaluated.
struct SecondOrderPatch {
  const BezierPatch* patch;
  Vec3 origin;  ///< subtracted from the control points
  const kernel::NearestKernels* kernels;
};

/// Evaluates at (u,v) in [0,1]^2. The position is less the origin.
void second_order(const SecondOrderPatch& of, double u, double v, kernel::SecondOrder& out);

}}  // namespace tessera::abi_0_1
