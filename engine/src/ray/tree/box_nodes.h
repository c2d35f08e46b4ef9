#pragma once
// The library's own tree of boxes for rays.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/function_ref.h"
#include "kernel/ray/ray_kernels.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Nodes of four children, each leaf one box. Parts are divided by the surface area heuristic over bins of their
/// middles (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, RT 2007). The tree depends on the
/// boxes alone, and not on threads. Memory: about 60 bytes per box, and as much again during a build.
class BoxNodes {
 public:
  static constexpr std::size_t max_boxes = 0x7ffffffe;
  using BoxOf = FunctionRef<Box3(std::size_t)>;

  /// Builds the tree of boxes 0 to count - 1, and drops the one built before. A box that is empty or has NaN is left
  /// out; sides beyond those of a scene, [-4, 4], are taken as there. On errors the tree is empty. Errors: unsupported
  /// (more than max_boxes), cancelled, out_of_memory.
  Status build(std::size_t count, BoxOf box_of, const Execution& execution);
  /// Sets the boxes anew. Those that were left out stay so; one that is empty now is met by no ray.
  void refit(BoxOf box_of);

  bool empty() const { return nodes_.empty(); }
  const kernel::TreeNode* nodes() const { return nodes_.data(); }
  std::size_t memory_bytes() const { return nodes_.capacity() * sizeof(kernel::TreeNode); }

 private:
  std::vector<kernel::TreeNode> nodes_;  // parents before their children
};

}}  // namespace tessera::abi_0_1
