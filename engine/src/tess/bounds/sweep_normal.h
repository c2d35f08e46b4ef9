#pragma once
// The normal of a patch that a scaled profile sweeps, as a net of low degrees.

#include <optional>

#include "tess/bounds/normal_net.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the field of normal_net() for a patch p(v) + s(v) q(u), or with u and v exchanged: planes, cylinders, cones,
/// spheres, tori, and all surfaces of extrusion and of revolution. Nothing for other patches, and where s vanishes
/// besides at a pole.
///
/// With the homogeneous curves p = C / b, s = R / b and q = E / a, the patch is A / w with A = a C + R E and w = a b.
/// By P = a E' - a' E, K = E' x E, c = b C' - b' C and r = b R' - b' R the numerator of r_u x r_v is
///   w A_u x A_v - w_v A_u x A - w_u A x A_v = (a A_u - a' A) x (b A_v - b' A) = a R (P x c + r K).
/// The field is P x c + r K. Its degrees are 2 m - 2 and 2 n - 2 at most, since the leading terms of a E' - a' E
/// cancel.
///
/// A patch is a sweep up to d, the rounding of its own points. So the field of the patch is this one plus d / (a R),
/// where d is a net of the numerator's degrees, and `rounding` bounds that too, with its first derivatives.
std::optional<NormalNet> sweep_normal_net(const BezierPatch& patch);

}}  // namespace tessera::abi_0_1
