#pragma once
// Meshes of a job: of each shape once, or of all surfaces as one set.

#include <cstddef>
#include <string>
#include <vector>

#include "tessellate_options.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"

namespace tessera::cli {

/// A surface whose trimming loops are too rough for the tolerances.
struct RoughSurface {
  std::size_t surface;
  double bound;  ///< the largest distance of its mesh
};

/// The meshes of a job, and what is known of them. Counts are those of all instances.
struct Meshed {
  Mesh mesh = {};               ///< of all surfaces as one set, unless `by_shapes`
  MeshAssembly assembly = {};   ///< of the shapes
  bool by_shapes = false;       ///< whether each shape is meshed once
  MeshCapacity size = {};       ///< vertices, triangles and quads
  std::size_t patches = 0;      ///< of all surfaces
  std::size_t cut_patches = 0;  ///< those that loops cut
  FitError fit_error = {};      ///< the largest
  double tolerance = 0;         ///< infinite: none
  std::size_t welded_borders = 0, open_edges = 0;
  std::vector<std::size_t> crossed = {};  ///< surfaces with loops that cannot be made polygons
  std::vector<RoughSurface> rough = {};
  double angle = 0;  ///< degrees
  std::size_t patches_without_angle = 0;
  double pixels = 0;
  double bound = 0;    ///< largest distance of mesh and surfaces; 0: unknown
  double gap = 0;      ///< by which faces of the file fail to meet, beside the bound
  bool proven = true;  ///< false if sampled: callables fitted without bounds on their derivatives
};

/// Returns the options of the library that the command line's stand for.
TessellationOptions plan_options(const TessellateOptions& options);
/// Whether the options let a shape be meshed once for all its instances. A budget of triangles is one for the whole
/// model, and pixels depend on where an instance stands: these need one set of all surfaces.
bool allows_shapes(const TessellateOptions& options);
/// Whether the model's shapes can be meshed by the options: an angle is kept by placements that stretch evenly only.
bool suits_shapes(const TessellateOptions& options, const Loaded& loaded);

/// Meshes all surfaces as one set. Errors: those of packing and of Tessellation.
Result<Meshed> mesh_as_one(const TessellateOptions& options, const Loaded& loaded, Timings& timings);
/// Meshes each shape once. `flat`: whether the file will hold one mesh of all instances, which rounds once more.
/// Errors: as above.
Result<Meshed> mesh_shapes(const TessellateOptions& options, const Loaded& loaded, bool flat, Timings& timings);

}  // namespace tessera::cli
