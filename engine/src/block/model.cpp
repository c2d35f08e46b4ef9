#include "tessera/model.h"

#include <algorithm>

#include "base/guard.h"

namespace tessera {
namespace {

/// Patches of surface after surface, and where each came from.
struct Gathered {
  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  FitError fit_error;

  void add(std::size_t surface, const PatchGrid& grid) {
    patches.insert(patches.end(), grid.patches().begin(), grid.patches().end());
    for (std::size_t k = 0; k < grid.patches().size(); ++k)
      sources.push_back({static_cast<std::uint32_t>(surface), grid.patch_domain(k)});
    fit_error.distance = std::max(fit_error.distance, grid.fit_error().distance);
    fit_error.certified = fit_error.certified && grid.fit_error().certified;
  }

  Result<PatchSet> packed(PatchSetOptions options) const {
    options.fit_error = fit_error;
    return PatchSet::from(patches, sources, options);
  }
};

}  // namespace

Status in_surface(const Model& model, std::size_t surface, const Status& status) {
  const std::string& name = model.surfaces[surface].name;
  return Status(
      status.code(),
      "surface " + std::to_string(surface) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
      static_cast<std::ptrdiff_t>(surface));
}

Result<SurfaceJet> evaluate_jet(const ModelSurface& surface, double u, double v) {
  Result<SurfaceJet> jet = evaluate_jet(surface.surface, u, v);
  if (!jet) return jet;
  const Affine& map = surface.placement;
  return SurfaceJet{map.point(jet->position), map.vector(jet->du),  map.vector(jet->dv),
                    map.vector(jet->duu),     map.vector(jet->duv), map.vector(jet->dvv)};
}

Result<PatchGrid> to_bezier(const ModelSurface& surface, const FitOptions& options) {
  if (surface.placement == Affine{}) return to_bezier(surface.surface, options);
  FitOptions before = options;  // lengths before the placement
  const double norm = surface.placement.norm_bound();
  if (norm > 0) before.tolerance /= norm;
  const Result<PatchGrid> grid = to_bezier(surface.surface, before);
  return grid ? transformed(*grid, surface.placement) : grid;
}

Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options, const FitOptions& fit) {
  return guarded([&]() -> Result<PatchSet> {
    Gathered all;
    all.patches.reserve(model.surfaces.size());
    all.sources.reserve(model.surfaces.size());
    for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
      const Result<PatchGrid> grid = to_bezier(model.surfaces[k], fit);
      if (!grid) return in_surface(model, k, grid.status());
      all.add(k, *grid);
    }
    Result<PatchSet> set = all.packed(options);
    if (set || set.status().index() == Status::no_index) return set;
    return in_surface(model, all.sources[static_cast<std::size_t>(set.status().index())].surface, set.status());
  });
}

Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    Gathered all;
    for (std::size_t k = 0; k < grids.size(); ++k) all.add(k, grids[k]);
    return all.packed(options);
  });
}

}  // namespace tessera
