#include "tessera/tessellation.h"

#include <string>

#include "base/impl_access.h"
#include "eval/patch_edits.h"
#include "kernel/table/kernel_table.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/mesh/present_bounds.h"
#include "tess/write/mesh_views.h"
#include "tess/write/vertex_pass.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t blocks_per_task = 8;
constexpr double restating_ends[] = {0.8, 1};  // after the patches' bounds, and after those of the mesh

Status edited_otherwise(std::uint64_t revision, std::uint64_t known) {
  return {StatusCode::stale, "the set is at revision " + std::to_string(revision) + ", the mesh at " +
                                 std::to_string(known) + ": the set was edited by other means"};
}

}  // namespace

class MeshUpdate::Impl {
 public:
  Impl(const PatchSet& set, CertifiedTessellation plan)
      : plan_(std::move(plan)),
        touched_(impl_of(set)),
        bounds_(impl_of(set), impl_of(plan_)),
        revision_(set.revision()) {}

  const CertifiedTessellation& plan() const { return plan_; }
  const PresentBounds& bounds() const { return bounds_; }

  Status run(PatchSet::Impl& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution) {
    const CertifiedTessellation::Impl& plan = impl_of(plan_);
    if (plan.shapes().size() != set.patches.size() || touched_.block_count() != set.lane_counts.size())
      return {StatusCode::stale, "the update was made for a set of " +
                                     counted(plan.shapes().size(), "patch", "patches") + ", this set has " +
                                     std::to_string(set.patches.size()) + "; make a new update"};
    if (set.revision != revision_) return edited_otherwise(set.revision, revision_);
    if (Status status = check_vertex_views(out, plan.plan().capacity(), plan.plan().has_f64_positions()); !status.ok())
      return status;
    if (Status status = plan.check_normals(out); !status.ok()) return status;
    if (Status status = touched_.add(set, edits); !status.ok()) return status;
    const auto keeps_shape = [&](std::uint32_t patch, std::span<const Vec3> points) {
      return PatchShape::of(set.patches[patch], points) == plan.shapes()[patch];
    };
    const KeepsShape check(keeps_shape);
    if (Status status = prepare_edits(set, edits, touched_, execution, &check); !status.ok()) return status;
    const Status status = write(set, edits, out, execution);
    finish_edits(set, edits);
    revision_ = set.revision;
    bounds_.touch(set, edits.patch);
    const Status copied = plan.write_copies(set, out, {}, [&](std::size_t patch) {
      const PatchSet::Slot slot = set.slots[patch];
      return touched_.edits(slot.block)[slot.lane] != TouchedBlocks::none;
    });
    return status.ok() ? copied : status;
  }

  Status restate(const PatchSet::Impl& set, const Execution& execution) {
    if (set.revision != revision_) return edited_otherwise(set.revision, revision_);
    CallProgress progress(execution, restating_ends);
    return progress.finish(bounds_.restate(set, impl_of(plan_), progress.loops()));
  }

  Result<std::size_t> retessellate(const PatchSet& set, double spare, const Execution& execution) {
    Result<CertifiedTessellation> next = plan_.retessellate(set, spare, execution);
    if (!next) return next.status();
    PresentBounds bounds(impl_of(set), impl_of(*next));
    const std::size_t changed = set.revision() == revision_ ? next->divided_otherwise(plan_) : set.patch_count();
    plan_ = std::move(*next);
    bounds_ = std::move(bounds);
    revision_ = set.revision();
    return changed;
  }

 private:
  /// Packs and writes the touched blocks.
  Status write(PatchSet::Impl& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution) {
    const CertifiedTessellation::Impl& plan = impl_of(plan_);
    const kernel::KernelTable& kernels = kernel::kernels(plan.isa());
    std::size_t vertices = 0;
    for (const std::uint32_t patch : edits.patch)
      vertices += plan.plan().first_vertex(patch + 1) - plan.plan().first_vertex(patch);
    const PatchWriter writer(set, plan.plan(), plan.tables(), kernels, out, execution.stores,
                             sizeof(float) * vertices * (out.normal.empty() ? 3 : 6));
    const auto blocks = touched_.blocks();
    const auto write_blocks = [&](std::size_t begin, std::size_t end) {
      VertexPass pass(writer);
      for (std::size_t k = begin; k < end; ++k) {
        pack_edits(set, edits, touched_, kernels, blocks[k]);
        for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
          if (touched_.edits(blocks[k])[lane] != TouchedBlocks::none)
            pass.write(set.lane_patches[blocks[k] * std::size_t{PatchSet::lanes} + lane]);
      }
      pass.finish();
    };
    Status status = parallel_for(blocks.size(), blocks_per_task, execution, write_blocks);
    if (execution.report) {
      execution.report->isa = plan.isa();
      execution.report->streaming = writer.streaming();
    }
    return status;
  }

  CertifiedTessellation plan_;
  TouchedBlocks touched_;
  PresentBounds bounds_;
  std::uint64_t revision_;
};

Result<MeshUpdate> MeshUpdate::make(const PatchSet& set, CertifiedTessellation plan) {
  return guarded([&]() -> Result<MeshUpdate> {
    if (Status status = check_count(set, impl_of(plan).plan().patch_count()); !status.ok()) return status;
    if (set.revision() != impl_of(plan).revision()) return edited_otherwise(set.revision(), impl_of(plan).revision());
    return MeshUpdate(std::make_unique<Impl>(set, std::move(plan)));
  });
}

MeshUpdate::MeshUpdate(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MeshUpdate::MeshUpdate(MeshUpdate&&) noexcept = default;
MeshUpdate& MeshUpdate::operator=(MeshUpdate&&) noexcept = default;
MeshUpdate::~MeshUpdate() = default;

const CertifiedTessellation& MeshUpdate::plan() const { return impl_->plan(); }
std::span<const float> MeshUpdate::bounds() const { return impl_->bounds().bounds(); }
double MeshUpdate::bound() const { return impl_->bounds().bound(); }
std::size_t MeshUpdate::unproven() const { return impl_->bounds().unproven(); }

Status MeshUpdate::run(PatchSet& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution) {
  return guarded([&] { return impl_->run(impl_of(set), edits, out, execution); });
}

Status MeshUpdate::restate(const PatchSet& set, const Execution& execution) {
  return guarded([&] { return impl_->restate(impl_of(set), execution); });
}

Result<std::size_t> MeshUpdate::retessellate(const PatchSet& set, double spare, const Execution& execution) {
  return guarded([&] { return impl_->retessellate(set, spare, execution); });
}

}  // namespace tessera::inline abi_0_1
