// Scenes of a build with Embree are made of its trees.

#include "ray/embree/embree_trees.h"

namespace tessera { inline namespace abi_0_1 {

const RayTrees& preferred_ray_trees() {
  static constexpr RayTrees trees{make_embree_leaves, make_embree_instances, make_embree_facets};
  return trees;
}

}}  // namespace tessera::abi_0_1
