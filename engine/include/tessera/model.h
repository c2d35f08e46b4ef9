#pragma once
// A file's worth of surfaces.

#include <span>
#include <string>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/convert.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

namespace tessera {

/// A named surface. Bezier patches are the one kind yet.
struct ModelSurface {
  std::string name;
  BezierPatch patch;
};

struct Model {
  std::string name;
  std::vector<ModelSurface> surfaces;
};

/// The patches of all surfaces; source(k).surface is the index into model.surfaces. Errors: those of PatchSet::from.
Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options = {});

/// The patches of several surfaces in one set; source(k).surface is the index into `grids`, source(k).domain the patch's
/// rectangle. Errors: those of PatchSet::from.
Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options = {});

}  // namespace tessera
