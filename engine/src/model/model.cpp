#include "tessera/model.h"

#include <algorithm>
#include <limits>

#include "base/text.h"
#include "model/model_patches.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/topology.h"
#include "trim/grid_loops.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The share of a tolerance that fits may use; the rest is for the rounding of placed points.
constexpr double share_for_fits = 0.99;

}  // namespace

Status in_surface(const Model& model, std::size_t surface, const Status& status) {
  return guarded([&] {
    const std::string& name = model.surfaces[surface].name;
    return Status(
        status.code(),
        "surface " + std::to_string(surface) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
        static_cast<std::ptrdiff_t>(surface));
  });
}

Result<SurfaceJet> evaluate_jet(const ModelSurface& surface, double u, double v) {
  return guarded([&]() -> Result<SurfaceJet> {
    Result<SurfaceJet> jet = evaluate_jet(surface.surface, u, v);
    if (!jet) return jet;
    const Affine& map = surface.placement;
    const Vec3 position = map.point(jet->position);
    if (!is_finite(position))
      return Status(StatusCode::non_finite, "the surface's point at (" + text(u) + ", " + text(v) + ") is (" +
                                                text(position.x) + ", " + text(position.y) + ", " + text(position.z) +
                                                ") after its placement, beyond the range of double");
    return SurfaceJet{position,
                      map.vector(jet->du),
                      map.vector(jet->dv),
                      map.vector(jet->duu),
                      map.vector(jet->duv),
                      map.vector(jet->dvv)};
  });
}

Result<PatchGrid> to_bezier(const ModelSurface& surface, const FitOptions& options) {
  return guarded([&]() -> Result<PatchGrid> {
    if (surface.placement == Affine{}) return to_bezier(surface.surface, options);
    FitOptions before = options;  // lengths before the placement
    const double norm = surface.placement->norm_bound();
    if (norm > 0)
      before.tolerance = std::min(share_for_fits * options.tolerance / norm, std::numeric_limits<double>::max());
    Result<PatchGrid> grid = to_bezier(surface.surface, before);
    if (grid) grid = transform(*grid, surface.placement);
    if (grid && options.tolerance > 0 && grid->fit_error().distance > options.tolerance)
      return Status(StatusCode::invalid_argument,
                    "the tolerance " + text(options.tolerance) +
                        " is below the rounding of the placed surface; the error reached is " +
                        text(grid->fit_error().distance));
    return grid;
  });
}

Result<Shared<std::vector<TrimLoop>>> grid_trims(const ModelSurface& surface) {
  return guarded([&]() -> Result<Shared<std::vector<TrimLoop>>> {
    const auto* const piece = std::get_if<QuadricPiece>(&surface.surface);
    if (!piece || surface.trims->empty()) return surface.trims;
    Result<std::vector<TrimLoop>> loops = grid_loops(*surface.trims, *piece);
    if (!loops) return loops.status();
    return Shared<std::vector<TrimLoop>>(*std::move(loops));
  });
}

Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options, const FitOptions& fit) {
  return guarded([&]() -> Result<PatchSet> {
    if (Status status = check_topology(model); !status.ok()) return status;
    ModelPatches patches(model, options);
    patches.name_edges();
    if (Status status = patches.add_all(fit); !status.ok()) return status;
    return std::move(patches).packed();
  });
}

Result<PatchSet> make_patch_set(const Model& model, std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    if (grids.size() != model.surfaces.size())
      return Status(StatusCode::count_mismatch,
                    "there are " + counted(grids.size(), "grid") + " for " + counted(model.surfaces.size(), "surface"));
    if (Status status = check_topology(model); !status.ok()) return status;
    ModelPatches patches(model, options);
    patches.name_edges();
    if (Status status = patches.add_grids(grids); !status.ok()) return status;
    return std::move(patches).packed();
  });
}

Result<PatchSet> make_patch_set(const Shape& shape, const PatchSetOptions& options, const FitOptions& fit) {
  return guarded([&]() -> Result<PatchSet> {
    if (Status status = check_topology(shape); !status.ok()) return status;
    Model faces;
    faces.surfaces.assign(shape.faces.begin(), shape.faces.end());
    ModelPatches patches(faces, options);
    patches.name_edges(shape, {}, 0);
    if (Status status = patches.add_all(fit); !status.ok()) return status;
    return std::move(patches).packed();
  });
}

Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    GatheredPatches all;
    all.reserve(grids);
    for (std::size_t k = 0; k < grids.size(); ++k) all.add(k, grids[k]);
    return std::move(all).packed(options);
  });
}

Result<PatchSet> make_patch_set(PatchGrid grid, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    GatheredPatches all;
    all.add(0, std::move(grid));
    return std::move(all).packed(options);
  });
}

}}  // namespace tessera::abi_0_1
