#include "tessera/model.h"

#include "base/guard.h"

namespace tessera {

Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    std::vector<BezierPatch> patches;
    patches.reserve(model.surfaces.size());
    for (const ModelSurface& surface : model.surfaces) patches.push_back(surface.patch);
    return PatchSet::from(patches, options);
  });
}

Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    std::vector<BezierPatch> patches;
    std::vector<PatchSource> sources;
    for (std::size_t surface = 0; surface < grids.size(); ++surface) {
      const PatchGrid& grid = grids[surface];
      patches.insert(patches.end(), grid.patches().begin(), grid.patches().end());
      for (std::size_t k = 0; k < grid.patches().size(); ++k)
        sources.push_back({static_cast<std::uint32_t>(surface), grid.patch_domain(k)});
    }
    return PatchSet::from(patches, sources, options);
  });
}

}  // namespace tessera
