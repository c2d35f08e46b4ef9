#include "ray/tree/ray_trees.h"

#include <atomic>

namespace tessera { inline namespace abi_0_1 {
namespace {

std::atomic<const RayTrees*> chosen_trees = nullptr;

}  // namespace

const RayTrees& ray_trees() {
  const RayTrees* const chosen = chosen_trees;
  return chosen == nullptr ? preferred_ray_trees() : *chosen;
}

void use_ray_trees(const RayTrees* trees) { chosen_trees = trees; }

}}  // namespace tessera::abi_0_1
