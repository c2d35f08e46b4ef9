// Meshes with tolerances that follow edits: control points are packed and proven, then vertices are written.

#include <algorithm>

#include "base/impl_access.h"
#include "eval/patch_edits.h"
#include "kernel/table/kernel_table.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"
#include "tess/mesh/proven_mesh.h"
#include "tess/write/mesh_views.h"
#include "tess/write/patch_writer.h"
#include "tess/write/vertex_pass.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double update_ends[] = {0.5, 1};  // after the proof, and after the vertices

/// Notes edits when a call ends, in whichever way.
class NotedEdits {
 public:
  NotedEdits(PatchSet::Impl& set, const PatchEdits& edits) : set_(set), edits_(edits) {}
  NotedEdits(const NotedEdits&) = delete;
  NotedEdits& operator=(const NotedEdits&) = delete;
  ~NotedEdits() { finish_edits(set_, edits_); }

 private:
  PatchSet::Impl& set_;
  const PatchEdits& edits_;
};

}  // namespace

Status ProvenMesh::start(PatchSet& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution) {
  if (Status status = check_updated_views(out, plan_.capacity(), plan_.patches().has_f64_positions); !status.ok())
    return status;
  if (Status status = check_attributes(out); !status.ok()) return status;
  PatchSet::Impl& inner = impl_of(set);
  if (!edits_) edits_ = std::make_unique<TouchedBlocks>(inner);
  if (Status status = edits_->add(inner, edits); !status.ok()) return status;
  if (Status status = prepare_edits(inner, edits, *edits_, execution); !status.ok()) return status;
  return {};
}

Status ProvenMesh::start_proofs(const PatchSet& set, const Execution& execution) {
  Result<PlannerOptions> planned = planner_options(options_, set);
  if (!planned) return planned.status();
  planned->f64_patches.assign(plan_.patches().rare->f64_patches.begin(), plan_.patches().rare->f64_patches.end());
  Result<PlanFacts> facts = find_plan_facts(impl_of(set), *planned, {.cancel = execution.cancel});
  if (!facts) return facts.status();
  update_ = std::make_unique<PlanUpdate>(*std::move(facts), of(impl_of(set)));
  return {};
}

Status ProvenMesh::set_view(const View& view) {
  if (!options_.pixels) return Impl::set_view(view);
  const Result<Camera> camera = Camera::make(view);
  if (!camera) return camera.status();
  options_.pixels->view = view;
  is_view_new_ = true;
  return {};
}

Result<MeshChange> ProvenMesh::update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                      const Execution& execution) {
  PatchSet::Impl& inner = impl_of(set);
  if (plans_anew(inner, plan_, options_)) return update_anew(set, edits, out, execution);
  if (Status status = start(set, edits, out, execution); !status.ok()) return status;
  CallProgress progress(execution, update_ends);
  // Edges and welds must be those of the plan: an update that finds edited patches has to find them anew.
  const bool is_known = update_ || inner.revision == revision_;
  if (!update_)
    if (Status status = start_proofs(set, execution); !status.ok()) return status;
  if (is_view_new_)
    update_->begin(*Camera::make(options_.pixels->view));
  else
    update_->begin();
  if (inner.revision != revision_) touch_edited(inner);
  for (const std::uint32_t patch : edits.patch) update_->touch(inner, patch);
  const auto proven = [&]() -> Result<PlanUpdate::Outcome> {
    const NotedEdits noted(inner, edits);
    const auto pack = [&](std::uint32_t block) {
      if (edits_->count(block) > 0) pack_edits(inner, edits, *edits_, kernel::kernels(isa_), block);
    };
    return update_->prove(of(inner), pack, progress.loops());
  };
  const Result<PlanUpdate::Outcome> outcome = proven();
  if (!outcome) return outcome.status();
  MeshChange change;
  if (is_known && *outcome == PlanUpdate::Outcome::kept) {
    update_->take_bounds(plan_);
  } else {
    const Result<std::size_t> changed =
        redivide(set, is_known ? *outcome : PlanUpdate::Outcome::unknown, progress.loops());
    if (!changed) return changed.status();
    change = {*changed > 0, *changed};
  }
  if (!change.topology)
    if (Status status = write_touched(inner, out, progress.loops()); !status.ok()) return status;
  revision_ = inner.revision;
  is_view_new_ = false;
  (void)progress.finish({});
  return change;
}

// Loops and edges of shapes tie patches to others far away, so everything is planned and written anew. Patches keep
// their segments where these suffice, so small edits keep the triangles.
Result<MeshChange> ProvenMesh::update_anew(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                           const Execution& execution) {
  PatchSet::Impl& inner = impl_of(set);
  if (Status status = start(set, edits, out, execution); !status.ok()) return status;
  {
    const NotedEdits noted(inner, edits);
    for (std::uint32_t block = 0; block < inner.lane_counts.size(); ++block)
      if (edits_->count(block) > 0) pack_edits(inner, edits, *edits_, kernel::kernels(isa_), block);
  }
  const Result<std::unique_ptr<ProvenMesh>> next = make(set, options_, this, execution);
  if (!next) return next.status();
  const bool is_same = plan_.has_triangles_of((*next)->plan_);
  const std::size_t changed = replace(**next);
  revision_ = inner.revision;
  is_view_new_ = false;
  if (is_same)
    if (Status status = write_again(set, out, {.cancel = execution.cancel}); !status.ok()) return status;
  return MeshChange{!is_same, is_same ? changed : std::max<std::size_t>(changed, 1)};
}

Status ProvenMesh::write_again(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  const MeshCapacity size = capacity();
  std::vector<std::uint32_t> indices(out.indices.empty() ? 3 * size.triangles : 0);
  std::vector<std::uint32_t> quads(out.quads.empty() ? 4 * size.quads : 0);
  MeshViews all = out;
  if (out.indices.empty()) all.indices = indices;
  if (out.quads.empty()) all.quads = quads;
  return run(set, all, execution);
}

void ProvenMesh::touch_edited(const PatchSet::Impl& set) {
  for (std::size_t patch = 0; patch < set.edited.size(); ++patch)
    if (set.edited[patch] > revision_) update_->touch(set, patch);
}

Result<std::size_t> ProvenMesh::redivide(const PatchSet& set, PlanUpdate::Outcome outcome, const Execution& execution) {
  // Borders that edits have moved apart are joined no longer once the topology is made anew: that needs new edges.
  if (outcome == PlanUpdate::Outcome::redivided && update_->borders_hold()) {
    CertifiedPlan plan = update_->redivided(of(impl_of(set)));
    const MeshCapacity size = plan.capacity();
    if (size.triangles <= options_.max_triangles && has_32_bit_indices(size)) {
      ProvenMesh next(set, options_, tolerance_, std::move(plan), update_->facts(), isa_);
      if (Status status = next.join(impl_of(set), update_->facts(), execution); !status.ok()) return status;
      return replace(next);
    }
  }
  const Result<std::unique_ptr<ProvenMesh>> next = make(set, options_, this, execution);
  if (!next) return next.status();
  const std::size_t changed = replace(**next);
  update_->begin();
  touch_edited(impl_of(set));
  return changed;
}

std::size_t ProvenMesh::replace(ProvenMesh& next) {
  const std::size_t changed = changed_patches(next);
  tolerance_ = next.tolerance_;
  plan_ = std::move(next.plan_);
  shapes_ = std::move(next.shapes_);
  weld_ = std::move(next.weld_);
  welded_borders_ = next.welded_borders_;
  joins_ = std::move(next.joins_);
  tables_ = std::move(next.tables_);
  if (next.update_) update_ = std::move(next.update_);
  return changed;
}

std::size_t ProvenMesh::changed_patches(const ProvenMesh& other) const {
  const std::size_t patches = plan_.patch_count();
  std::vector<std::uint8_t> changed(patches, 0);
  for (std::size_t k = 0; k < patches; ++k)
    changed[k] = !(plan_.division(k) == other.plan_.division(k)) || plan_.is_f64(k) != other.plan_.is_f64(k);
  const auto compare = [&](const auto& ours, const auto& theirs) {
    if (ours == theirs) return;
    for (const auto* copies : {&ours, &theirs})
      for (const auto& copy : *copies) changed[copy.to / 4] = 1;
  };
  compare(weld_.borders, other.weld_.borders);
  compare(weld_.corners, other.weld_.corners);
  compare(weld_.poles, other.weld_.poles);
  compare(copies_in(joins_).borders, copies_in(other.joins_).borders);
  compare(copies_in(joins_).corners, copies_in(other.joins_).corners);
  compare(copies_in(joins_).poles, copies_in(other.joins_).poles);
  return static_cast<std::size_t>(std::count(changed.begin(), changed.end(), 1));
}

Status ProvenMesh::write_touched(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution) const {
  const auto blocks = update_->blocks();
  const auto for_touched = [&](std::uint32_t block, auto visit) {
    for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane)
      if (const std::uint32_t patch = set.lane_patches[block * std::size_t{PatchSet::lanes} + lane];
          update_->is_touched(set, patch))
        visit(patch);
  };
  std::size_t vertices = 0;
  for (const std::uint32_t block : blocks)
    for_touched(block,
                [&](std::uint32_t patch) { vertices += plan_.first_vertex(patch + 1) - plan_.first_vertex(patch); });
  const ParameterMaps maps(set, VertexParameters::patch);  // updates write none
  const PatchWriter writer(set, plan_, *tables_, kernel::kernels(isa_), maps, out, execution.stores,
                           sizeof(float) * vertices * (out.normal.empty() ? 3 : 6));
  const auto write_blocks = [&](std::size_t begin, std::size_t end) {
    VertexPass pass(writer);
    for (const std::uint32_t block : blocks.subspan(begin, end - begin))
      for_touched(block, [&](std::uint32_t patch) { pass.write(patch); });
    pass.finish();
  };
  if (Status status = parallel_for(blocks.size(), blocks_per_task, execution, write_blocks); !status.ok())
    return status;
  if (execution.report) {
    execution.report->isa = isa_;
    execution.report->streaming = writer.streaming();
  }
  return write_copies(set, out, {}, [&](std::size_t patch) { return update_->is_touched(set, patch); });
}

}}  // namespace tessera::abi_0_1
