// The boxes of instances in the library's own tree.

#include <algorithm>
#include <bit>
#include <utility>

#include "ray/tree/box_nodes.h"
#include "ray/tree/own_trees.h"
#include "ray/tree/tree_walk.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class OwnInstances final : public InstanceTree {
 public:
  explicit OwnInstances(const kernel::RayKernels& kernels) : kernels_(kernels) {}

  Status build(std::vector<Box3> boxes, const Execution& execution) override {
    return nodes_.build(
        boxes.size(), [&](std::size_t k) { return boxes[k]; }, execution);
  }
  void visit(std::span<const RayLine* const> lines, Visit visit) const override {
    if (lines.size() == 1 || kernels_.packets == nullptr) {
      for (std::size_t k = 0; k < lines.size(); ++k) visit_alone(*lines[k], k, visit);
    } else {
      visit_together(lines, visit);
    }
  }
  std::size_t memory_bytes() const override { return nodes_.memory_bytes(); }

 private:
  void visit_alone(const RayLine& line, std::size_t lane, Visit visit) const {
    kernel::TreeWalk walk;
    start_walk(line, nodes_, walk);
    std::array<double, packet> ends;
    for (;;) {
      const std::uint32_t box = kernels_.next_leaf(nodes_.nodes(), walk);
      if (box == kernel::TreeNode::none) return;
      visit(box, 1u << lane, ends);
      walk.far = std::min(walk.far, far_of_walk(ends[lane]));
    }
  }
  void visit_together(std::span<const RayLine* const> lines, Visit visit) const {
    kernel::TreePacket walk;
    start_walk(
        lines.size(), [&](std::size_t k) -> const RayLine& { return *lines[k]; }, nodes_, walk);
    std::array<double, packet> ends;
    std::uint32_t box = 0;
    while (unsigned lanes = kernels_.packets->next_packet_leaf(nodes_.nodes(), walk, box)) {
      visit(box, lanes, ends);
      for (; lanes != 0; lanes &= lanes - 1) {
        const auto ray = static_cast<std::size_t>(std::countr_zero(lanes));
        walk.far[ray] = std::min(walk.far[ray], far_of_walk(ends[ray]));
      }
    }
  }

  const kernel::RayKernels& kernels_;
  BoxNodes nodes_;
};

}  // namespace

Result<std::unique_ptr<InstanceTree>> make_own_instances(const kernel::RayKernels& kernels) {
  return std::unique_ptr<InstanceTree>(std::make_unique<OwnInstances>(kernels));
}

}}  // namespace tessera::abi_0_1
