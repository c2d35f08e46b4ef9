#include "tess/mesh/edited_surfaces.h"

#include <algorithm>
#include <string>

#include "base/impl_access.h"
#include "eval/patch_edits.h"
#include "eval/touched_blocks.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Whether the patches from `first` on are those of the spline, in the order of its grid.
bool holds(const PatchSet& set, std::uint32_t number, const EditedSpline& spline, std::size_t first) {
  const auto u = spline.breaks_u(), v = spline.breaks_v();
  if (set.patch_count() - first < spline.patch_count()) return false;
  for (std::size_t a = 0, k = first; a + 1 < u.size(); ++a)
    for (std::size_t b = 0; b + 1 < v.size(); ++b, ++k) {
      const PatchSource& source = set.source(k);
      const Domain& domain = source.domain;
      const BezierPatch& patch = set.patch(k);
      if (source.surface != number || domain.u0 != u[a] || domain.u1 != u[a + 1] || domain.v0 != v[b] ||
          domain.v1 != v[b + 1] || patch.degree_u() != spline.surface().degree_u() ||
          patch.degree_v() != spline.surface().degree_v() || patch.is_rational() != spline.surface().is_rational())
        return false;
    }
  return first + spline.patch_count() == set.patch_count() ||
         set.source(first + spline.patch_count()).surface != number;
}

}  // namespace

Result<EditedSurfaces::Surface*> EditedSurfaces::surface_of(const PatchSet& set, const SurfaceEdits& edit) {
  auto found = std::ranges::find_if(surfaces_, [&](const auto& of) { return of->number == edit.surface; });
  // Copies of a spline share its knots; the one kept here keeps their memory.
  if (found != surfaces_.end() && (*found)->converted.surface().knots_u().data() == edit.spline.knots_u().data())
    return found->get();
  auto made = std::make_unique<Surface>(edit.spline);
  made->number = edit.surface;
  std::size_t first = 0;
  while (first < set.patch_count() && set.source(first).surface != edit.surface) ++first;
  if (!holds(set, edit.surface, made->converted, first))
    return Status(StatusCode::invalid_argument,
                  "the set's patches of surface " + std::to_string(edit.surface) + " are not those of this spline");
  made->first_patch = static_cast<std::uint32_t>(first);
  if (found == surfaces_.end()) found = surfaces_.insert(found, nullptr);
  *found = std::move(made);
  return found->get();
}

Result<PatchEdits> EditedSurfaces::convert(const PatchSet& set, std::span<const SurfaceEdits> edits,
                                           const Execution& execution) {
  for (const auto& surface : surfaces_) surface->is_edited = false;
  std::size_t patches = 0, points = 0;
  for (std::size_t k = 0; k < edits.size(); ++k) {
    const Result<Surface*> surface = surface_of(set, edits[k]);
    if (!surface) return edit_error(surface.status().code(), k, surface.status().message());
    if ((*surface)->is_edited)
      return edit_error(StatusCode::invalid_argument, k,
                        "surface " + std::to_string(edits[k].surface) + " has an edit already");
    (*surface)->is_edited = true;
    EditedSpline& spline = (*surface)->converted;
    if (Status status = spline.move(edits[k].points, edits[k].moved); !status.ok())
      return edit_error(status.code(), k, status.message());
    patches += spline.touched_count();
    points += spline.touched_count() * spline.patch_points();
  }
  patches_.resize(patches);
  points_.resize(points);
  patches = points = 0;
  for (const SurfaceEdits& edit : edits) {
    Surface& surface = **surface_of(set, edit);
    EditedSpline& spline = surface.converted;
    const std::span<Vec3> written(points_.data() + points, spline.touched_count() * spline.patch_points());
    std::uint32_t* const numbers = patches_.data() + patches;
    if (Status status = spline.convert(numbers, written.data(), execution); !status.ok()) return status;
    for (std::size_t k = 0; k < spline.touched_count(); ++k) numbers[k] += surface.first_patch;
    if (!(edit.placement == Affine{}))
      for (Vec3& p : written) p = edit.placement.point(p);
    patches += spline.touched_count();
    points += written.size();
  }
  return PatchEdits{patches_, points_};
}

Status EditedSurfaces::finish(const PatchSet& set, std::span<const SurfaceEdits> edits, const Status& status) {
  if (status.ok()) return status;
  for (const auto& surface : surfaces_) surface->converted.forget();
  if (status.code() != StatusCode::non_finite) return status;
  // The index is that of a patch among all that were converted.
  const std::uint32_t surface = set.source(patches_[static_cast<std::size_t>(status.index())]).surface;
  const auto found = std::ranges::find_if(edits, [&](const SurfaceEdits& edit) { return edit.surface == surface; });
  return {status.code(), status.message(), found - edits.begin()};
}

Status set_control_points(PatchSet& set, std::span<const SurfaceEdits> edits, const Execution& execution) {
  return guarded([&]() -> Status {
    EditedSurfaces surfaces;
    const Result<PatchEdits> patches = surfaces.convert(set, edits, execution);
    if (!patches) return patches.status();
    PatchSet::Impl& inner = impl_of(set);
    TouchedBlocks touched(inner);
    Status status = touched.add(inner, *patches);
    if (status.ok()) status = prepare_edits(inner, *patches, touched, execution);
    if (!status.ok()) return surfaces.finish(set, edits, status);
    const kernel::KernelTable& kernels = kernel::default_kernels();
    const auto pack = [&](std::size_t begin, std::size_t end) {
      for (const std::uint32_t block : touched.blocks().subspan(begin, end - begin))
        pack_edits(inner, *patches, touched, kernels, block);
    };
    (void)parallel_for(touched.blocks().size(), blocks_per_task, {}, pack);
    finish_edits(inner, *patches);
    return {};
  });
}

}}  // namespace tessera::abi_0_1
