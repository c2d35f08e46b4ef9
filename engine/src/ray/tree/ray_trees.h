#pragma once
// The trees that ray scenes are made of: those of Embree, or the library's own. Scenes give the same hits with either.

#include <memory>

#include "ray/tree/facet_tree.h"
#include "ray/tree/instance_tree.h"
#include "ray/tree/leaf_tree.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes trees that are not yet built. Errors: internal and out_of_memory, from Embree.
struct RayTrees {
  /// `isa`: of this machine.
  Result<std::unique_ptr<LeafTree>> (*leaves)(Isa isa);
  Result<std::unique_ptr<InstanceTree>> (*instances)(const kernel::RayKernels& kernels);
  Result<std::unique_ptr<FacetTree>> (*facets)(Isa isa);
};

/// The library's own, in every build.
const RayTrees& own_ray_trees();

/// The trees that this build prefers: Embree's (ray/embree/preferred_trees_embree.cpp), or without Embree its own
/// (ray/tree/preferred_trees_own.cpp).
const RayTrees& preferred_ray_trees();

/// The trees that scenes are made with from now on.
const RayTrees& ray_trees();
/// Chooses these, for all threads; null: the preferred ones. For tests and benchmarks. `trees` must outlive all calls.
void use_ray_trees(const RayTrees* trees);

}}  // namespace tessera::abi_0_1
