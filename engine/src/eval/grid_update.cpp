// Updates of grids, on threads. All input is checked before the first number is written. Then each task packs and
// evaluates block after block.

#include <atomic>

#include "base/impl_access.h"
#include "base/internal_export.h"
#include "base/text.h"
#include "eval/edited_grids.h"
#include "eval/patch_edits.h"
#include "eval/task_size.h"
#include "parallel/parallel_for.h"
#include "tessera/evaluate.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
class GridUpdate::Impl {
 public:
  explicit Impl(const PatchSet::Impl& set) : touched_(set), patch_count_(set.patches.size()) {}

  template <class T>
  Status run(PatchSet::Impl& set, const GridPlan& plan, const PatchEdits& edits, const QuantityViews<T>& out,
             const Execution& execution) {
    const Result<int> order = start(set, plan, edits, out, execution);
    if (!order) return order.status();
    const StageLayout<T> layout(out, impl_of(plan).isa);
    const bool streaming = views_stream(layout, edits.patch.size() * impl_of(plan).samples(), execution.stores);
    return each_block(set, plan, edits, *order, streaming, execution,
                      [&](const UpdateCall& call) { return EditedGrids<T>(call, layout, out); });
  }
  template <class T>
  Status run(PatchSet::Impl& set, const GridPlan& plan, const PatchEdits& edits, const QuantityBlocks<T>& out,
             const Execution& execution) {
    const Result<int> order = start(set, plan, edits, out, execution);
    if (!order) return order.status();
    const BlockOutputs<T> outputs(out);
    const std::size_t records = touched_.blocks().size() * PatchSet::lanes * impl_of(plan).samples();
    return each_block(set, plan, edits, *order, blocks_stream(out, records, execution.stores), execution,
                      [&](const UpdateCall& call) { return EditedBlocks<T>(call, outputs); });
  }

 private:
  /// Makes all checks and allocations that can fail. Returns the highest order of the derivatives that the outputs
  /// need.
  template <class Outputs>
  Result<int> start(PatchSet::Impl& set, const GridPlan& plan, const PatchEdits& edits, const Outputs& out,
                    const Execution& execution) {
    const Result<int> order = check_grids(set, plan, out);
    if (!order) return order.status();
    if (impl_of(plan).by_patch)
      return Status(
          StatusCode::unsupported,
          "a plan with PatchParameters cannot update grids: make one with the same parameters for all patches");
    if (patch_count_ != set.patches.size() || touched_.block_count() != set.lane_counts.size())
      return Status(StatusCode::stale, "the update was made for a set of " + counted(patch_count_, "patch", "patches") +
                                           ", this set has " + std::to_string(set.patches.size()) +
                                           "; make a new update");
    if (Status status = touched_.add(set, edits); !status.ok()) return status;
    if (Status status = prepare_edits(set, edits, touched_, execution); !status.ok()) return status;
    return *order;
  }

  /// Adds every touched block to an object that `make_task` makes for each task.
  template <class MakeTask>
  Status each_block(PatchSet::Impl& set, const GridPlan& plan, const PatchEdits& edits, int order, bool streaming,
                    const Execution& execution, MakeTask&& make_task) {
    const GridPlan::Impl& inner = impl_of(plan);
    const auto blocks = touched_.blocks();
    const UpdateCall call{set, inner, kernel::kernels(inner.isa), edits, touched_, order, streaming};
    std::atomic<Isa> isa{inner.isa};
    Status status = parallel_for(blocks.size(), blocks_per_task(inner, blocks.size(), order > 0), execution,
                                 [&](std::size_t begin, std::size_t end) {
                                   auto task = make_task(call);
                                   for (std::size_t k = begin; k < end; ++k) task.add(blocks[k]);
                                   isa.store(task.finish(), std::memory_order_relaxed);
                                 });
    finish_edits(set, edits);
    report_run(execution, isa, streaming);
    return status;
  }

  TouchedBlocks touched_;
  std::size_t patch_count_;
};

Result<GridUpdate> GridUpdate::make(const PatchSet& set) {
  return guarded([&]() -> Result<GridUpdate> { return GridUpdate(std::make_unique<Impl>(impl_of(set))); });
}

GridUpdate::GridUpdate(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GridUpdate::GridUpdate(GridUpdate&&) noexcept = default;
GridUpdate& GridUpdate::operator=(GridUpdate&&) noexcept = default;
GridUpdate::~GridUpdate() = default;

template <class T>
Status GridUpdate::run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityViews<T>& out,
                       const Execution& execution) {
  return guarded([&] { return impl_->run(impl_of(set), plan, edits, out, execution); });
}
template TESSERA_EXPORT Status GridUpdate::run(PatchSet&, const GridPlan&, const PatchEdits&,
                                               const QuantityViews<float>&, const Execution&);
template TESSERA_EXPORT Status GridUpdate::run(PatchSet&, const GridPlan&, const PatchEdits&,
                                               const QuantityViews<double>&, const Execution&);

template <class T>
Status GridUpdate::run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityBlocks<T>& out,
                       const Execution& execution) {
  return guarded([&] { return impl_->run(impl_of(set), plan, edits, out, execution); });
}
template TESSERA_EXPORT Status GridUpdate::run(PatchSet&, const GridPlan&, const PatchEdits&,
                                               const QuantityBlocks<float>&, const Execution&);
template TESSERA_EXPORT Status GridUpdate::run(PatchSet&, const GridPlan&, const PatchEdits&,
                                               const QuantityBlocks<double>&, const Execution&);

}}  // namespace tessera::abi_0_1
