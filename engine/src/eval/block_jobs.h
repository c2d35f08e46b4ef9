#pragma once
// The grid kernel's job, block after block.

#include "eval/block_normals.h"
#include "eval/grid_plan_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// One job that serves block after block: turn_to() sets only the members that differ between blocks, because setting
/// all of them takes as long as a small grid. The caller sets the outputs; turn_to() does not change them. Lives on a
/// task's stack; allocates nothing.
template <class T>
class BlockJobs {
 public:
  /// `order`: the highest order of the derivatives that the outputs need.
  BlockJobs(const PatchSet::Impl& set, const GridPlan::Impl& plan, int order)
      : set_(set), plan_(plan), has_normals_(order > 0), normals_(set, plan) {
    job_.by_lane = plan.by_patch;
    job_.u_end = static_cast<int>(plan.count_u);
    job_.v_end = static_cast<int>(plan.count_v);
    if constexpr (sizeof(T) == 8) {
      job_.offset[0] = set.origin.x;
      job_.offset[1] = set.origin.y;
      job_.offset[2] = set.origin.z;
    }
    if (has_normals_) normals_.begin(job_);
  }
  BlockJobs(const BlockJobs&) = delete;
  BlockJobs& operator=(const BlockJobs&) = delete;

  kernel::GridJob<T>& job() { return job_; }

  /// Makes the job that of a block.
  void turn_to(std::size_t block) {
    if (group_ == nullptr || block - group_->first_block >= group_->block_count) set_group(set_.group_of_block(block));
    job_.net = net_ + (block - group_->first_block) * group_->block_values;
    if (plan_.by_patch) {
      job_.u_weights = plan_.weights<T>().u_lanes.of(block);
      job_.v_weights = plan_.weights<T>().v_lanes.of(block);
    }
    if (has_normals_) normals_.prepare(block, job_);
  }
  /// Makes the job that of 16 patches of a group that are gathered from several blocks; see BlockNormals::prepare.
  void turn_to(const BlockGroup& group, const T* net, const std::uint32_t* lane_patches, const T* thresholds) {
    set_group(group);
    job_.net = net;
    if (has_normals_) normals_.prepare(lane_patches, thresholds, job_);
  }

 private:
  void set_group(const BlockGroup& group) {
    group_ = &group;
    net_ = set_.coefficients<T>().of(plan_.options.representation).data() + group.first_value;
    job_.degree_u = group.degree_u;
    job_.degree_v = group.degree_v;
    job_.rational = group.rational;
    const std::size_t lines = group.block_values * sizeof(T) / cache_line;
    job_.prefetched_lines = static_cast<int>((lines + plan_.count_u - 1) / plan_.count_u);
    if (plan_.by_patch) return;
    job_.u_weights = plan_.weights<T>().u[static_cast<std::size_t>(group.degree_u)].data();
    job_.v_weights = plan_.weights<T>().v[static_cast<std::size_t>(group.degree_v)].data();
  }

  const PatchSet::Impl& set_;
  const GridPlan::Impl& plan_;
  bool has_normals_;
  const BlockGroup* group_ = nullptr;
  const T* net_ = nullptr;  ///< coefficients of the group's first block
  BlockNormals<T> normals_;
  kernel::GridJob<T> job_;
};

}}  // namespace tessera::abi_0_1
