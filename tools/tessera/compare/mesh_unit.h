#pragma once
// The mesh of a comparison, in the unit of the model.

#include <optional>
#include <string>

#include "line/command_line.h"
#include "tessera/io.h"

namespace tessera::cli {

struct MeshUnitOptions {
  std::string unit;             ///< the mesh's; empty: the model's, or metres for glTF
  std::optional<double> scale;  ///< instead of a unit
  UpAxis up = UpAxis::z;        ///< for glTF
};
/// Adds --mesh-unit, --scale and --mesh-up.
void add_mesh_unit(Command& command, MeshUnitOptions& options);

/// How a mesh's coordinates become the model's.
struct MeshUnit {
  std::string unit;  ///< of the mesh's file; empty: none is known
  double scale = 1;  ///< coordinates are multiplied by it
};
/// Finds the scale of a mesh file for a model whose lengths have a unit, or none if `model_unit` is empty. Errors:
/// invalid_argument (options.unit, for a model without a unit that is known).
Result<MeshUnit> unit_of_mesh(const MeshUnitOptions& options, const std::string& file, const std::string& model_unit);

/// Bounds how far a vertex that was read is from that of its file, whose coordinates become floats.
double float_rounding(const Mesh& mesh);
/// Scales a mesh about the origin, in double. A scale of 1 leaves it as it is.
void scale_mesh(Mesh& mesh, double scale);

}  // namespace tessera::cli
