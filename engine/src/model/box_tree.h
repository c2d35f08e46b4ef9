#pragma once
// Finds the boxes that touch any of a set of boxes.

#include <cstdint>
#include <span>
#include <vector>

#include "base/internal_export.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns a box that is larger to all sides. Of an empty one, an empty one.
inline Box3 grown(const Box3& box, double by) { return {box.lower - Vec3{by, by, by}, box.upper + Vec3{by, by, by}}; }

/// Whether two boxes have a point in common. Boxes without a point, which are all infinite, have none.
inline bool meet(const Box3& a, const Box3& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
         a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// Whether a box, grown by `reach` to all sides, has a point in common with another. Empty boxes have none.
TESSERA_INTERNAL_EXPORT bool are_near(const Box3& a, const Box3& b, double reach);

/// A tree over boxes. Empty boxes touch nothing. Memory: 112 bytes per box.
class BoxTree {
 public:
  TESSERA_INTERNAL_EXPORT explicit BoxTree(std::span<const Box3> boxes);
  /// Whether a box, grown by `reach` to all sides, has a point in common with one of the tree's.
  TESSERA_INTERNAL_EXPORT bool touches(const Box3& box, double reach) const;

 private:
  /// A node's first child follows it; `skip` is the node behind its last one.
  struct Node {
    Box3 box;
    std::size_t skip = 0;
  };
  void add(std::span<const Box3> boxes, std::span<std::uint32_t> order);

  std::vector<Node> nodes_;  ///< in depth-first order; the leaves are boxes
};

/// Returns a tree of the boxes that come near others. It touches the same of these as a tree of all boxes.
TESSERA_INTERNAL_EXPORT BoxTree tree_towards(std::span<const Box3> others, std::span<const Box3> boxes, double reach);

}}  // namespace tessera::abi_0_1
