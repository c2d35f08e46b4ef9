#pragma once
// A file's worth of surfaces.

#include <span>
#include <string>
#include <vector>

#include "tessera/convert.h"
#include "tessera/curve.h"
#include "tessera/detail/shared.h"
#include "tessera/geometry.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/surface.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// A closed chain of curves in the surface's parameters (x = u, y = v, z = 0), each from where the one before it ends.
/// What lies inside a hole is cut away; what lies outside of all other loops too.
struct TrimLoop {
  std::vector<Curve> curves;  ///< each from where the one before it ends
  bool hole = false;          ///< false: what lies outside is cut away
};

/// A named surface, and where it stands in the model. Trims are kept for those who ask; neither patches, meshes nor rays
/// honour them yet. Copies share everything.
struct ModelSurface {
  Shared<std::string> name;                  ///< may be empty
  Surface surface;                           ///< in its own space
  Shared<Affine> placement = {};             ///< from its own space to the model's
  Shared<std::vector<TrimLoop>> trims = {};  ///< kept, not honoured
};

/// What a file holds, or a program makes.
struct Model {
  std::string name;                    ///< may be empty
  std::vector<ModelSurface> surfaces;  ///< in the order of the file
  /// What a file holds and this model does not, a sentence each, with file and line: "part.obj:12: sp is not read".
  std::vector<std::string> warnings = {};
};

/// `status` as "surface 3 (rim): ...", with the index 3.
Status in_surface(const Model& model, std::size_t surface, const Status& status);

/// Position and derivatives in the model, by the surface's own parameters. Errors: those of the kind; non_finite (placed
/// beyond the range of numbers).
Result<SurfaceJet> evaluate_jet(const ModelSurface& surface, double u, double v);
/// The patches in the model's space; a tolerance and the fit error are lengths there. Errors: those of the kind,
/// non_finite (the placement), and invalid_argument (a tolerance below what rounding leaves where the surface is placed).
Result<PatchGrid> to_bezier(const ModelSurface& surface, const FitOptions& options = {});

/// The patches of all surfaces; source(k).surface is the index into model.surfaces, source(k).domain the patch's
/// rectangle of the surface's parameters; PatchSet::fit_error() the largest of all, certified if all are. Errors: those
/// of the conversions and of PatchSet::from, as "surface 3 (rim): ..." (index = the surface).
Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options = {}, const FitOptions& fit = {});

/// The patches of several surfaces in one set; source(k).surface is the index into `grids`, source(k).domain the patch's
/// rectangle. Errors: those of PatchSet::from.
Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options = {});
/// The same of one surface; a grid that is moved here gives its patches without a copy.
Result<PatchSet> make_patch_set(PatchGrid grid, const PatchSetOptions& options = {});

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
