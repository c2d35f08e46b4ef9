#include "tessera/tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "tess/mesh/edited_surfaces.h"
#include "tess/mesh/tessellation_impl.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The largest value that is finite.
double largest(std::span<const float> values) {
  float most = 0;
  for (const float value : values)
    if (!std::isinf(value)) most = std::max(most, value);
  return double(most);
}

}  // namespace

Tessellation::Impl::Impl() = default;
Tessellation::Impl::~Impl() = default;

std::vector<EdgeVertex> Tessellation::Impl::edge_vertices() const {
  const Proof proof = this->proof();
  std::vector<EdgeVertex> all(proof.edge_vertices.begin(), proof.edge_vertices.end());
  for (EdgeVertex& one : all) one.vertex += static_cast<std::uint32_t>(before(one.patch).vertices);
  return all;
}

void Tessellation::Impl::follow(const PatchSet& set) { identity_ = impl_of(set).identity; }

Status Tessellation::Impl::check_set(const PatchSet& set) const {
  if (impl_of(set).identity == identity_) return {};
  return {StatusCode::stale, "the plan was made for another set: make a new plan for this one"};
}

Status Tessellation::Impl::set_view(const View&) {
  return {StatusCode::invalid_argument, "the plan has no tolerance in pixels that a view could be for"};
}

Result<Tessellation> Tessellation::make(const PatchSet& set, const TessellationOptions& options,
                                        const Execution& execution) {
  return guarded([&]() -> Result<Tessellation> {
    Result<std::unique_ptr<Impl>> made =
        options.rates ? make_uniform_mesh(set, options) : make_proven_mesh(set, options, execution);
    if (!made) return made.status();
    (*made)->follow(set);
    return Tessellation(*std::move(made));
  });
}

Tessellation::Tessellation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tessellation::Tessellation(Tessellation&&) noexcept = default;
Tessellation& Tessellation::operator=(Tessellation&&) noexcept = default;
Tessellation::~Tessellation() = default;

double Tessellation::bound() const {
  const std::span<const float> bounds = impl_->proof().bounds;
  return bounds.empty() ? std::numeric_limits<double>::infinity() : largest(bounds);
}
bool Tessellation::certified() const { return impl_->proof().certified; }
double Tessellation::tolerance() const { return impl_->proof().tolerance; }
std::span<const float> Tessellation::bounds() const { return impl_->proof().bounds; }

double Tessellation::angle() const { return largest(impl_->proof().angles); }
std::size_t Tessellation::patches_without_angle() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(impl_->proof().angles, [](float angle) { return std::isinf(angle); }));
}
std::span<const float> Tessellation::angles() const { return impl_->proof().angles; }
double Tessellation::gap() const { return impl_->proof().gap; }
std::span<const float> Tessellation::edge_gaps() const { return impl_->proof().edge_gaps; }
double Tessellation::pixels() const { return largest(impl_->proof().pixels); }
std::span<const float> Tessellation::pixel_bounds() const { return impl_->proof().pixels; }
std::size_t Tessellation::welded_borders() const { return impl_->proof().welded_borders; }
std::size_t Tessellation::open_edges() const { return impl_->proof().open_edges; }
std::span<const std::uint32_t> Tessellation::crossed_patches() const { return impl_->proof().crossed; }
std::span<const std::uint32_t> Tessellation::patches_beyond_tolerance() const { return impl_->proof().beyond; }
MeshCapacity Tessellation::capacity() const { return impl_->capacity(); }
MeshCapacity Tessellation::before(std::size_t patch) const { return impl_->before(patch); }

Result<Mesh> Tessellation::allocate() const {
  return guarded([&]() -> Result<Mesh> { return impl_->allocate(); });
}

Status Tessellation::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  return guarded([&] {
    const Status status = impl_->check_set(set);
    return status.ok() ? impl_->run(set, out, execution) : status;
  });
}

Result<Mesh> Tessellation::run(const PatchSet& set) const {
  Result<Mesh> mesh = allocate();
  if (!mesh) return mesh;
  if (Status status = run(set, mesh->views()); !status.ok()) return status;
  return mesh;
}

Status Tessellation::set_view(const View& view) {
  return guarded([&] { return impl_->set_view(view); });
}

Result<MeshChange> Tessellation::Impl::update_surfaces(PatchSet& set, std::span<const SurfaceEdits> edits,
                                                       const MeshViews& out, const Execution& execution) {
  if (!surfaces_) surfaces_ = std::make_unique<EditedSurfaces>();
  const Result<PatchEdits> patches = surfaces_->convert(set, edits, execution);
  if (!patches) return surfaces_->finish(set, edits, patches.status());
  Result<MeshChange> change = update(set, *patches, out, execution);
  if (Status status = surfaces_->finish(set, edits, change.status()); !status.ok()) return status;
  return change;
}

Result<MeshChange> Tessellation::update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                        const Execution& execution) {
  return guarded([&]() -> Result<MeshChange> {
    if (Status status = impl_->check_set(set); !status.ok()) return status;
    return impl_->update(set, edits, out, execution);
  });
}

Result<MeshChange> Tessellation::update(PatchSet& set, const PatchEdits& edits, Mesh& mesh,
                                        const Execution& execution) {
  Result<MeshChange> change = update(set, edits, mesh.views(), execution);
  if (!change || !change->topology) return change;
  Result<Mesh> next = allocate();
  if (!next) return next.status();
  if (Status status = run(set, next->views(), {.cancel = execution.cancel}); !status.ok()) return status;
  mesh = *std::move(next);
  return change;
}

Result<MeshChange> Tessellation::update(PatchSet& set, std::span<const SurfaceEdits> edits, const MeshViews& out,
                                        const Execution& execution) {
  return guarded([&]() -> Result<MeshChange> {
    if (Status status = impl_->check_set(set); !status.ok()) return status;
    return impl_->update_surfaces(set, edits, out, execution);
  });
}

Result<std::vector<EdgeVertex>> edge_vertices(const Tessellation& plan) {
  return guarded([&]() -> Result<std::vector<EdgeVertex>> { return impl_of(plan).edge_vertices(); });
}

double seen_bound(const Tessellation& plan) {
  const std::span<const float> bounds = plan.bounds(), pixels = plan.pixel_bounds();
  if (pixels.empty()) return plan.bound();
  float most = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k)
    if (pixels[k] > 0 && !std::isinf(bounds[k])) most = std::max(most, bounds[k]);
  return double(most);
}

}}  // namespace tessera::abi_0_1
