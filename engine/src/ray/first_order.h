#pragma once
// Position and first derivatives of a Bezier patch, as quickly as scalar double code gives them: what Newton's method
// asks for.

#include "tessera/bezier_patch.h"

namespace tessera {

struct FirstOrder {
  Vec3 position, du, dv;
  bool valid = true;  ///< false where, outside [0,1]^2, the weight function of a rational patch is not positive
};

/// Any finite (u,v). Agrees with evaluate_jet up to rounding.
FirstOrder first_order(const BezierPatch& patch, double u, double v);

}  // namespace tessera
