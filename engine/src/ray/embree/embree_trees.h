#pragma once
// The trees of Embree. Its types stay in the sources.

#include <memory>

#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {

// Errors: internal and out_of_memory, from Embree.
Result<std::unique_ptr<LeafTree>> make_embree_leaves(Isa isa);
Result<std::unique_ptr<InstanceTree>> make_embree_instances(const kernel::RayKernels& kernels);
Result<std::unique_ptr<FacetTree>> make_embree_facets(Isa isa);

}}  // namespace tessera::abi_0_1
