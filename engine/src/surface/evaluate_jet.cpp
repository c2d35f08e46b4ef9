#include "surface/difference_net.h"
#include "tessera/bezier_patch.h"

namespace tessera {

// With A the homogeneous numerator and w the denominator, r = A / w, and the derivatives of A = w r give
//   r_u = (A_u - w_u r) / w,  r_uu = (A_uu - 2 w_u r_u - w_uu r) / w,  r_uv = (A_uv - w_u r_v - w_v r_u - w_uv r) / w
// (Piegl and Tiller, The NURBS Book, eq. 4.20). Polynomial patches have w = 1, and derivatives of it vanish.
SurfaceJet evaluate_jet(const BezierPatch& patch, double u, double v) {
  const HomogeneousNet net(patch, nearest_corner(patch, u, v));
  const LoweredBernstein bu(patch.degree_u(), u), bv(patch.degree_v(), v);
  const Homogeneous a = derivative<0, 0>(net, bu, bv);
  const Homogeneous au = derivative<1, 0>(net, bu, bv), av = derivative<0, 1>(net, bu, bv);
  const Homogeneous auu = derivative<2, 0>(net, bu, bv), auv = derivative<1, 1>(net, bu, bv);
  const Homogeneous avv = derivative<0, 2>(net, bu, bv);

  SurfaceJet jet{a.vector(), au.vector(), av.vector(), auu.vector(), auv.vector(), avv.vector()};
  if (patch.is_rational()) {
    const double reciprocal = 1 / a.w;
    const Vec3 r = a.project();
    const Vec3 ru = reciprocal * (au.vector() - au.w * r), rv = reciprocal * (av.vector() - av.w * r);
    jet = {r,
           ru,
           rv,
           reciprocal * (auu.vector() - 2 * au.w * ru - auu.w * r),
           reciprocal * (auv.vector() - au.w * rv - av.w * ru - auv.w * r),
           reciprocal * (avv.vector() - 2 * av.w * rv - avv.w * r)};
  }
  return {net.absolute(jet.position), net.scale * jet.du,  net.scale * jet.dv,
          net.scale * jet.duu,        net.scale * jet.duv, net.scale * jet.dvv};
}

}  // namespace tessera
