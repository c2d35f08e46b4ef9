#pragma once
// A model: the named, placed and trimmed surfaces of a file, and the shapes that they are faces of.
//
// Memory: sets and grids own theirs; a model is not kept by what is made of it. Threads: const calls on a model from
// any number of threads, if the functions of its surfaces allow it; make_patch_set() runs in the caller's TBB arena.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/brep.h"
#include "tessera/convert.h"
#include "tessera/detail/shared.h"
#include "tessera/geometry.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/surface.h"
#include "tessera/trim_loop.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A named surface, its placement in the model, and the loops that trim it. Grids ignore the loops: they see each patch
/// of a set as a whole. Copies share everything.
struct ModelSurface {
  Shared<std::string> name;                  ///< may be empty
  Surface surface;                           ///< in its own space
  Shared<Affine> placement = {};             ///< from its own space to the model's
  Shared<std::vector<TrimLoop>> trims = {};  ///< what is kept of it, in its own parameters; none: all
};

/// A face of a shape: its placement leads to the shape's space.
struct ShapeFace : ModelSurface {
  Shared<std::vector<TrimLoop>> outline = {};  ///< without trims: loops along the domain's sides, for their coedges
  std::optional<Colour> colour = {};           ///< as the file states it
};

/// A part that the file states once, and that may be placed many times: faces and the edges that they share, in the
/// part's own space. Memory: about 300 bytes per edge beside its faces.
struct Shape {
  Shared<std::string> name;          ///< may be empty
  std::vector<ShapeFace> faces;      ///< in the order of the file; coedges of their loops are indices into `edges`
  std::vector<BrepVertex> vertices;  ///< may be none
  std::vector<BrepEdge> edges;       ///< may be none
  std::vector<Shell> shells = {};    ///< a face may be in none
  std::uint32_t solid_count = 0;     ///< solids are numbers, in Shell::solid
};

/// A shape at its place in the model. Its faces are the surfaces first_surface + k, for each face k of the shape.
struct Instance {
  std::uint32_t shape = 0;            ///< index into Model::shapes
  std::size_t first_surface = 0;      ///< index into Model::surfaces
  Shared<std::string> name = {};      ///< may be empty
  Shared<Affine> placement = {};      ///< from the shape's space to the model's
  std::optional<Colour> colour = {};  ///< for faces without a colour of their own
};

/// The surfaces of a file, or those that a program makes. With instances, `surfaces` holds the instances' faces, as
/// placed_faces() of topology.h lists them, and a shape can be meshed once for all its instances. Without, `surfaces`
/// is all.
struct Model {
  std::string name;                    ///< may be empty
  std::vector<ModelSurface> surfaces;  ///< in the order of the file
  /// Parts of the file that this model lacks, one sentence each, with file and line: "part.obj:12: sp is not read".
  std::vector<std::string> warnings = {};
  std::vector<Shape> shapes = {};        ///< if the file's format has edges
  std::vector<Instance> instances = {};  ///< of all shapes
  std::string unit = {};                 ///< of all lengths: "mm"; empty: none is stated
  std::string file_unit = {};            ///< in which the file states them, in its words: "inch"; empty: as above
};

/// Returns `status`, an error, with the message "surface 3 (rim): ..." and the index 3. `surface` is below
/// model.surfaces.size().
Status in_surface(const Model& model, std::size_t surface, const Status& status);

/// Returns position and derivatives in the model, by the surface's own parameters. Errors: those of the kind,
/// non_finite (placed beyond the range of numbers).
Result<SurfaceJet> evaluate_jet(const ModelSurface& surface, double u, double v);
/// Converts to patches in the model's space; a tolerance and the fit error are lengths there. Errors: those of the
/// kind, non_finite (the placement), invalid_argument (a tolerance below what rounding leaves where the surface is
/// placed).
Result<PatchGrid> to_bezier(const ModelSurface& surface, const FitOptions& options = {});
/// Returns the surface's loops in the parameters of to_bezier()'s grid, as TrimRegion::make() takes them: the loops
/// themselves for all kinds but quadrics, see grid_parameters(). Loops of a quadric become cubics, off by at most 1e-9
/// of the ranges, as sampled; straight lines along a parameter remain so where the loop names no edges. Errors:
/// unsupported (a loop of a quadric runs over more than 64 times its ranges; index = the loop), non_finite (a loop that
/// overflows there).
Result<Shared<std::vector<TrimLoop>>> grid_trims(const ModelSurface& surface);

/// Makes one set of the patches of all surfaces. source(k).surface is the index into model.surfaces, and
/// source(k).domain the patch's rectangle of the surface's parameters. PatchSet::fit_error() is the largest of all,
/// certified if all are. Patches that trimming loops cut away are left out: see PatchSetOptions::trims. A surface whose
/// loops grid_trims() or TrimRegion::make() refuses is kept whole: see PatchSet::trim_faults().
///
/// Errors: those of the conversions and of PatchSet::make(), as "surface 3 (rim): ..." (index = the surface); those of
/// check_topology(); invalid_argument (loops cut away every patch).
Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options = {}, const FitOptions& fit = {});
/// Makes the same set of grids that to_bezier() has made of the model's surfaces, one each. Errors: as above,
/// count_mismatch.
Result<PatchSet> make_patch_set(const Model& model, std::span<const PatchGrid> grids,
                                const PatchSetOptions& options = {});

/// Makes the set of a shape's faces, in the shape's space, so that a shape is meshed once for all its instances.
/// source(k).surface is the index into shape.faces. Errors: as above.
Result<PatchSet> make_patch_set(const Shape& shape, const PatchSetOptions& options = {}, const FitOptions& fit = {});

/// Makes one set of the patches of several surfaces. source(k).surface is the index into `grids`, and source(k).domain
/// the patch's rectangle. Errors: those of PatchSet::make().
Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options = {});
/// Makes a set of the patches of one surface. A grid that is moved here gives up its patches without a copy. Errors:
/// those of PatchSet::make().
Result<PatchSet> make_patch_set(PatchGrid grid, const PatchSetOptions& options = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
