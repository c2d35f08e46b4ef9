#pragma once
// Gives the grid kernel what it needs to tell regular normals from limits: the collapsed sides of each lane, and a
// function for exact normals.

#include <array>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "eval/grid_plan_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// Serves one block after the other. Lives on a task's stack; allocates nothing.
template <class T>
class BlockNormals {
 public:
  BlockNormals(const PatchSet::Impl& set, const GridPlan::Impl& plan) : set_(set), plan_(plan) {}

  /// Fills in what the jobs of all blocks share. They must not outlive this object.
  void begin(kernel::GridJob<T>& job) {
    job.u_edges = plan_.u_edges.data();
    job.v_edges = plan_.v_edges.data();
    job.exact_normal = exact_normal;
    job.exact_context = this;
    const double min_sine = sizeof(T) == 4 ? 1e-6 : 0, smallest_tolerance = sizeof(T) == 4 ? 1e-4 : 0;
    job.min_sine = static_cast<T>(std::max(plan_.options.geometry.min_sine, min_sine));
    job.umbilic_tolerance = static_cast<T>(std::max(plan_.options.geometry.umbilic_tolerance, smallest_tolerance));
  }
  /// Completes the job for a block. It holds until the next call.
  void prepare(std::size_t block, kernel::GridJob<T>& job) {
    prepare(set_.lane_patches.data() + block * PatchSet::lanes,
            set_.coefficients<T>().threshold_of(plan_.options.representation).data() + block * 2 * PatchSet::lanes,
            job);
    if (!plan_.by_patch) return;
    job.u_edges = plan_.u_edges.data() + block * PatchSet::lanes * plan_.count_u;
    job.v_edges = plan_.v_edges.data() + block * PatchSet::lanes * plan_.count_v;
  }
  /// Completes the job for 16 patches of several blocks, of a plan whose parameters are the same for all patches.
  /// `thresholds`: `[threshold, noise][lane]`.
  void prepare(const std::uint32_t* lane_patches, const T* thresholds, kernel::GridJob<T>& job) {
    lane_patches_ = lane_patches;
    job.threshold = thresholds;
    job.noise = thresholds + PatchSet::lanes;
    job.collapsed = find_collapsed() ? collapsed_.data() : nullptr;
  }

 private:
  static constexpr std::size_t lanes = PatchSet::lanes;

  /// Fills the edges' lanes. Whether any patch of the block has a collapsed edge that the grid meets.
  bool find_collapsed() {
    SideMask any;
    for (std::size_t lane = 0; lane < lanes; ++lane) any.bits |= set_.collapsed[lane_patches_[lane]].bits;
    if ((any.bits & plan_.edges.bits) == 0) return false;
    constexpr std::array edges{Side::u0, Side::u1, Side::v0, Side::v1};
    for (std::size_t edge = 0; edge < edges.size(); ++edge)
      for (std::size_t lane = 0; lane < lanes; ++lane)
        collapsed_[edge * lanes + lane] = set_.collapsed[lane_patches_[lane]].has(edges[edge]) ? T(1) : T(0);
    return true;
  }

  /// See kernel::ExactNormal. Unused lanes repeat a patch and ask for the same point again.
  static int exact_normal(void* context, int iu, int iv, int lane, T* normal) {
    auto& self = *static_cast<BlockNormals*>(context);
    const std::uint32_t patch = self.lane_patches_[lane];
    if (patch != self.patch_ || iu != self.iu_ || iv != self.iv_)
      self.last_ = unit_normal(self.set_.patches[patch], self.plan_.u_at(patch, static_cast<std::size_t>(iu)),
                               self.plan_.v_at(patch, static_cast<std::size_t>(iv)));
    self.patch_ = patch;
    self.iu_ = iu;
    self.iv_ = iv;
    normal[0] = static_cast<T>(self.last_.direction.x);
    normal[1] = static_cast<T>(self.last_.direction.y);
    normal[2] = static_cast<T>(self.last_.direction.z);
    return static_cast<int>(self.last_.kind);
  }

  const PatchSet::Impl& set_;
  const GridPlan::Impl& plan_;
  const std::uint32_t* lane_patches_ = nullptr;
  std::uint32_t patch_ = 0;  ///< the patch of the last exact normal
  int iu_ = -1, iv_ = -1;
  UnitNormal last_;
  alignas(cache_line) std::array<T, 4 * lanes> collapsed_{};
};

}}  // namespace tessera::abi_0_1
