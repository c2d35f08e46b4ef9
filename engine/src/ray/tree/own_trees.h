#pragma once
// The library's own trees.

#include <memory>

#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {

Result<std::unique_ptr<LeafTree>> make_own_leaves(Isa isa);
Result<std::unique_ptr<InstanceTree>> make_own_instances(const kernel::RayKernels& kernels);
Result<std::unique_ptr<FacetTree>> make_own_facets(Isa isa);

}}  // namespace tessera::abi_0_1
