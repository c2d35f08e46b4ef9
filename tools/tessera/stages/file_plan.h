#pragma once
// How much of a tolerance a mesh's file takes: formats that hold floats in the model's coordinates round positions.

#include <string>

#include "stages/mesh_options.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"

namespace tessera::cli {

/// A plan whose mesh keeps the tolerances in its file.
struct FilePlan {
  TessellationOptions options;   ///< of the library; the tolerance, if there is one, is a length
  double tolerance = 0;          ///< of the file; infinite: none
  double rounding = 0;           ///< what the file adds to the bound of the mesh
  bool has_double_sums = false;  ///< whether the file holds doubles, although the mesh has none
};

/// Returns the options for a model in this box, of which `moved` is what other steps add to the bound.
///
/// Far from zero, where floats of the file would take more than a sixteenth of the tolerance, .obj, .ply and .pvtp get
/// positions in double, unless the user has chosen. For other formats the rounding is subtracted from the tolerance if
/// it takes less than half; otherwise the file exceeds the tolerance.
FilePlan plan_for_file(const MeshOptions& options, const Box3& box, const std::string& path, double moved = 0);

/// Gives a mesh without positions in double the sums that its file holds.
void add_double_sums(Mesh& mesh);

/// Returns the pixels that a length may have in a view of points in this box.
double pixels_of_length(const View& view, const Box3& box, double length);

}  // namespace tessera::cli
