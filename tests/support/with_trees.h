#pragma once
// Scenes over trees of Embree's or of the library's own.

#include "ray/tree/ray_trees.h"

namespace tessera::test {

/// Makes scenes of some trees until the end of its scope.
class WithTrees {
 public:
  explicit WithTrees(const RayTrees& trees) : before_(ray_trees()) { use_ray_trees(&trees); }
  ~WithTrees() { use_ray_trees(&before_); }
  WithTrees(const WithTrees&) = delete;
  WithTrees& operator=(const WithTrees&) = delete;

 private:
  const RayTrees& before_;
};

}  // namespace tessera::test
