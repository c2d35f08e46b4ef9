// The pieces of patches in the library's own tree.

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "kernel/table/kernel_table.h"
#include "ray/tree/box_nodes.h"
#include "ray/tree/own_trees.h"
#include "ray/tree/tree_walk.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class OwnLeaves final : public LeafTree {
 public:
  explicit OwnLeaves(const kernel::RayKernels& kernels) { tracer_.kernels = &kernels; }

  Status build(const TracedLeaves& leaves, bool /*follows*/, const Execution& execution) override {
    static_cast<TracedLeaves&>(tracer_) = leaves;
    return nodes_.build(
        leaves.primitives(), [this](std::size_t leaf) { return box_of(static_cast<unsigned>(leaf)); }, execution);
  }
  Status refit(double tolerance, const Execution& /*execution*/) override {
    tracer_.tolerance = tolerance;
    nodes_.refit([this](std::size_t leaf) { return box_of(static_cast<unsigned>(leaf)); });
    return {};
  }

  void trace(RayQuery& query, SearchSpace& space) const override {
    kernel::TreeWalk walk;
    start_walk(query.line, nodes_, walk);
    kernel::RayProbe probe = probe_of(query);
    for (;;) {
      const std::uint32_t leaf = tracer_.kernels->next_leaf(nodes_.nodes(), walk);
      if (leaf == kernel::TreeNode::none) return;
      tracer_.search(leaf, probe, query, space);
      if (query.done()) return;
      walk.far = std::min(walk.far, far_of_walk(query.far));
    }
  }
  void trace(std::span<RayQuery* const> queries, SearchSpace& space) const override;

  const LeafTracer& tracer() const override { return tracer_; }
  std::size_t memory_bytes() const override { return nodes_.memory_bytes(); }

 private:
  Box3 box_of(unsigned leaf) const {
    if (leaf >= tracer_.first_tube) return tracer_.tubes->box(leaf - tracer_.first_tube);
    return tracer_.use_of(leaf) == PatchUse::out ? Box3() : tracer_.nets->boxes()[leaf];
  }

  LeafTracer tracer_;
  BoxNodes nodes_;
};

void OwnLeaves::trace(std::span<RayQuery* const> queries, SearchSpace& space) const {
  const kernel::RayPacketKernels* const kernels = tracer_.kernels->packets;
  if (kernels == nullptr) {
    for (RayQuery* query : queries) trace(*query, space);
    return;
  }
  QueryPacket traced;
  for (std::size_t k = 0; k < LeafTree::packet; ++k)
    k < queries.size() ? traced.set(k, *queries[k]) : traced.set_idle(k);
  kernel::TreePacket walk;
  start_walk(
      queries.size(), [&](std::size_t k) -> const RayLine& { return queries[k]->line; }, nodes_, walk);
  std::uint32_t leaf = 0;
  while (unsigned lanes = kernels->next_packet_leaf(nodes_.nodes(), walk, leaf)) {
    if ((lanes & (lanes - 1)) == 0) {
      const auto ray = static_cast<std::size_t>(std::countr_zero(lanes));
      tracer_.search(leaf, traced.probes[ray], *queries[ray], space);
    } else {
      tracer_.search(leaf, traced, lanes, space);
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto ray = static_cast<std::size_t>(std::countr_zero(lanes));
      const RayQuery& query = *queries[ray];
      walk.far[ray] =
          query.done() ? -std::numeric_limits<float>::infinity() : std::min(walk.far[ray], far_of_walk(query.far));
    }
  }
}

}  // namespace

Result<std::unique_ptr<LeafTree>> make_own_leaves(Isa isa) {
  return std::unique_ptr<LeafTree>(std::make_unique<OwnLeaves>(ray_kernels(isa)));
}

}}  // namespace tessera::abi_0_1
