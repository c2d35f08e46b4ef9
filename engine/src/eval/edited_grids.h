#pragma once
// A task's share of an update: patches are packed, then evaluated while they are in its cache.

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/aligned.h"
#include "eval/block_jobs.h"
#include "eval/block_outputs.h"
#include "eval/grid_calls.h"
#include "eval/patch_edits.h"
#include "eval/run_grid.h"
#include "eval/staged_block.h"
#include "eval/touched_blocks.h"

namespace tessera { inline namespace abi_0_1 {

/// Data that all tasks of an update share.
struct UpdateCall {
  PatchSet::Impl& set;
  const GridPlan::Impl& plan;
  const kernel::KernelTable& kernels;
  const PatchEdits& edits;
  const TouchedBlocks& touched;
  int order;  ///< the highest order of the derivatives that the outputs need
  bool streaming;

  /// Whether all patches of a block are edited.
  bool is_whole(std::uint32_t block) const { return touched.count(block) == set.lane_counts[block]; }
};

/// Packs and evaluates block after block into block-interleaved memory. A touched block is evaluated whole: lanes of
/// patches without edits get the same values again. Lives on a task's stack; allocates nothing.
template <class T>
class EditedBlocks {
 public:
  EditedBlocks(const UpdateCall& call, const BlockOutputs<T>& out)
      : call_(call), out_(out), jobs_(call.set, call.plan, call.order) {
    jobs_.job().streaming = call.streaming;
  }

  void add(std::uint32_t block) {
    pack_edits(call_.set, call_.edits, call_.touched, call_.kernels, block);
    jobs_.turn_to(block);
    out_.place(block * call_.plan.samples() * PatchSet::lanes, jobs_.job());
    isa_ = run_grid(call_.kernels, jobs_.job());
  }
  /// Returns the instruction set that ran last.
  Isa finish() {
    if (call_.streaming) call_.kernels.finish_streaming();
    return isa_;
  }

 private:
  const UpdateCall& call_;
  const BlockOutputs<T>& out_;
  BlockJobs<T> jobs_;
  Isa isa_ = Isa::sse2;
};

/// Packs and evaluates block after block into patch-contiguous views. A block whose patches are all edited is evaluated
/// in place. The edited patches of other blocks are gathered, 16 at a time, so that no lane is idle. Lives on a task's
/// stack; allocates nothing.
template <class T>
class EditedGrids {
 public:
  EditedGrids(const UpdateCall& call, const StageLayout<T>& layout, const QuantityViews<T>& out)
      : call_(call), stage_(call.kernels, layout, out, call.streaming), jobs_(call.set, call.plan, call.order) {
    stage_.place_outputs(jobs_.job());
  }

  void add(std::uint32_t block) {
    pack_edits(call_.set, call_.edits, call_.touched, call_.kernels, block);
    if (call_.is_whole(block)) {
      add_whole(block);
    } else {
      add_lanes(block);
    }
  }
  /// Evaluates the gathered patches. Returns the instruction set that ran last.
  Isa finish() {
    flush();
    if (call_.streaming) call_.kernels.finish_streaming();
    return isa_;
  }

 private:
  static constexpr std::size_t lanes = PatchSet::lanes;
  static constexpr std::size_t max_coefficients = (max_degree + 1) * (max_degree + 1) * 4;

  void add_whole(std::uint32_t block) {
    jobs_.turn_to(block);
    evaluate(call_.set.lane_patches.data() + block * lanes, call_.set.lane_counts[block]);
  }

  void add_lanes(std::uint32_t block) {
    const BlockGroup& group = call_.set.group_of_block(block);
    if (gathered_ > 0 && &group != &call_.set.group_of_block(block_)) flush();
    block_ = block;
    const std::uint32_t* edits = call_.touched.edits(block);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (edits[lane] == no_id) continue;
      const std::uint32_t patch = call_.set.lane_patches[block * lanes + lane];
      gather(group, lane);
      patches_[gathered_++] = patch;
      if (gathered_ == lanes) flush();
    }
  }

  /// Copies a lane of block_ into the next lane of the net.
  void gather(const BlockGroup& group, std::size_t lane) {
    const Coefficients<T>& all = call_.set.template coefficients<T>();
    const Representation representation = call_.plan.options.representation;
    const T* from =
        all.of(representation).data() + group.first_value + (block_ - group.first_block) * group.block_values + lane;
    for (std::size_t k = 0; k < group.block_values; k += lanes) net_[k + gathered_] = from[k];
    const T* thresholds = all.threshold_of(representation).data() + block_ * 2 * lanes + lane;
    thresholds_[gathered_] = thresholds[0];
    thresholds_[lanes + gathered_] = thresholds[lanes];
  }

  void flush() {
    if (gathered_ == 0) return;
    const BlockGroup& group = call_.set.group_of_block(block_);
    const auto repeat_first = [&](auto* row) { std::fill(row + gathered_, row + lanes, row[0]); };
    for (std::size_t k = 0; k < group.block_values; k += lanes) repeat_first(net_.data() + k);
    repeat_first(thresholds_.data());
    repeat_first(thresholds_.data() + lanes);
    repeat_first(patches_.data());
    jobs_.turn_to(group, net_.data(), patches_.data(), thresholds_.data());
    evaluate(patches_.data(), static_cast<int>(gathered_));
    gathered_ = 0;
  }

  void evaluate(const std::uint32_t* patches, int count) {
    const GridPlan::Impl& plan = call_.plan;
    isa_ = stage_.run(jobs_.job(), 0, static_cast<int>(plan.count_u), static_cast<int>(plan.count_v), patches, count,
                      plan.samples());
  }

  const UpdateCall& call_;
  StagedBlock<T> stage_;
  BlockJobs<T> jobs_;
  Isa isa_ = Isa::sse2;
  std::size_t gathered_ = 0;  ///< patches in the net
  std::uint32_t block_ = 0;   ///< the block of the last gathered patch
  std::array<std::uint32_t, lanes> patches_;
  alignas(cache_line) std::array<T, 2 * lanes> thresholds_;
  alignas(cache_line) std::array<T, max_coefficients * lanes> net_;
};

}}  // namespace tessera::abi_0_1
