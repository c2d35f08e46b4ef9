#pragma once
// Bounds how fast a point of a patch moves with its parameters.

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Bounds on |r_u|, |r_v| and |r_u . r_v| over the patch, in its lengths over its own parameters.
struct SpeedBound {
  double u = 0, v = 0, product = 0;

  /// Polynomial patches: m max |V_(i+1)j - V_ij| bounds |r_u|, as r_u is in the hull of these vectors.
  ///
  /// Rational patches, with lengths relative to the middle c of their box and R the largest |V_ij - c|: the smaller of
  /// - (|A_u| + |w_u| R) / w_min, from r_u = (A_u - w_u (r - c)) / w, with A = w (r - c) and hulls of A_u and w_u;
  /// - m (w_max / w_min) 2 R (Floater 1992, Derivatives of rational Bezier curves, for each curve v = const: its
  ///   weights lie between those of the patch, its control points in the hull).
  ///
  /// The product is at most |r_u| |r_v|. For polynomial patches of small degrees it also lies in the hull of the
  /// products of all m (V_(i+1)j - V_ij) with all n (V_k(l+1) - V_kl): so it is about 0 for rectangles.
  static SpeedBound of(const BezierPatch& patch);
  /// Returns the bounds for parameters that run over [0, range_u] and [0, range_v] instead of [0, 1].
  SpeedBound over(double range_u, double range_v) const {
    return {u / range_u, v / range_v, product / (range_u * range_v)};
  }
  /// Bounds how far a point moves with the parameters moved by du and dv, both at least 0.
  double moved(double du, double dv) const;
};

}}  // namespace tessera::abi_0_1
