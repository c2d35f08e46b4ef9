#pragma once
// Nodes of trees of boxes, and the walks of rays through them from near to far.

#include <cstdint>

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// A node with up to four children, whose boxes are padded so that rays in float find them. A place without a child has
/// a box that no ray meets: from infinity to minus infinity.
struct alignas(64) TreeNode {
  static constexpr int size = 4;
  static constexpr std::uint32_t leaf_bit = 0x80000000;  ///< in a child that is a leaf; the other bits are its index
  static constexpr std::uint32_t none = 0xffffffff;
  /// The levels of a tree, at most.
  static constexpr int max_levels = 64;

  float side[2][3][size];     ///< lower and upper, by axis
  std::uint32_t child[size];  ///< a node behind this one, or a leaf, or `none`; those with a child come first
};

/// The children that a walk has put off: at most three from each level, and those of the node that it is at.
inline constexpr int tree_walk_room = 3 * TreeNode::max_levels + TreeNode::size;

/// The walk of one ray: the points origin + s direction with s in [near, far]. The caller lowers `far` on the way.
struct TreeWalk {
  struct Waiting {
    std::uint32_t child;
    float enter;  ///< the least s in its box
  };
  float origin[3], inverse[3];  ///< inverse: of the direction, finite
  float near, far;
  int waiting = 0;  ///< number of them
  Waiting stack[tree_walk_room];
};

/// The walk of a packet of rays, lanes = rays. The far end of an idle lane is minus infinity.
struct alignas(64) TreePacket {
  static constexpr int size = 16;
  struct Waiting {
    std::uint32_t child;
    unsigned lanes;  ///< bits of the rays that meet its box
    float enter;     ///< the least s of all these
  };
  float origin[3][size], inverse[3][size];
  float near[size], far[size];
  int waiting = 0;
  Waiting stack[tree_walk_room];
};

}}}  // namespace tessera::abi_0_1::kernel
