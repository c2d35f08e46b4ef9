#pragma once
// A packet of rays through a tree of boxes, lanes = rays.
//
// Needs before it, outside of the instruction set's namespace: <bit>, <limits>, kernel/isa/four_floats.h,
// kernel/ray/tree_kernels.h.

#include "kernel/ray/tree_kernel.inl.h"

/// Returns the bits of the lanes where a <= b.
unsigned lanes_at_most(const float* a, const float* b) {
  unsigned lanes = 0;
  for (int k = 0; k < TreePacket::size; k += 4) lanes |= Fours::at_most(Fours::load(a + k), Fours::load(b + k)) << k;
  return lanes;
}

/// Tests the box of a child for all rays.
TreePacket::Waiting meet_child(const TreeNode& node, int k, const TreePacket& packet) {
  if (!(node.side[0][0][k] <= node.side[1][0][k])) return {node.child[k], 0, 0};  // empty
  using L = Lanes<float>;
  using Batch = L::Batch;
  alignas(64) float enters[TreePacket::size], leaves[TreePacket::size];
  for (int lane = 0; lane < TreePacket::size; lane += L::width) {
    Batch enter = L::load(packet.near + lane), leave = L::load(packet.far + lane);
    for (int c = 0; c < 3; ++c) {
      const Batch origin = L::load(packet.origin[c] + lane), inverse = L::load(packet.inverse[c] + lane);
      const Batch a = (Batch(node.side[0][c][k]) - origin) * inverse,
                  b = (Batch(node.side[1][c][k]) - origin) * inverse;
      enter = xsimd::max(enter, xsimd::min(a, b));
      leave = xsimd::min(leave, xsimd::max(a, b));
    }
    L::store(enters + lane, xsimd::select(enter <= leave, enter, Batch(std::numeric_limits<float>::infinity())));
    L::store(leaves + lane, leave);
  }
  const Four least = Fours::min(Fours::min(Fours::load(enters), Fours::load(enters + 4)),
                                Fours::min(Fours::load(enters + 8), Fours::load(enters + 12)));
  const unsigned lanes = lanes_at_most(enters, leaves);
  float four[4];
  Fours::store(four, least);
  const float low = four[0] < four[1] ? four[0] : four[1], high = four[2] < four[3] ? four[2] : four[3];
  return {node.child[k], lanes, low < high ? low : high};
}

unsigned next_packet_leaf(const TreeNode* nodes, TreePacket& packet, std::uint32_t& leaf) {
  while (packet.waiting > 0) {
    TreePacket::Waiting at = packet.stack[--packet.waiting];
    alignas(64) float enters[TreePacket::size];
    for (float& enter : enters) enter = at.enter;
    at.lanes &= lanes_at_most(enters, packet.far);
    while (at.lanes != 0) {
      if ((at.child & TreeNode::leaf_bit) != 0) {
        leaf = at.child & ~TreeNode::leaf_bit;
        return at.lanes;
      }
      const TreeNode& node = nodes[at.child];
      TreePacket::Waiting* const added = packet.stack + packet.waiting;
      int count = 0;
      for (int k = 0; k < TreeNode::size && node.child[k] != TreeNode::none; ++k) {
        added[count] = meet_child(node, k, packet);
        added[count].lanes &= at.lanes;
        if (added[count].lanes != 0) ++count;
      }
      if (count == 0) break;
      sort_last(added, count);
      at = added[--count];
      packet.waiting += count;
    }
  }
  return 0;
}
