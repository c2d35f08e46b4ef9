#include "tessera/model.h"

#include "base/guard.h"
#include "block/patch_set_impl.h"

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
    std::size_t count = 0;
    for (const PatchGrid& grid : grids) count += grid.patches().size();
    std::vector<BezierPatch> patches;
    std::vector<PatchSource> sources;
    patches.reserve(count);
    sources.reserve(count);
    for (std::size_t surface = 0; surface < grids.size(); ++surface) {
      const auto u = grids[surface].breaks_u(), v = grids[surface].breaks_v();
      patches.insert(patches.end(), grids[surface].patches().begin(), grids[surface].patches().end());
      for (std::size_t a = 0; a + 1 < u.size(); ++a)
        for (std::size_t b = 0; b + 1 < v.size(); ++b)
          sources.push_back({static_cast<std::uint32_t>(surface), {u[a], u[a + 1], v[b], v[b + 1]}});
    }
    return PatchSet::Impl::make(std::move(patches), std::move(sources), options);
  });
}

}  // namespace tessera
