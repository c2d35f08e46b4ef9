// Blocks and grids over threads. Two ways out of the kernels: block-interleaved memory, which they write themselves,
// and patch-contiguous views, through a stage that stays in the first-level cache and leaves it line by line.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "base/guard.h"
#include "block/patch_set_impl.h"
#include "eval/block_normals.h"
#include "eval/grid_calls.h"
#include "eval/grid_outputs.h"
#include "eval/grid_plan_impl.h"
#include "eval/staged_block.h"
#include "eval/streaming_threshold.h"
#include "eval/view_checks.h"
#include "parallel/parallel_for.h"

namespace tessera {
namespace {

/// Points a task: enough to hide its cost, few enough to balance.
constexpr std::size_t points_per_task = 16384;
/// Below these many points one thread is faster than waking another.
constexpr std::size_t serial_positions = 32768, serial_normals = 10240;

/// A part of a block's grid: rows of parameters u.
struct Piece {
  std::size_t block;
  int u_begin, u_end;
};

/// The work as pieces of about points_per_task points: several blocks, or some rows of one. The same for any number of
/// threads.
class Pieces {
 public:
  Pieces(const GridPlan::Impl& plan, bool derivatives) : rows_(plan.count_u), count_u_(rows_) {
    const std::size_t row_points = plan.count_v * PatchSet::lanes, points = row_points * count_u_;
    grain_ = std::max<std::size_t>(1, points_per_task / points);
    if (points * plan.block_count <= (derivatives ? serial_normals : serial_positions)) {
      grain_ = plan.block_count;
    } else if (points > 2 * points_per_task) {
      rows_ = std::max<std::size_t>(1, points_per_task / row_points);
    }
    in_block_ = (count_u_ + rows_ - 1) / rows_;
    count_ = plan.block_count * in_block_;
  }
  std::size_t count() const { return count_; }
  std::size_t grain() const { return grain_; }
  Piece operator[](std::size_t k) const {
    const std::size_t begin = k % in_block_ * rows_;
    return {k / in_block_, static_cast<int>(begin), static_cast<int>(std::min(count_u_, begin + rows_))};
  }

 private:
  std::size_t rows_, count_u_, in_block_ = 1, count_ = 0, grain_ = 1;
};

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
                                 return a.degree_u == b.degree_u && a.degree_v == b.degree_v &&
                                        a.rational == b.rational && a.blocks == b.block_count;
                               });
  if (!same || !set.has(plan.precision(), plan.impl().options.representation))
    return Status(StatusCode::invalid_argument,
                  "the plan was made for another patch set: counts, degrees or blocks differ");
  return {};
}

/// What every kernel call over one block has in common.
template <class T>
kernel::GridJob<T> block_job(const PatchSet::Impl& set, const GridPlan::Impl& plan, const Piece& piece) {
  const BlockGroup& group = set.group_of_block(piece.block);
  kernel::GridJob<T> job;
  job.net = set.coefficients<T>().of(plan.options.representation).data() + group.first_value +
            (piece.block - group.first_block) * group.block_values;
  job.degree_u = group.degree_u;
  job.degree_v = group.degree_v;
  job.rational = group.rational;
  const GridWeights<T>& weights = plan.weights<T>();
  job.by_lane = plan.by_patch;
  job.u_weights = plan.by_patch ? weights.u_lanes.of(piece.block) : weights.u[static_cast<std::size_t>(group.degree_u)].data();
  job.v_weights = plan.by_patch ? weights.v_lanes.of(piece.block) : weights.v[static_cast<std::size_t>(group.degree_v)].data();
  job.u_begin = piece.u_begin;
  job.u_end = piece.u_end;
  job.v_end = static_cast<int>(plan.count_v);
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

/// The highest derivatives that the wanted outputs are made of. Errors: invalid_argument if none is wanted.
template <class T, class Wanted>
Result<int> order_of_outputs(Wanted&& wanted) {
  int order = -1;
  for_each_output<T>([&](const auto& output) {
    if (wanted(output)) order = std::max(order, output.order);
  });
  if (order < 0) return Status(StatusCode::invalid_argument, "no output is wanted");
  return order;
}

/// What the report says of the ISA comes from the kernel that ran; the plan's own value stands in for an empty run.
void report(const Execution& execution, Isa isa, bool streaming) {
  if (!execution.report) return;
  execution.report->isa = isa;
  execution.report->streaming = streaming;
}

// ---- block-interleaved outputs

/// The memory of outputs in blocks, one after the other; the first that shares some with one before is refused.
class BlockMemory {
 public:
  template <class T>
  Status add(const char* name, std::span<T> memory) {
    const Range range{name, reinterpret_cast<std::uintptr_t>(memory.data()), memory.size_bytes()};
    for (const Range& other : std::span(ranges_).first(count_))
      if (range.begin < other.begin + other.bytes && other.begin < range.begin + range.bytes)
        return Status(StatusCode::invalid_argument, std::string(other.name) + " and " + name + " share memory");
    ranges_.at(count_++) = range;
    return {};
  }

 private:
  struct Range {
    const char* name;
    std::uintptr_t begin;
    std::size_t bytes;
  };
  std::array<Range, 24> ranges_{};
  std::size_t count_ = 0;
};

template <class T>
Status check_blocks(const GridPlan& plan, const GridBlocks<T>& out) {
  Status status;
  BlockMemory all;
  for_each_output<T>([&](const auto& output) {
    const auto memory = out.*output.memory;
    if (memory.data() == nullptr || !status.ok()) return;
    const std::size_t needed = plan.block_capacity() / 3 * static_cast<std::size_t>(output.width);
    if (memory.size() < needed)
      status = Status(StatusCode::buffer_too_small, std::string(output.name) + " needs " + std::to_string(needed) +
                                                        " values, not " + std::to_string(memory.size()));
    else if (reinterpret_cast<std::uintptr_t>(memory.data()) % cache_line != 0)
      status = Status(StatusCode::invalid_argument, std::string(output.name) + " must be aligned to 64 bytes");
    else
      status = all.add(output.name, memory.first(needed));
  });
  return status;
}

bool stores_stream(std::size_t bytes, Stores stores) {
  return stores == Stores::automatic ? bytes > streaming_threshold() : stores == Stores::streaming;
}

/// Of one record of the values that `wanted` names.
template <class T, class Wanted>
std::size_t record_bytes(Wanted&& wanted) {
  std::size_t bytes = 0;
  for_each_value_output<T>([&](const auto& output) {
    if (wanted(output)) bytes += static_cast<std::size_t>(output.width) * sizeof(T);
  });
  return bytes;
}

/// Points the job at a piece's part of the caller's memory.
template <class T>
void place_outputs(const GridBlocks<T>& out, const GridPlan::Impl& plan, const Piece& piece, kernel::GridJob<T>& job) {
  const std::size_t row = piece.block * plan.count_u + static_cast<std::size_t>(piece.u_begin);
  const std::size_t first = row * plan.count_v * PatchSet::lanes;
  for_each_value_output<T>([&](const auto& output) {
    const auto memory = out.*output.memory;
    job.*output.job = memory.empty() ? nullptr : memory.data() + first * static_cast<std::size_t>(output.width);
  });
  for_each_kind_output<T>([&](const auto& output) {
    const auto memory = out.*output.memory;
    job.*output.job = memory.empty() ? nullptr : reinterpret_cast<std::uint8_t*>(memory.data() + first);
  });
}

template <class T>
Status evaluate_blocks(const PatchSet& set, const GridPlan& plan, const GridBlocks<T>& out,
                       const Execution& execution) {
  if (Status status = check_plan<T>(set.impl(), plan); !status.ok()) return status;
  if (Status status = check_blocks(plan, out); !status.ok()) return status;
  const auto wanted = [&](const auto& output) { return (out.*output.memory).data() != nullptr; };
  const auto order = order_of_outputs<T>(wanted);
  if (!order) return order.status();
  const PatchSet::Impl& patches = set.impl();
  const GridPlan::Impl& inner = plan.impl();
  const auto& kernels = kernel::kernels(inner.isa);
  const bool streaming =
      !inner.by_patch && stores_stream(plan.block_capacity() / 3 * record_bytes<T>(wanted), execution.stores);
  const Pieces pieces(inner, *order > 0);
  std::atomic<Isa> isa{inner.isa};
  const Status status =
      parallel_for(pieces.count(), pieces.grain(), execution, [&](std::size_t begin, std::size_t end) {
        BlockNormals<T> normals(patches, inner);
        for (std::size_t k = begin; k < end; ++k) {
          const Piece piece = pieces[k];
          auto job = block_job<T>(patches, inner, piece);
          normals.prepare(piece.block, job);
          place_outputs(out, inner, piece, job);
          job.streaming = streaming;
          isa.store(run_grid(kernels, job), std::memory_order_relaxed);
        }
        if (streaming) kernels.finish_streaming();
      });
  report(execution, isa, streaming);
  return status;
}

// ---- patch-contiguous outputs

template <class T>
Status check_views(const GridPlan& plan, const GridViews<T>& out) {
  ViewChecks checks(plan.capacity());
  for_each_output<T>([&](const auto& output) {
    if (!(out.*output.view).empty()) checks.add(output.name, out.*output.view);
  });
  return checks.status();
}

template <class T>
Status evaluate_views(const PatchSet::Impl& patches, const GridPlan& plan, const GridViews<T>& out,
                      const Execution& execution) {
  const Result<int> order = check_grids(patches, plan, out);
  if (!order) return order.status();
  const GridPlan::Impl& inner = plan.impl();
  const auto& kernels = kernel::kernels(inner.isa);
  const StageLayout<T> layout(out);
  const bool streaming = views_stream(layout, plan.capacity(), execution.stores);
  const Pieces pieces(inner, *order > 0);
  std::atomic<Isa> isa{inner.isa};
  const Status status =
      parallel_for(pieces.count(), pieces.grain(), execution, [&](std::size_t begin, std::size_t end) {
        StagedBlock<T> stage(kernels, layout, out, streaming);
        BlockNormals<T> normals(patches, inner);
        for (std::size_t k = begin; k < end; ++k) {
          const Piece piece = pieces[k];
          auto job = block_job<T>(patches, inner, piece);
          normals.prepare(piece.block, job);
          const std::uint32_t* lane_patches = patches.lane_patches.data() + piece.block * PatchSet::lanes;
          isa.store(stage.run(job, lane_patches, patches.lane_counts[piece.block], inner.samples()),
                    std::memory_order_relaxed);
        }
        if (streaming) kernels.finish_streaming();
      });
  report(execution, isa, streaming);
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

Status evaluate(const PatchSet::Impl& set, const GridPlan& plan, const GridViews<float>& out,
                const Execution& execution) {
  return guarded([&] { return evaluate_views(set, plan, out, execution); });
}

// ---- what other calls share

template <class T>
Result<int> check_grids(const PatchSet::Impl& set, const GridPlan& plan, const GridViews<T>& out) {
  if (Status status = check_plan<T>(set, plan); !status.ok()) return status;
  if (Status status = check_views(plan, out); !status.ok()) return status;
  return order_of_outputs<T>([&](const auto& output) { return !(out.*output.view).empty(); });
}
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const GridViews<float>&);
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const GridViews<double>&);

template <class T>
kernel::GridJob<T> block_job_of(const PatchSet::Impl& set, const GridPlan::Impl& plan, std::size_t block) {
  return block_job<T>(set, plan, {block, 0, static_cast<int>(plan.count_u)});
}
template kernel::GridJob<float> block_job_of(const PatchSet::Impl&, const GridPlan::Impl&, std::size_t);
template kernel::GridJob<double> block_job_of(const PatchSet::Impl&, const GridPlan::Impl&, std::size_t);

template <class T>
bool views_stream(const StageLayout<T>& layout, std::size_t records, Stores stores) {
  if (layout.arrays().empty()) return false;
  return stores_stream(records * static_cast<std::size_t>(layout.record_width()) * sizeof(T), stores);
}
template bool views_stream(const StageLayout<float>&, std::size_t, Stores);
template bool views_stream(const StageLayout<double>&, std::size_t, Stores);

std::size_t blocks_a_task(const GridPlan::Impl& plan, std::size_t blocks, bool derivatives) {
  const std::size_t points = plan.samples() * PatchSet::lanes;
  if (points * blocks <= (derivatives ? serial_normals : serial_positions)) return blocks;
  return std::max<std::size_t>(1, points_per_task / points);
}

}  // namespace tessera
