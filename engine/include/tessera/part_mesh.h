#pragma once
// Meshes of models in parts: each part meshes its surfaces, and together the parts have the mesh of the whole, bit for
// bit.
//
// Memory: results own theirs, arguments are not kept. Threads: calls of several parts at once, if read() and the
// functions of the model's surfaces allow it.

#include <cstdint>
#include <functional>
#include <vector>

#include "tessera/execution.h"
#include "tessera/mesh.h"
#include "tessera/model_part.h"
#include "tessera/tessellation.h"
#include "tessera/transport.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A model of which each part can read any run of surfaces, such as a file (see surface_file.h).
struct SurfaceSource {
  std::uint64_t count = 0;  ///< surfaces of the whole model
  /// Returns the surfaces from `first` until `end`, without instances.
  std::function<Result<Model>(std::uint64_t first, std::uint64_t end)> read;
};

/// Returns the distance within which other surfaces can change a part's mesh with these options: four times the largest
/// distance at which borders are joined. `box`: the whole model's. A chain of more than four borders, each joined to
/// the next, can reach farther; that is not looked for.
double part_reach(const TessellationOptions& options, const Box3& box);

/// The surfaces of a part, before they are loaded.
struct PartOutline {
  PartRun run;                        ///< the wanted ones
  std::vector<std::uint64_t> around;  ///< those around them, as part_of() finds them by boxes; increasing
  Box3 own_box, box;                  ///< of the wanted ones, and of the whole model
  FitError fit_error;                 ///< of the whole model
};

/// Finds the surfaces around a run by the boxes that parts exchange: 32 bytes for each surface that comes near another
/// part's box, 72 for each that is found, and 100 bytes for each pair of parts. All parts call it, with equal options
/// and with runs that together are the whole model, in the order of the parts; a run may be empty. The run's surfaces
/// are read once and not kept.
///
/// Errors, in all parts: invalid_argument (runs that leave a gap, overlap or end elsewhere than the model); those of
/// read() and of surface_extents(), as "part 3: ..."; those of Transport::exchange(). Memory: the run's surfaces, later
/// 50 bytes for each.
Result<PartOutline> find_part(const SurfaceSource& source, const PartRun& run, const TessellationOptions& options,
                              Transport& transport, const FitOptions& fit = {});
/// Reads the surfaces of a part, and those around it. Errors: those of read(), count_mismatch (it returned more or
/// fewer surfaces, or instances).
Result<ModelPart> load_part(const SurfaceSource& source, const PartOutline& outline);

/// Counts of a mesh that is larger than 32-bit indices reach.
struct PartCounts {
  std::uint64_t patches = 0;    ///< of the patch set
  std::uint64_t vertices = 0;   ///< of the mesh
  std::uint64_t triangles = 0;  ///< without those that quads stand for
  std::uint64_t quads = 0;      ///< if there are any
};

/// The mesh of a part's surfaces, and how it lies in that of the whole.
///
/// The mesh of the whole is that of one part after the other: its vertices, its triangles with `before.vertices` added
/// to each index, and its patches with `before.patches` added. It is bit for bit the mesh of a set of the whole model,
/// on the same instruction set.
struct PartMesh {
  Mesh mesh;              ///< indices and patches begin with 0; relative to the centre of the whole model's box
  PartCounts own;         ///< of this part
  double bound = 0;       ///< Tessellation::bound(), of the part's patches
  double gap = 0;         ///< Tessellation::gap(), of the part and what surrounds it
  bool certified = true;  ///< Tessellation::certified()
};

/// Meshes the wanted surfaces of a part, without other parts' help. A part without patches has an empty mesh.
///
/// Errors: those of make_patch_set() and Tessellation::make() (index = the surface or patch, counted from the first of
/// `part`); unsupported (share_vertices, a crease angle, a budget, surface_tolerances or `fewest`: these decide for the
/// whole mesh).
Result<PartMesh> tessellate_part(const ModelPart& part, const TessellationOptions& options,
                                 const Execution& execution = {}, const FitOptions& fit = {});

/// Sums and maxima over the meshes of all parts.
struct PartSums {
  PartCounts before;      ///< in the parts before this one
  PartCounts all;         ///< in all parts
  double bound = 0;       ///< the largest of all parts
  double gap = 0;         ///< the largest of all parts
  bool certified = true;  ///< whether those of all parts are
};

/// Learns what comes before a part's mesh in that of the whole. All parts call it with what tessellate_part() returned,
/// also where that is an error. They exchange 70 bytes for each pair of parts.
///
/// Errors, in all parts: that of the lowest part, as "part 3: ..."; invalid_argument (more triangles in all than
/// options.max_triangles); those of Transport::exchange().
Result<PartSums> sum_parts(const Result<PartMesh>& own, const TessellationOptions& options, Transport& transport);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
