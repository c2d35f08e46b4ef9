#include "tess/mesh/proven_mesh.h"

#include <algorithm>

#include "base/impl_access.h"
#include "base/text.h"
#include "kernel/table/kernel_table.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"
#include "tess/mesh/merged_mesh.h"
#include "tess/plan/joins.h"
#include "tess/plan/make_plan.h"
#include "tess/plan/refusals.h"
#include "tess/write/closed_vertices.h"
#include "tess/write/cut_vertices.h"
#include "tess/write/mesh_views.h"
#include "tess/write/patch_writer.h"
#include "tess/write/welded_vertices.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t vertices_per_task = std::size_t{1} << 15;

/// The patches of a task: fewer if each has many vertices, so that threads share them and a cancel is seen soon.
std::size_t written_per_task(const CertifiedPlan& plan) {
  const std::size_t per_patch = plan.capacity().vertices / std::max<std::size_t>(1, plan.patch_count());
  return std::clamp<std::size_t>(vertices_per_task / std::max<std::size_t>(1, per_patch), 1, patches_per_task);
}

/// Progress after bounds and after rates; angles, pixels and searches take longer.
constexpr double planning_ends[] = {0.5, 0.95};

/// Returns the refusal, which also names the tolerance that positions in double would keep.
Status refused_in_float(const Status& refusal, const PatchSet& set, PlannerOptions planned, double tolerance,
                        const TessellationOptions& options) {
  if (set.cut_count() > 0) return refusal;  // to try is to cut patches into millions of cells
  planned.f64_positions = true;
  planned.f64_patches.assign(set.patch_count(), 1);
  const Result<PlanFacts> facts = find_plan_facts(impl_of(set), planned, {});
  if (!facts) return facts.status();
  const auto is_kept = [&](const Result<CertifiedPlan>& plan) { return plan && plan->patches().rare->beyond.empty(); };
  const PlanRequest request{tolerance, planned.fewest, {}, options.max_triangles};
  const bool keeps = !is_rough(facts->needs, tolerance) && is_kept(make_limited_plan(*facts, request, {}));
  const auto nearest = keeps ? std::optional<double>() : nearest_tolerance(*facts, options.max_triangles);
  if (!keeps && !nearest) return refusal;
  return {refusal.code(), refusal.message() + "; positions in double keep " + (keeps ? "it" : text(*nearest)),
          refusal.index()};
}

/// All that is found for a set and its options.
struct Planned {
  double tolerance;
  PlanFacts facts;
  CertifiedPlan plan;
};

/// Makes a plan. `tolerance`: the distance to keep, or any if there is a budget. `kept`: segments that
/// patches keep where possible; if triangles then exceed their limit, none are kept.
Result<Planned> plan_for(const PatchSet& set, const TessellationOptions& options, double tolerance,
                         const KeptSegments& kept, const Execution& execution) {
  Result<PlannerOptions> planned = planner_options(options, set);
  if (!planned) return planned.status();
  Result<PlanFacts> facts = find_plan_facts(impl_of(set), *planned, execution);
  if (!facts) return facts.status();
  const auto find_smallest = [&]() -> Status {
    if (!options.budget) return {};
    const Result<double> found = smallest_tolerance(*facts, options.max_triangles, execution);
    if (found) tolerance = *found;
    return found.status();
  };
  Status found = find_smallest();
  if (!planned->f64_positions)
    planned->f64_patches =
        patches_that_need_f64(facts->needs, facts->borders.edges(), options.border_tolerance.value_or(tolerance));
  if (!planned->f64_positions && !planned->f64_patches.empty()) {
    // Doubles may keep a smaller tolerance than the one found, and other patches may need doubles for it.
    if (options.budget) std::ranges::fill(planned->f64_patches, 1);
    facts = find_plan_facts(impl_of(set), *planned, execution);
    if (!facts) return facts.status();
    found = find_smallest();
  }
  if (!found.ok()) return found;
  PlanRequest request{
      tolerance, planned->fewest, kept, options.max_triangles, options.border_tolerance.value_or(0), options.headroom};
  Result<CertifiedPlan> plan = make_limited_plan(*facts, request, execution);
  if (!plan && plan.status().code() == StatusCode::invalid_argument && !kept.segments.empty()) {
    request.kept = {};
    plan = make_limited_plan(*facts, request, execution);
  }
  if (plan) return Planned{tolerance, *std::move(facts), *std::move(plan)};
  const bool is_refused = plan.status().code() == StatusCode::invalid_argument && is_rough(facts->needs, tolerance);
  return is_refused && !planned->f64_positions ? refused_in_float(plan.status(), set, *planned, tolerance, options)
                                               : plan.status();
}

}  // namespace

Result<std::unique_ptr<ProvenMesh>> ProvenMesh::make(const PatchSet& set, const TessellationOptions& options,
                                                     const ProvenMesh* before, const Execution& execution) {
  if (!set.blocks().float_bernstein) return no_float_blocks();
  const Result<Isa> isa = before ? before->isa_ : usable_isa(options.isa);
  if (!isa) return isa.status();
  const Result<double> tolerance = before ? before->tolerance_ : tolerance_of(options, set);
  if (!tolerance) return tolerance.status();
  const KeptSegments kept = before && !options.border_tolerance
                                ? KeptSegments{before->plan_.patches().segments, options.spare}
                                : KeptSegments{};
  CallProgress progress(execution, planning_ends);
  Result<Planned> made = plan_for(set, options, *tolerance, kept, progress.loops());
  if (!made) return made.status();
  std::unique_ptr<ProvenMesh> mesh(
      new ProvenMesh(set, options, made->tolerance, std::move(made->plan), made->facts, *isa));
  if (Status status = mesh->join(impl_of(set), made->facts, progress.loops()); !status.ok()) return status;
  if (before && !plans_anew(impl_of(set), mesh->plan_, options))
    mesh->update_ = std::make_unique<PlanUpdate>(std::move(made->facts), mesh->of(impl_of(set)));
  (void)progress.finish({});
  return mesh;
}

Result<std::unique_ptr<Tessellation::Impl>> make_proven_mesh(const PatchSet& set, const TessellationOptions& options,
                                                             const Execution& execution) {
  TessellationOptions limited = options;
  if (options.budget) limited.max_triangles = std::min(options.max_triangles, *options.budget);
  const bool closes = impl_of(set).edges && options.joining.close_edges;
  if (options.joining.share_vertices && (closes || set.cut_count() > 0)) {
    limited.joining.share_vertices = false;
    return MergedMesh::make(set, limited, execution);
  }
  Result<std::unique_ptr<ProvenMesh>> made = ProvenMesh::make(set, limited, nullptr, execution);
  if (!made) return made.status();
  return std::unique_ptr<Tessellation::Impl>(*std::move(made));
}

ProvenMesh::ProvenMesh(const PatchSet& set, const TessellationOptions& options, double tolerance, CertifiedPlan plan,
                       const PlanFacts& facts, Isa isa)
    : options_(options),
      tolerance_(tolerance),
      plan_(std::move(plan)),
      shapes_(facts.needs.shapes().begin(), facts.needs.shapes().end()),
      weld_(facts.borders.weld()),
      welded_borders_(facts.borders.weld().joined_by_distance),
      origin_(set.origin()),
      revision_(set.revision()),
      is_certified_(set.fit_error().certified),
      isa_(isa),
      tables_(MeshTables::of(impl_of(set), plan_.patches().divisions, kernel::kernels(isa).mesh_points != nullptr)) {}

Tessellation::Impl::Proof ProvenMesh::proof() const {
  return {.tolerance = tolerance_,
          .certified = is_certified_,
          .bounds = plan_.patches().bounds,
          .angles = plan_.patches().angles,
          .pixels = plan_.patches().pixels,
          .welded_borders = welded_borders_,
          .open_edges = plan_.patches().open_edges,
          .crossed = plan_.patches().rare->crossed,
          .beyond = plan_.patches().rare->beyond,
          .gap = plan_.closed() ? plan_.closed()->gap : 0,
          .edge_gaps = plan_.closed() ? std::span<const float>(plan_.closed()->gaps) : std::span<const float>(),
          .edge_vertices = plan_.closed() && plan_.closed()->edge_vertices
                               ? std::span<const EdgeVertex>(*plan_.closed()->edge_vertices)
                               : std::span<const EdgeVertex>()};
}

Status ProvenMesh::join(const PatchSet::Impl& set, const PlanFacts& facts, const Execution& execution) {
  if (!options_.joining.crease_angle && !options_.joining.share_vertices) return {};
  const ParameterMaps maps(set, parameters());
  Mesh mesh;  // written while each patch still has its own vertices
  MeshViews views;
  if (options_.joining.crease_angle) {
    mesh = empty_mesh(plan_.capacity(), origin_);
    views = mesh.views();
    views.parameter = {};
    const PatchWriter writer(set, plan_, *tables_, kernel::kernels(isa_), maps, views, Stores::plain);
    const Execution quiet{.cancel = execution.cancel};
    const auto write = [&](std::size_t begin, std::size_t end) { writer.write(begin, end); };
    Status status = parallel_for(plan_.patch_count(), written_per_task(plan_), quiet, write);
    if (status.ok()) status = write_welded(weld_, plan_, set, views, quiet, [](std::size_t) { return true; });
    if (!status.ok()) return status;
  }
  const bool splits = options_.joining.share_vertices && has_parameters();
  joins_ = std::make_unique<VertexCopies>(
      find_joins(set, plan_, facts.borders.edges(), weld_, options_.joining.crease_angle ? &views.normal : nullptr,
                 options_.joining.crease_angle.value_or(0), splits ? &maps : nullptr));
  if (!options_.joining.share_vertices) return {};
  plan_.share(*joins_);
  weld_shared_corners();
  return {};
}

void ProvenMesh::weld_shared_corners() {
  std::vector<std::uint32_t> goals(4 * plan_.patch_count(), no_id);  // `[corner that owns a vertex]`
  std::vector<std::uint8_t> is_listed(goals.size(), 0);
  const auto note = [&](VertexCopies::Corner& copy) {
    copy.from = plan_.corner_owner(copy.from);
    goals[plan_.corner_owner(copy.to)] = copy.from;
  };
  std::ranges::for_each(weld_.poles, note);
  for (VertexCopies::Corner& copy : weld_.corners) {
    note(copy);
    is_listed[copy.to] = 1;
  }
  for (std::uint32_t corner = 0; corner < goals.size(); ++corner) {
    const std::uint32_t goal = goals[plan_.corner_owner(corner)];
    if (goal != no_id && goal != corner && !is_listed[corner]) weld_.corners.push_back({corner, goal});
  }
}

Mesh ProvenMesh::allocate() const {
  return empty_mesh(capacity(), origin_, {has_normals(), has_parameters(), plan_.patches().has_f64_positions});
}

Status ProvenMesh::check_attributes(const MeshViews& out) const {
  if (!out.normal.empty() && !has_normals())
    return {StatusCode::invalid_argument, "normals of shared vertices need a crease angle"};
  if (!out.parameter.empty() && !has_parameters())
    return {StatusCode::invalid_argument,
            "the plan has no parameters of shared vertices: ask for them when it is made"};
  return options_.quads ? Status() : check_no_quads(out);
}

Status ProvenMesh::write_copies(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution,
                                FunctionRef<bool(std::size_t patch)> is_written) const {
  if (Status status = write_welded(weld_, plan_, set, out, execution, is_written); !status.ok()) return status;
  if (plan_.shares_vertices() || out.normal.empty()) return {};
  return write_joined_normals(copies_in(joins_), plan_, out.normal, execution, is_written);
}

Status ProvenMesh::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  if (Status status = check_views(out, capacity(), plan_.patches().has_f64_positions); !status.ok()) return status;
  if (Status status = check_attributes(out); !status.ok()) return status;
  if (Status status = check_shapes(set, shapes_); !status.ok()) return status;
  const ParameterMaps maps(impl_of(set), parameters());
  const PatchWriter writer(impl_of(set), plan_, *tables_, kernel::kernels(isa_), maps, out, execution.stores);
  const auto write = [&](std::size_t begin, std::size_t end) { writer.write(begin, end); };
  if (Status status = parallel_for(plan_.patch_count(), written_per_task(plan_), execution, write); !status.ok())
    return status;
  if (execution.report) {
    execution.report->isa = isa_;
    execution.report->streaming = writer.streaming();
  }
  if (Status status = write_copies(impl_of(set), out, execution, [](std::size_t) { return true; }); !status.ok())
    return status;
  if (Status status = write_cut(impl_of(set), plan_, options_.joining.crease_angle, maps, out, execution); !status.ok())
    return status;
  return plan_.closed() ? write_closed(impl_of(set), plan_, options_.joining.crease_angle, maps, out, execution)
                        : Status();
}

}}  // namespace tessera::abi_0_1
