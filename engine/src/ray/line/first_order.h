#pragma once
// Position and first derivatives of a Bezier patch in fast scalar double code, for Newton's method.

#include "kernel/ray/ray_kernels.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

struct FirstOrder {
  Vec3 position, du, dv;
  bool valid = true;  ///< false outside [0,1]^2 where the weight function of a rational patch is not positive
};

/// Evaluates at any finite (u,v). The position is less `origin`, which is subtracted from the control points. Agrees
/// with evaluate_jet up to rounding.
FirstOrder first_order(const BezierPatch& patch, double u, double v, const Vec3& origin = {});
/// Evaluates at (u,v) in [0,1]^2, by kernels if they know the degrees.
FirstOrder first_order(const BezierPatch& patch, const Vec3& origin, const kernel::RayKernels& kernels, double u,
                       double v);

}}  // namespace tessera::abi_0_1
