#include "tessera/tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/impl_access.h"
#include "base/text.h"
#include "kernel/table/kernel_table.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/mesh/certified_tessellation_impl.h"
#include "tess/plan/joins.h"
#include "tess/write/mesh_views.h"
#include "tess/write/patch_writer.h"
#include "tess/write/welded_vertices.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t patches_per_task = 64;
/// Progress after bounds and after rates; angles, pixels and searches take longer.
constexpr double planning_ends[] = {0.5, 0.95};

}  // namespace

CertifiedTessellation::Impl::Impl(const PatchSet& set, const CertifiedOptions& options, double tolerance,
                                  CertifiedPlan plan, const CertifiedPlanner& planner, Isa isa)
    : options_(options),
      tolerance_(tolerance),
      plan_(std::move(plan)),
      shapes_(planner.shapes().begin(), planner.shapes().end()),
      weld_(planner.weld()),
      origin_(set.origin()),
      fit_error_(set.fit_error()),
      revision_(set.revision()),
      isa_(isa),
      tables_(MeshTables::of(impl_of(set), shapes_, plan_.divisions(), kernel::kernels(isa).mesh_points != nullptr)) {
  for (const float bound : plan_.bounds()) bound_ = std::max(bound_, bound);
  for (const float pixels : plan_.pixels()) pixels_ = std::max(pixels_, pixels);
  for (const float angle : plan_.angles()) {
    if (std::isinf(angle)) ++without_angle_;
    if (!std::isinf(angle)) angle_ = std::max(angle_, angle);
  }
}

Status CertifiedTessellation::Impl::join(const PatchSet& set, const CertifiedPlanner& planner,
                                         const Execution& execution) {
  if (!options_.crease_angle && !options_.share_vertices) return {};
  Mesh mesh;  // written while each patch still has its own vertices
  MeshViews views;
  if (options_.crease_angle) {
    mesh = empty_mesh(plan_.capacity(), origin_);
    views = mesh.views();
    const PatchWriter writer(impl_of(set), plan_, *tables_, kernel::kernels(isa_), views, Stores::plain);
    const Execution quiet{.cancel = execution.cancel};
    const auto write = [&](std::size_t begin, std::size_t end) { writer.write(begin, end); };
    Status status = parallel_for(plan_.patch_count(), patches_per_task, quiet, write);
    if (status.ok()) status = write_welded(weld_, plan_, impl_of(set), views, quiet, [](std::size_t) { return true; });
    if (!status.ok()) return status;
  }
  joins_ = find_joins(impl_of(set), plan_, planner.edges(), weld_, options_.crease_angle ? &views.normal : nullptr,
                      options_.crease_angle.value_or(0));
  if (options_.share_vertices) plan_.share(joins_);
  return {};
}

Mesh CertifiedTessellation::Impl::allocate(const MeshCapacity& capacity) const {
  Mesh mesh = empty_mesh(capacity, origin_);
  if (!has_normals()) mesh.normals.clear();
  if (plan_.has_f64_positions()) mesh.positions_f64.resize(mesh.positions.size());
  return mesh;
}

Status CertifiedTessellation::Impl::check_normals(const MeshViews& out) const {
  if (out.normal.empty() || has_normals()) return {};
  return {StatusCode::invalid_argument, "normals of shared vertices need a crease angle"};
}

Status CertifiedTessellation::Impl::write_copies(const PatchSet::Impl& set, const MeshViews& out,
                                                 const Execution& execution,
                                                 FunctionRef<bool(std::size_t patch)> is_written) const {
  if (Status status = write_welded(weld_, plan_, set, out, execution, is_written); !status.ok()) return status;
  if (plan_.shares_vertices() || out.normal.empty()) return {};
  return write_joined_normals(joins_, plan_, out.normal, execution, is_written);
}

Status CertifiedTessellation::Impl::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  const MeshCapacity wanted = out.quads.empty() ? plan_.capacity() : plan_.quad_capacity();
  if (Status status = check_views(out, wanted, plan_.has_f64_positions()); !status.ok()) return status;
  if (Status status = check_normals(out); !status.ok()) return status;
  if (Status status = check_shapes(set, shapes_); !status.ok()) return status;
  const PatchWriter writer(impl_of(set), plan_, *tables_, kernel::kernels(isa_), out, execution.stores);
  const auto write = [&](std::size_t begin, std::size_t end) { writer.write(begin, end); };
  if (Status status = parallel_for(plan_.patch_count(), patches_per_task, execution, write); !status.ok())
    return status;
  if (execution.report) {
    execution.report->isa = isa_;
    execution.report->streaming = writer.streaming();
  }
  return write_copies(impl_of(set), out, execution, [](std::size_t) { return true; });
}

std::size_t CertifiedTessellation::Impl::divided_otherwise(const Impl& other) const {
  const std::size_t patches = plan_.patch_count();
  if (patches != other.plan_.patch_count() || plan_.is_f64() != other.plan_.is_f64())
    return std::max(patches, other.plan_.patch_count());
  std::vector<std::uint8_t> changed(patches, 0);
  for (std::size_t k = 0; k < patches; ++k) changed[k] = !(plan_.division(k) == other.plan_.division(k));
  const auto compare = [&](const auto& ours, const auto& theirs) {
    if (ours == theirs) return;
    for (const auto* copies : {&ours, &theirs})
      for (const auto& copy : *copies) changed[copy.to / 4] = 1;
  };
  compare(weld_.borders, other.weld_.borders);
  compare(weld_.corners, other.weld_.corners);
  compare(weld_.poles, other.weld_.poles);
  compare(joins_.borders, other.joins_.borders);
  compare(joins_.corners, other.joins_.corners);
  compare(joins_.poles, other.joins_.poles);
  return static_cast<std::size_t>(std::count(changed.begin(), changed.end(), 1));
}

namespace {

constexpr double max_weld = 0.05;  // a share of the model's size

/// Checks the options and turns them into those of a planner. Errors: invalid_argument.
Result<PlannerOptions> checked(const CertifiedOptions& options, const PatchSet& set) {
  const auto bad = [](const std::string& message) { return Status(StatusCode::invalid_argument, message); };
  // The conditions are written so that NaN fails.
  if (!options.tolerance && !options.angle && !options.pixels && !options.smallest)
    return bad("there is no tolerance: set a distance, an angle, pixels or the smallest");
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance)))
    return bad("the tolerance is " + text(*options.tolerance) + ", it must be finite and above 0");
  if (options.angle && !(*options.angle > 0 && *options.angle <= std::numbers::pi / 2))
    return bad("the angle is " + text(*options.angle) + " radians, it must be above 0 and at most pi / 2");
  if (options.angle_rate < 1 || options.angle_rate > max_rate)
    return bad("the angle's rate is " + std::to_string(options.angle_rate) + ", it must be from 1 to " +
               std::to_string(max_rate));
  if (options.pixels && !(options.pixels->pixels > 0 && std::isfinite(options.pixels->pixels)))
    return bad("the tolerance is " + text(options.pixels->pixels) + " pixels, it must be finite and above 0");
  const double weld = options.weld.value_or(0), size = set.box().diagonal();
  if (!(weld >= 0 && std::isfinite(weld)))
    return bad("the weld is " + text(weld) + ", it must be finite and at least 0");
  if (weld > max_weld * size && weld > 0)
    return bad("the weld is " + text(weld) + ", more than a twentieth of the model's size, " + text(size));
  if (options.crease_angle && !(*options.crease_angle >= 0 && *options.crease_angle <= std::numbers::pi))
    return bad("the crease angle is " + text(*options.crease_angle) + " radians, it must be from 0 to pi");
  PlannerOptions planner;
  if (options.weld) {
    planner.weld.reach = weld;
  } else {
    const double tolerance = options.tolerance.value_or(0) * (options.relative ? size : 1);
    planner.weld = {options.tolerance ? std::min(tolerance / 8, max_weld * size) : 1e-6 * size, true};
  }
  planner.angle = options.angle;
  planner.angle_rate = options.angle_rate;
  planner.fewest = options.fewest;
  planner.f64 = planner.f64_positions = options.precision == Precision::double_precision;
  if (!options.pixels) return planner;
  Result<Camera> camera = Camera::make(options.pixels->view);
  if (!camera) return camera.status();
  planner.camera = *camera;
  planner.pixels = options.pixels->pixels;
  return planner;
}

/// Returns the refusal, which also names the tolerance that positions in double would keep.
Status refused_in_float(const Status& refusal, const PatchSet& set, PlannerOptions planned, double tolerance,
                        const CertifiedOptions& options) {
  planned.f64_positions = true;
  const Result<CertifiedPlanner> planner = CertifiedPlanner::make(impl_of(set), planned, {});
  if (!planner) return planner.status();
  const bool keeps = !planner->is_rough(tolerance) && planner->plan(tolerance, options.max_triangles, {});
  const auto nearest = keeps ? std::optional<double>() : planner->nearest_tolerance(options.max_triangles);
  if (!keeps && !nearest) return refusal;
  return {refusal.code(), refusal.message() + "; positions in double keep " + (keeps ? "it" : text(*nearest)),
          refusal.index()};
}

/// Makes a plan. `kept`: segments that patches keep where possible; if triangles then exceed their limit, none are
/// kept.
Result<std::unique_ptr<CertifiedTessellation::Impl>> plan_for(const PatchSet& set, const CertifiedOptions& options,
                                                              const KeptSegments& kept, const Execution& execution) {
  if (!set.blocks().float_bernstein) return no_float_blocks();
  Result<PlannerOptions> planned = checked(options, set);
  if (!planned) return planned.status();
  const Result<Isa> isa = usable_isa(options.isa);
  if (!isa) return isa.status();
  double tolerance = std::numeric_limits<double>::infinity();
  if (options.tolerance) tolerance = *options.tolerance * (options.relative ? set.box().diagonal() : 1);
  if (!(tolerance > 0))
    return Status(StatusCode::invalid_argument, "the tolerance is " + text(tolerance) + ": the model has no size");
  Result<CertifiedPlanner> planner = CertifiedPlanner::make(impl_of(set), *planned, execution);
  if (!planner) return planner.status();
  const auto find_smallest = [&]() -> Status {
    if (!options.smallest) return {};
    const Result<double> found = planner->smallest_tolerance(options.max_triangles, execution);
    if (found) tolerance = *found;
    return found.status();
  };
  Status found = find_smallest();
  if (!planned->f64 && planner->needs_f64(tolerance)) {
    planned->f64 = true;
    planner = CertifiedPlanner::make(impl_of(set), *planned, execution);
    if (!planner) return planner.status();
    found = find_smallest();
  }
  if (!found.ok()) return found;
  Result<CertifiedPlan> plan = planner->plan(tolerance, options.max_triangles, execution, kept);
  if (!plan && plan.status().code() == StatusCode::invalid_argument && !kept.segments.empty())
    plan = planner->plan(tolerance, options.max_triangles, execution);
  if (!plan) {
    const bool is_rough = plan.status().code() == StatusCode::invalid_argument && planner->is_rough(tolerance);
    return is_rough && !planned->f64_positions ? refused_in_float(plan.status(), set, *planned, tolerance, options)
                                               : plan.status();
  }
  auto made = std::make_unique<CertifiedTessellation::Impl>(set, options, tolerance, std::move(*plan), *planner, *isa);
  if (Status status = made->join(set, *planner, execution); !status.ok()) return status;
  return made;
}

}  // namespace

Result<CertifiedTessellation> CertifiedTessellation::make(const PatchSet& set, const CertifiedOptions& options,
                                                          const Execution& execution) {
  return guarded([&]() -> Result<CertifiedTessellation> {
    CallProgress progress(execution, planning_ends);
    Result<std::unique_ptr<Impl>> made = plan_for(set, options, {}, progress.loops());
    if (Status status = progress.finish(made.status()); !status.ok()) return status;
    return CertifiedTessellation(std::move(*made));
  });
}

Result<CertifiedTessellation> CertifiedTessellation::retessellate(const PatchSet& set, double spare,
                                                                  const Execution& execution) const {
  return guarded([&]() -> Result<CertifiedTessellation> {
    if (!(spare >= 0 && std::isfinite(spare)))
      return Status(StatusCode::invalid_argument, "the spare is " + text(spare) + ", it must be finite and at least 0");
    if (Status status = check_count(set, impl_->plan().patch_count()); !status.ok()) return status;
    CallProgress progress(execution, planning_ends);
    Result<std::unique_ptr<Impl>> made =
        plan_for(set, impl_->options(), {impl_->plan().segments(), spare}, progress.loops());
    if (Status status = progress.finish(made.status()); !status.ok()) return status;
    return CertifiedTessellation(std::move(*made));
  });
}

std::size_t CertifiedTessellation::divided_otherwise(const CertifiedTessellation& other) const {
  return impl_->divided_otherwise(*other.impl_);
}

CertifiedTessellation::CertifiedTessellation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CertifiedTessellation::CertifiedTessellation(CertifiedTessellation&&) noexcept = default;
CertifiedTessellation& CertifiedTessellation::operator=(CertifiedTessellation&&) noexcept = default;
CertifiedTessellation::~CertifiedTessellation() = default;

double CertifiedTessellation::tolerance() const { return impl_->tolerance(); }
double CertifiedTessellation::bound() const { return impl_->bound(); }
bool CertifiedTessellation::certified() const { return impl_->certified(); }
std::span<const float> CertifiedTessellation::bounds() const { return impl_->plan().bounds(); }
double CertifiedTessellation::angle() const { return impl_->angle(); }
std::size_t CertifiedTessellation::patches_without_angle() const { return impl_->patches_without_angle(); }
std::span<const float> CertifiedTessellation::angles() const { return impl_->plan().angles(); }
double CertifiedTessellation::pixels() const { return impl_->pixels(); }
std::span<const float> CertifiedTessellation::pixel_bounds() const { return impl_->plan().pixels(); }
std::size_t CertifiedTessellation::welded_borders() const { return impl_->welded_borders(); }
std::size_t CertifiedTessellation::open_edges() const { return impl_->plan().open_edges(); }
MeshCapacity CertifiedTessellation::capacity() const { return impl_->plan().capacity(); }
MeshCapacity CertifiedTessellation::quad_capacity() const { return impl_->plan().quad_capacity(); }

Result<Mesh> CertifiedTessellation::allocate() const {
  return guarded([&]() -> Result<Mesh> { return impl_->allocate(capacity()); });
}

Result<Mesh> CertifiedTessellation::allocate_quads() const {
  return guarded([&]() -> Result<Mesh> { return impl_->allocate(quad_capacity()); });
}

Status CertifiedTessellation::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  return guarded([&] { return impl_->run(set, out, execution); });
}

}  // namespace tessera::inline abi_0_1
