// Evaluates the blocks of a set over a grid of parameters, on threads. The call chain of a sample:
//   evaluate() -> evaluate_blocks() or evaluate_views(): one task takes some blocks, or some rows of one block
//   -> BlockJobs::turn_to() (eval/block_jobs.h): the block's control points and the plan's weights
//   -> run_grid() (eval/run_grid.h) -> the kernel of the instruction set (kernel/grid/grid_kernel.inl.h)
//   -> evaluate_sample() (kernel/sample/sample_kernel.inl.h): the sums, and what their rounding is.
// Positions alone into packed float records, polynomial patches: evaluate_views() -> evaluate_flat() (eval/flat_grid.h)
//   -> kernel/grid/flat_kernel.inl.h: the same sums in the same order.
// Positions and normals at the start of longer records: StagedBlock::run() -> kernel/grid/record_kernel.inl.h.
// The kernels write block-interleaved outputs themselves. Patch-contiguous outputs pass a stage in the first-level
// cache (eval/staged_block.h).

#include <algorithm>
#include <cstdint>
#include <string>

#include "base/impl_access.h"
#include "base/internal_export.h"
#include "base/text.h"
#include "block/patch_set_impl.h"
#include "eval/block_jobs.h"
#include "eval/block_outputs.h"
#include "eval/flat_grid.h"
#include "eval/grid_calls.h"
#include "eval/grid_checks.h"
#include "eval/grid_plan_impl.h"
#include "eval/quantity_table.h"
#include "eval/run_grid.h"
#include "eval/staged_block.h"
#include "eval/streaming_threshold.h"
#include "eval/task_size.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Some rows u of a block's grid.
struct Piece {
  std::size_t block;
  int u_begin, u_end;
};

/// Cuts the work into pieces of about points_per_task points: several blocks, or some rows of one. The pieces do not
/// depend on the number of threads.
class Pieces {
 public:
  Pieces(const GridPlan::Impl& plan, bool derivatives) : rows_(plan.count_u), count_u_(rows_) {
    const std::size_t row_points = plan.count_v * PatchSet::lanes, points = row_points * count_u_;
    grain_ = items_per_task(plan.block_count, points);
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
  const bool is_f64 = plan.precision() == Precision::double_precision;
  if (is_f64 != (sizeof(T) == 8))
    return Status(StatusCode::invalid_argument, std::string("the plan is in ") + (is_f64 ? "double" : "single") +
                                                    " precision, but the outputs are of type " +
                                                    (is_f64 ? "float" : "double"));
  const auto& planned = impl_of(plan).groups;
  const auto& groups = set.groups;
  const bool same = impl_of(plan).patch_count == set.patches.size() &&
                    std::equal(planned.begin(), planned.end(), groups.begin(), groups.end(),
                               [](const PlannedGroup& a, const BlockGroup& b) {
                                 return a.degree_u == b.degree_u && a.degree_v == b.degree_v &&
                                        a.rational == b.rational && a.blocks == b.block_count;
                               });
  if (!same)
    return Status(StatusCode::stale,
                  "the plan was made for a set of " + counted(impl_of(plan).patch_count, "patch", "patches") +
                      ", this set has " + std::to_string(set.patches.size()) +
                      (impl_of(plan).patch_count == set.patches.size() ? " of other degrees or rationality" : "") +
                      "; make a new plan");
  if (!set.has(plan.precision(), impl_of(plan).options.representation))
    return Status(StatusCode::stale,
                  "the plan reads blocks that this set does not hold; make the set with the plan's blocks, see "
                  "PatchSetOptions::blocks");
  return {};
}

template <class T, int N>
bool is_wanted(const VectorView<T, N>& view) {
  return !view.empty();
}
template <class T>
bool is_wanted(const std::span<T>& memory) {
  return memory.data() != nullptr;
}

/// Returns the highest order of the derivatives that the wanted outputs need. Errors: invalid_argument (none is
/// wanted).
template <class All>
Result<int> order_of_outputs(const All& out) {
  int order = -1;
  for_each_quantity([&](const auto& quantity) {
    if (is_wanted(quantity.of(out))) order = std::max(order, quantity.order);
  });
  if (order < 0)
    return Status(StatusCode::invalid_argument, "all output views are empty: at least one must have memory");
  return order;
}

// ---- block-interleaved outputs

bool stores_stream(std::size_t bytes, Stores stores) {
  return stores == Stores::automatic ? bytes > streaming_threshold() : stores == Stores::streaming;
}

template <class T>
Status evaluate_blocks(const PatchSet& set, const GridPlan& plan, const QuantityBlocks<T>& out,
                       const Execution& execution) {
  const Result<int> order = check_grids(impl_of(set), plan, out);
  if (!order) return order.status();
  const PatchSet::Impl& patches = impl_of(set);
  const GridPlan::Impl& inner = impl_of(plan);
  const auto& kernels = kernel::kernels(inner.isa);
  const bool streaming = !inner.by_patch && blocks_stream(out, plan.block_capacity() / 3, execution.stores);
  const Pieces pieces(inner, *order > 0);
  const BlockOutputs<T> outputs(out);
  std::atomic<Isa> isa{inner.isa};
  Status status = parallel_for(pieces.count(), pieces.grain(), execution, [&](std::size_t begin, std::size_t end) {
    BlockJobs<T> jobs(patches, inner, *order);
    kernel::GridJob<T>& job = jobs.job();
    job.streaming = streaming;
    Isa ran = inner.isa;
    for (std::size_t k = begin; k < end; ++k) {
      const Piece piece = pieces[k];
      jobs.turn_to(piece.block);
      job.u_begin = piece.u_begin;
      job.u_end = piece.u_end;
      const std::size_t row = piece.block * inner.count_u + static_cast<std::size_t>(piece.u_begin);
      outputs.place(row * inner.count_v * PatchSet::lanes, job);
      ran = run_grid(kernels, job);
    }
    isa.store(ran, std::memory_order_relaxed);
    if (streaming) kernels.finish_streaming();
  });
  report_run(execution, isa, streaming);
  return status;
}

// ---- patch-contiguous outputs

template <class T>
Status check_views(const GridPlan& plan, const QuantityViews<T>& out) {
  ViewChecks checks(plan.capacity());
  for_each_quantity([&](const auto& quantity) {
    if (!quantity.of(out).empty()) checks.add(quantity.name, quantity.of(out));
  });
  return checks.status();
}

template <class T>
Status evaluate_views(const PatchSet::Impl& patches, const GridPlan& plan, const QuantityViews<T>& out,
                      const Execution& execution) {
  const Result<int> order = check_grids(patches, plan, out);
  if (!order) return order.status();
  const GridPlan::Impl& inner = impl_of(plan);
  const auto& kernels = kernel::kernels(inner.isa);
  const StageLayout<T> layout(out, inner.isa);
  const bool streaming = views_stream(layout, plan.capacity(), execution.stores);
  if constexpr (sizeof(T) == 4) {
    if (*order == 0 && layout.one_record() && inner.is_flat)
      return evaluate_flat(patches, inner, out.position.component[0], streaming, execution);
  }
  const Pieces pieces(inner, *order > 0);
  std::atomic<Isa> isa{inner.isa};
  Status status = parallel_for(pieces.count(), pieces.grain(), execution, [&](std::size_t begin, std::size_t end) {
    StagedBlock<T> stage(kernels, layout, out, streaming);
    BlockJobs<T> jobs(patches, inner, *order);
    stage.place_outputs(jobs.job());
    Isa ran = inner.isa;
    for (std::size_t k = begin; k < end; ++k) {
      const Piece piece = pieces[k];
      jobs.turn_to(piece.block);
      const std::uint32_t* lane_patches = patches.lane_patches.data() + piece.block * PatchSet::lanes;
      ran = stage.run(jobs.job(), piece.u_begin, piece.u_end, static_cast<int>(inner.count_v), lane_patches,
                      patches.lane_counts[piece.block], inner.samples());
    }
    isa.store(ran, std::memory_order_relaxed);
    if (streaming) kernels.finish_streaming();
  });
  report_run(execution, isa, streaming);
  return status;
}

}  // namespace

template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityBlocks<T>& out, const Execution& execution) {
  return guarded([&] { return evaluate_blocks(set, plan, out, execution); });
}
template TESSERA_EXPORT Status evaluate(const PatchSet&, const GridPlan&, const QuantityBlocks<float>&,
                                        const Execution&);
template TESSERA_EXPORT Status evaluate(const PatchSet&, const GridPlan&, const QuantityBlocks<double>&,
                                        const Execution&);

template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityViews<T>& out, const Execution& execution) {
  return guarded([&] { return evaluate_views(impl_of(set), plan, out, execution); });
}
template TESSERA_EXPORT Status evaluate(const PatchSet&, const GridPlan&, const QuantityViews<float>&,
                                        const Execution&);
template TESSERA_EXPORT Status evaluate(const PatchSet&, const GridPlan&, const QuantityViews<double>&,
                                        const Execution&);

Status evaluate(const PatchSet::Impl& set, const GridPlan& plan, const QuantityViews<float>& out,
                const Execution& execution) {
  return guarded([&] { return evaluate_views(set, plan, out, execution); });
}

// ---- checks and decisions that other calls share

template <class T>
Result<int> check_grids(const PatchSet::Impl& set, const GridPlan& plan, const QuantityViews<T>& out) {
  if (Status status = check_plan<T>(set, plan); !status.ok()) return status;
  if (Status status = check_views(plan, out); !status.ok()) return status;
  return order_of_outputs(out);
}
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const QuantityViews<float>&);
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const QuantityViews<double>&);

template <class T>
Result<int> check_grids(const PatchSet::Impl& set, const GridPlan& plan, const QuantityBlocks<T>& out) {
  if (Status status = check_plan<T>(set, plan); !status.ok()) return status;
  if (Status status = check_blocks(plan, out); !status.ok()) return status;
  return order_of_outputs(out);
}
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const QuantityBlocks<float>&);
template Result<int> check_grids(const PatchSet::Impl&, const GridPlan&, const QuantityBlocks<double>&);

template <class T>
bool views_stream(const StageLayout<T>& layout, std::size_t records, Stores stores) {
  if (layout.arrays().empty()) return false;
  return stores_stream(records * static_cast<std::size_t>(layout.record_width()) * sizeof(T), stores);
}
template bool views_stream(const StageLayout<float>&, std::size_t, Stores);
template bool views_stream(const StageLayout<double>&, std::size_t, Stores);

template <class T>
bool blocks_stream(const QuantityBlocks<T>& out, std::size_t records, Stores stores) {
  std::size_t bytes = 0;
  for_each_value_quantity([&](const auto& quantity) {
    if (!quantity.of(out).empty()) bytes += static_cast<std::size_t>(quantity.width) * sizeof(T);
  });
  return stores_stream(records * bytes, stores);
}
template bool blocks_stream(const QuantityBlocks<float>&, std::size_t, Stores);
template bool blocks_stream(const QuantityBlocks<double>&, std::size_t, Stores);

std::size_t blocks_per_task(const GridPlan::Impl& plan, std::size_t blocks, bool derivatives) {
  const std::size_t points = plan.samples() * PatchSet::lanes;
  if (points * blocks <= (derivatives ? serial_normals : serial_positions)) return blocks;
  return items_per_task(blocks, points);
}

}}  // namespace tessera::abi_0_1
