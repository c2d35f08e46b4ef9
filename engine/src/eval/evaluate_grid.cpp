// Blocks and grids over threads. Two ways out of the kernels: block-interleaved memory, which they write themselves,
// and patch-contiguous views, through a stage that stays in the first-level cache and is transposed from there.

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "base/guard.h"
#include "block/patch_set_impl.h"
#include "eval/grid_plan_impl.h"
#include "eval/pole_normals.h"
#include "eval/staged_block.h"
#include "parallel/parallel_for.h"

namespace tessera {
namespace {

/// Points a task: enough to hide its cost, few enough to balance (kernels.md: 5,000 to 20,000).
constexpr std::size_t points_per_task = 16384;
/// Below these many points one thread is faster than waking another.
constexpr std::size_t serial_positions = 32768, serial_normals = 10240;

/// Bytes beyond which streaming stores win: a third of the last-level cache.
std::size_t streaming_threshold() {
  static const std::size_t bytes = [] {
    const long cache = sysconf(_SC_LEVEL3_CACHE_SIZE);
    return cache > 0 ? static_cast<std::size_t>(cache) / 3 : std::size_t{8} << 20;
  }();
  return bytes;
}

std::size_t blocks_per_task(const GridPlan::Impl& plan, bool derivatives) {
  const std::size_t points = plan.samples() * PatchSet::lanes;
  const std::size_t total = points * plan.block_count;
  if (total <= (derivatives ? serial_normals : serial_positions)) return plan.block_count;
  return std::max<std::size_t>(1, points_per_task / points);
}

template <class T>
Status check_plan(const PatchSet::Impl& set, const GridPlan& plan) {
  const bool twice = plan.precision() == Precision::double_precision;
  if (twice != (sizeof(T) == 8))
    return Status(StatusCode::invalid_argument, "the plan's precision is not that of the outputs");
  const auto& planned = plan.impl().groups;
  const auto& groups = set.groups;
  const bool same = plan.impl().patch_count == set.patches.size() &&
                    std::equal(planned.begin(), planned.end(), groups.begin(), groups.end(),
                               [](const PlannedGroup& a, const BlockGroup& b) {
                                 return a.degree_u == b.degree_u && a.degree_v == b.degree_v && a.rational == b.rational &&
                                        a.blocks == b.block_count;
                               });
  if (!same || !set.has(plan.precision(), plan.impl().options.representation))
    return Status(StatusCode::invalid_argument, "the plan was made for another patch set: counts, degrees or blocks differ");
  return {};
}

/// What every kernel call over one block has in common.
template <class T>
kernel::GridJob<T> block_job(const PatchSet::Impl& set, const GridPlan::Impl& plan, std::size_t block) {
  const BlockGroup& group = set.group_of_block(block);
  kernel::GridJob<T> job;
  job.net = set.coefficients<T>().of(plan.options.representation).data() + group.first_value +
            (block - group.first_block) * group.block_values;
  job.degree_u = group.degree_u;
  job.degree_v = group.degree_v;
  job.rational = group.rational;
  job.u_weights = plan.weights<T>().u[static_cast<std::size_t>(group.degree_u)].data();
  job.v_weights = plan.weights<T>().v[static_cast<std::size_t>(group.degree_v)].data();
  job.u_end = static_cast<int>(plan.u.size());
  job.v_end = static_cast<int>(plan.v.size());
  if constexpr (sizeof(T) == 8) {
    job.offset[0] = set.origin.x;
    job.offset[1] = set.origin.y;
    job.offset[2] = set.origin.z;
  }
  return job;
}

template <class T>
Isa run_grid(const kernel::KernelTable& kernels, const kernel::GridJob<T>& job) {
  if constexpr (sizeof(T) == 4) {
    return kernels.grid_f32(job);
  } else {
    return kernels.grid_f64(job);
  }
}

/// What the report says of the ISA comes from the kernel that ran; the plan's own value stands in for an empty run.
void report(const Execution& execution, Isa isa, bool streaming) {
  if (!execution.report) return;
  execution.report->isa = isa;
  execution.report->streaming = streaming;
}

// ---- block-interleaved outputs

template <class T>
Status check_blocks(const GridPlan& plan, const GridBlocks<T>& out) {
  const std::pair<const char*, std::span<T>> outputs[] = {
      {"position", out.position}, {"du", out.du}, {"dv", out.dv}, {"normal", out.normal}};
  bool any = false;
  for (const auto& [what, memory] : outputs) {
    if (memory.data() == nullptr) continue;
    any = true;
    if (memory.size() < plan.block_capacity())
      return Status(StatusCode::buffer_too_small, std::string(what) + " needs " + std::to_string(plan.block_capacity()) +
                                                      " values, not " + std::to_string(memory.size()));
    if (reinterpret_cast<std::uintptr_t>(memory.data()) % cache_line != 0)
      return Status(StatusCode::invalid_argument, std::string(what) + " must be aligned to 64 bytes");
  }
  if (!any) return Status(StatusCode::invalid_argument, "no output is wanted");
  return {};
}

template <class T>
void write_pole_normals(const PatchSet::Impl& set, const GridPlan::Impl& plan, std::size_t block, T* normals) {
  for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane) {
    const std::uint32_t patch = set.lane_patches[block * PatchSet::lanes + lane];
    for_each_pole_normal(plan, set.patches[patch], set.collapsed[patch], [&](std::size_t iu, std::size_t iv, const Vec3& normal) {
      T* record = normals + (iu * plan.v.size() + iv) * 3 * PatchSet::lanes + lane;
      record[0] = static_cast<T>(normal.x);
      record[PatchSet::lanes] = static_cast<T>(normal.y);
      record[2 * PatchSet::lanes] = static_cast<T>(normal.z);
    });
  }
}

template <class T>
Status evaluate_blocks(const PatchSet& set, const GridPlan& plan, const GridBlocks<T>& out, const Execution& execution) {
  if (Status status = check_plan<T>(set.impl(), plan); !status.ok()) return status;
  if (Status status = check_blocks(plan, out); !status.ok()) return status;
  const PatchSet::Impl& patches = set.impl();
  const GridPlan::Impl& inner = plan.impl();
  const auto& kernels = kernel::kernels(inner.isa);
  const std::size_t values = inner.samples() * 3 * PatchSet::lanes;
  const int vectors = !out.position.empty() + !out.du.empty() + !out.dv.empty() + !out.normal.empty();
  const bool streaming = execution.stores == Stores::streaming ||
                         (execution.stores == Stores::automatic &&
                          plan.block_capacity() * sizeof(T) * static_cast<std::size_t>(vectors) > streaming_threshold());
  const bool derivatives = !out.du.empty() || !out.dv.empty() || !out.normal.empty();
  std::atomic<Isa> isa{inner.isa};
  const Status status = parallel_for(
      inner.block_count, blocks_per_task(inner, derivatives), execution, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
          auto job = block_job<T>(patches, inner, block);
          const auto place = [&](std::span<T> memory) { return memory.empty() ? nullptr : memory.data() + block * values; };
          job.position = place(out.position);
          job.du = place(out.du);
          job.dv = place(out.dv);
          job.normal = place(out.normal);
          job.streaming = streaming;
          isa.store(run_grid(kernels, job), std::memory_order_relaxed);
          if (job.normal) write_pole_normals(patches, inner, block, job.normal);
        }
      });
  report(execution, isa, streaming);
  return status;
}

// ---- patch-contiguous outputs

template <class T>
Status check_views(const GridPlan& plan, const GridViews<T>& out) {
  const std::pair<const char*, const View3<T>*> outputs[] = {
      {"position", &out.position}, {"du", &out.du}, {"dv", &out.dv}, {"normal", &out.normal}};
  bool any = false;
  for (const auto& [what, view] : outputs) {
    if (view->empty()) continue;
    any = true;
    if (view->component[1] == nullptr || view->component[2] == nullptr || view->stride < 1)
      return Status(StatusCode::invalid_argument, std::string(what) + ": a view needs three components and a stride of at least 1");
    if (view->size < plan.capacity())
      return Status(StatusCode::buffer_too_small, std::string(what) + " needs " + std::to_string(plan.capacity()) + " records, not " +
                                                      std::to_string(view->size));
  }
  if (!any) return Status(StatusCode::invalid_argument, "no output is wanted");
  return {};
}

template <class T>
void write_pole_normals(const PatchSet::Impl& set, const GridPlan::Impl& plan, std::size_t block, const View3<T>& normals) {
  for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    const std::size_t patch = set.lane_patches[block * PatchSet::lanes + lane];
    for_each_pole_normal(plan, set.patches[patch], set.collapsed[patch], [&](std::size_t iu, std::size_t iv, const Vec3& normal) {
      const std::size_t record = (patch * plan.u.size() + iu) * plan.v.size() + iv;
      normals.at(record, 0) = static_cast<T>(normal.x);
      normals.at(record, 1) = static_cast<T>(normal.y);
      normals.at(record, 2) = static_cast<T>(normal.z);
    });
  }
}

template <class T>
Status evaluate_views(const PatchSet::Impl& patches, const GridPlan& plan, const GridViews<T>& out, const Execution& execution) {
  if (Status status = check_plan<T>(patches, plan); !status.ok()) return status;
  if (Status status = check_views(plan, out); !status.ok()) return status;
  const GridPlan::Impl& inner = plan.impl();
  const auto& kernels = kernel::kernels(inner.isa);
  const bool derivatives = !out.du.empty() || !out.dv.empty() || !out.normal.empty();
  std::atomic<Isa> isa{inner.isa};
  const Status status = parallel_for(
      inner.block_count, blocks_per_task(inner, derivatives), execution, [&](std::size_t begin, std::size_t end) {
        StagedBlock<T> stage(kernels, out);
        for (std::size_t block = begin; block < end; ++block) {
          const std::uint32_t* lane_patches = patches.lane_patches.data() + block * PatchSet::lanes;
          isa.store(stage.run(block_job<T>(patches, inner, block), lane_patches, patches.lane_counts[block], inner.samples()),
                    std::memory_order_relaxed);
          if (!out.normal.empty()) write_pole_normals(patches, inner, block, out.normal);
        }
      });
  report(execution, isa, false);
  return status;
}

}  // namespace

Status evaluate(const PatchSet& set, const GridPlan& plan, const GridBlocks<float>& out, const Execution& execution) {
  return guarded([&] { return evaluate_blocks(set, plan, out, execution); });
}
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridBlocks<double>& out, const Execution& execution) {
  return guarded([&] { return evaluate_blocks(set, plan, out, execution); });
}
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridViews<float>& out, const Execution& execution) {
  return guarded([&] { return evaluate_views(set.impl(), plan, out, execution); });
}
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridViews<double>& out, const Execution& execution) {
  return guarded([&] { return evaluate_views(set.impl(), plan, out, execution); });
}

Status evaluate(const PatchSet::Impl& set, const GridPlan& plan, const GridViews<float>& out, const Execution& execution) {
  return guarded([&] { return evaluate_views(set, plan, out, execution); });
}

}  // namespace tessera
