#include "ray/tree/own_trees.h"

namespace tessera { inline namespace abi_0_1 {

const RayTrees& own_ray_trees() {
  static constexpr RayTrees trees{make_own_leaves, make_own_instances, make_own_facets};
  return trees;
}

}}  // namespace tessera::abi_0_1
