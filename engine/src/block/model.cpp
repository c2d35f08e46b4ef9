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

}  // namespace tessera
