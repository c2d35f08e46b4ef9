#pragma once
// The result of a comparison, and its report.

#include <algorithm>
#include <optional>
#include <string>

#include "compare/deviations.h"
#include "compare/mesh_unit.h"
#include "console/report.h"
#include "stages/load.h"

namespace tessera::cli {

/// All that is found about a mesh and a model.
struct Comparison {
  std::string file;  ///< of the mesh
  MeshUnit unit;
  std::size_t vertices = 0, triangles = 0;  ///< of the mesh
  double rounding = 0;                      ///< how far off vertices may be, because they are read as floats
  MeshDeviations mesh;                      ///< the deviations of the mesh from the model
  Deviations model;                         ///< those of the model from the mesh
  std::optional<double> tolerance;          ///< of the user

  double largest() const { return std::max(mesh.all.largest.distance, model.largest.distance); }
  bool within_tolerance() const { return !tolerance || largest() <= *tolerance; }
};

/// "0.012 mm", or the number alone if there is no unit.
std::string length_text(double length, const std::string& unit);

/// Adds all figures of a comparison with a loaded model.
void add_comparison(Report& report, const Comparison& found, const Model& model);

}  // namespace tessera::cli
