#pragma once
// One ray through a tree of boxes, lanes = children.
//
// Needs before it, outside of the instruction set's namespace: <bit>, kernel/isa/four_floats.h,
// kernel/ray/tree_kernels.h.

/// Sorts the last `count` of a stack so that the nearest comes last.
template <class Waiting>
void sort_last(Waiting* last, int count) {
  for (int k = 1; k < count; ++k) {
    const Waiting moved = last[k];
    int place = k;
    for (; place > 0 && last[place - 1].enter < moved.enter; --place) last[place] = last[place - 1];
    last[place] = moved;
  }
}

std::uint32_t next_leaf(const TreeNode* nodes, TreeWalk& walk) {
  Four origin[3], inverse[3];
  int first[3];
  for (int c = 0; c < 3; ++c) {
    origin[c] = Fours::all(walk.origin[c]), inverse[c] = Fours::all(walk.inverse[c]);
    first[c] = walk.inverse[c] < 0 ? 1 : 0;
  }
  const Four begin = Fours::all(walk.near), end = Fours::all(walk.far);
  while (walk.waiting > 0) {
    const TreeWalk::Waiting& next = walk.stack[--walk.waiting];
    if (!(next.enter <= walk.far)) continue;
    for (std::uint32_t at = next.child;;) {
      if ((at & TreeNode::leaf_bit) != 0) return at & ~TreeNode::leaf_bit;
      const TreeNode& node = nodes[at];
      Four enter = begin, leave = end;
      for (int c = 0; c < 3; ++c) {
        enter = Fours::max(enter, (Fours::load(node.side[first[c]][c]) - origin[c]) * inverse[c]);
        leave = Fours::min(leave, (Fours::load(node.side[1 - first[c]][c]) - origin[c]) * inverse[c]);
      }
      unsigned met = Fours::at_most(enter, leave);
      if (met == 0) break;
      at = node.child[std::countr_zero(met)];
      if ((met & (met - 1)) == 0) continue;
      float enters[TreeNode::size];
      Fours::store(enters, enter);
      TreeWalk::Waiting* const added = walk.stack + walk.waiting;
      int count = 0;
      for (; met != 0; met &= met - 1) {
        const int k = std::countr_zero(met);
        added[count++] = {node.child[k], enters[k]};
      }
      sort_last(added, count);
      at = added[--count].child;
      walk.waiting += count;
    }
  }
  return TreeNode::none;
}
