#pragma once
// Bounds how fast a point of a patch moves with its parameters.

#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Bounds on |r_u| and |r_v| over the patch, in its lengths over its own parameters.
struct SpeedBound {
  double u = 0, v = 0;

  /// Polynomial patches: m max |V_(i+1)j - V_ij| bounds |r_u|, as r_u is in the hull of these vectors.
  ///
  /// Rational patches, with lengths relative to the middle c of their box and R the largest |V_ij - c|: the smaller of
  /// - (|A_u| + |w_u| R) / w_min, from r_u = (A_u - w_u (r - c)) / w, with A = w (r - c) and hulls of A_u and w_u;
  /// - m (w_max / w_min) 2 R (Floater 1992, Derivatives of rational Bezier curves, for each curve v = const: its
  ///   weights lie between those of the patch, its control points in the hull).
  static SpeedBound of(const BezierPatch& patch);
};

}  // namespace tessera::inline abi_0_1
