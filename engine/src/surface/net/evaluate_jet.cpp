#include "surface/net/difference_net.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

SurfaceJet evaluate_jet(const BezierPatch& patch, double u, double v) {
  const HomogeneousNet net(patch, nearest_corner(patch, u, v));
  const LoweredBernstein bu(patch.degree_u(), u), bv(patch.degree_v(), v);
  const Homogeneous a = derivative<0, 0>(net, bu, bv);
  const Homogeneous au = derivative<1, 0>(net, bu, bv), av = derivative<0, 1>(net, bu, bv);
  const Homogeneous auu = derivative<2, 0>(net, bu, bv), auv = derivative<1, 1>(net, bu, bv);
  const Homogeneous avv = derivative<0, 2>(net, bu, bv);

  SurfaceJet jet{a.vector(), au.vector(), av.vector(), auu.vector(), auv.vector(), avv.vector()};
  if (patch.is_rational()) jet = project(a, au, av, auu, auv, avv);
  return {net.absolute(jet.position), net.scale * jet.du,  net.scale * jet.dv,
          net.scale * jet.duu,        net.scale * jet.duv, net.scale * jet.dvv};
}

}}  // namespace tessera::abi_0_1
