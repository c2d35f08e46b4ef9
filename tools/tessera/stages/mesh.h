#pragma once
// The stage after pack: sets of patches become meshes.

#include <cstddef>
#include <string>
#include <vector>

#include "stages/file_plan.h"
#include "stages/pack.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"

namespace tessera::cli {

/// A surface with patches_beyond_tolerance().
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
  std::size_t whole_faces = 0;            ///< faces of the model that are whole, because their loops cannot be used
  std::vector<std::size_t> crossed = {};  ///< surfaces with loops that cannot be made polygons
  std::vector<RoughSurface> rough = {};
  double angle = 0;  ///< degrees
  std::size_t patches_without_angle = 0;
  double pixels = 0;
  double bound = 0;              ///< largest distance of the file's mesh and surfaces; 0: unknown
  double rounding = 0;           ///< the part of the bound that comes from the numbers of the file
  bool has_doubles = false;      ///< whether the file holds positions in double
  bool keeps_tolerances = true;  ///< false: the file's numbers are too coarse for them, or surfaces beyond them
  double gap = 0;                ///< by which faces of the file fail to meet, beside the bound
  bool proven = true;            ///< false if sampled: callables fitted without bounds on their derivatives
};

/// Whether the options let a shape be meshed once for all its instances. A budget of triangles is one for the whole
/// model, and pixels depend on where an instance stands: these need one set of all surfaces.
bool allows_shapes(const MeshOptions& options);
/// Whether the model's shapes can be meshed by the options: an angle is kept by placements that stretch evenly only.
bool suits_shapes(const MeshOptions& options, const Loaded& loaded);

/// Adds what a file adds to the bounds of a mesh, and tells whether these still keep the tolerances.
void add_file(const FilePlan& plan, const MeshOptions& options, const Box3& box, Meshed& made);

/// Meshes sets for a file with the extension of `path`, and frees them. Files other than glTF will hold one mesh of all
/// instances, which rounds once more. Errors: those of Tessellation.
Result<Meshed> mesh_sets(Packed packed, const Loaded& loaded, const MeshOptions& options, const std::string& path,
                         Timings& timings);

/// Adds the shapes of a model, in words only if they were meshed.
void add_shape_facts(Report& report, const Model& model, const Meshed& made);
/// Adds the sizes of a mesh and the tolerances that it keeps.
void add_mesh_facts(Report& report, const MeshOptions& options, const Meshed& made);
/// Adds how borders meet and which faces are not whole. A mesh of rates has none of these facts.
void add_border_facts(Report& report, const MeshOptions& options, const Meshed& made);
/// Adds the faults of --strict, which a mesh of rates does not have.
void add_faults(Report& report, const MeshOptions& options, const std::vector<std::string>& faults);

}  // namespace tessera::cli
