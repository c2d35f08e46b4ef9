#pragma once
// The quantities that can be computed at a point of a surface, as one structure for all uses: flags, views, memory.

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// One member per quantity. `Vector` is the type of those with three components, `Scalar` of those with one, the others
/// of the two kinds. r is the point, N the unit normal; derivatives are by the parameters of the call.
template <class Vector, class Scalar = Vector, class NormalKinds = Scalar, class CurvatureKinds = NormalKinds>
struct Quantities {
  Vector position = {}, du = {}, dv = {}, normal = {};  ///< r, r_u, r_v, N
  Vector duu = {}, duv = {}, dvv = {};                  ///< r_uu, r_uv, r_vv
  Vector first_form = {};                               ///< E, F, G: r_u.r_u, r_u.r_v, r_v.r_v
  Vector second_form = {};                              ///< L, M, N: r_uu.N, r_uv.N, r_vv.N
  Scalar gaussian = {}, mean = {};                      ///< K = k1 k2, H = (k1 + k2) / 2
  Scalar first_curvature = {}, second_curvature = {};   ///< k1 >= k2
  Vector first_direction = {}, second_direction = {};   ///< unit tangents of k1 and k2, first x second = N
  NormalKinds normal_kind = {};                         ///< regular, a limit, or undefined
  CurvatureKinds curvature_kind = {};                   ///< distinct, umbilic, or undefined
};

/// A set of quantities, as `{.position = true, .normal = true}`.
using QuantityFlags = Quantities<bool>;

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
