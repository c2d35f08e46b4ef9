// Scenes of a build without Embree are made of the library's own trees.

#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {

const RayTrees& preferred_ray_trees() { return own_ray_trees(); }

}}  // namespace tessera::abi_0_1
