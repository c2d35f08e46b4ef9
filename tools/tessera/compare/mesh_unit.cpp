#include "compare/mesh_unit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/mesh_distance.h"

namespace tessera::cli {
namespace {

bool is_gltf(const std::string& file) {
  const std::string extension = lower_extension(file);
  return extension == ".glb" || extension == ".gltf";
}

}  // namespace

void add_mesh_unit(Command& command, MeshUnitOptions& options) {
  const Option& unit = command.add_choice("--mesh-unit", {"um", "mm", "cm", "m", "km", "in", "ft"},
                                          "The unit of the mesh's coordinates [the model's; m for .glb and .gltf]",
                                          [&options](const std::string& name) { options.unit = name; });
  command
      .add_length("--scale", "FACTOR", "Multiply the mesh's coordinates by this, instead of a unit",
                  [&options](double factor) { options.scale = factor; })
      .exclude(unit);
  command.add_choice("--mesh-up", {"z", "y"},
                     "For .glb and .gltf: the axis of the model that the file's +Y is, as tessellate --up [z]",
                     [&options](const std::string& text) { options.up = text == "y" ? UpAxis::y : UpAxis::z; });
}

Result<MeshUnit> unit_of_mesh(const MeshUnitOptions& options, const std::string& file, const std::string& model_unit) {
  if (options.scale) return MeshUnit{"", *options.scale};
  const double of_model = micrometres_in(model_unit);
  if (options.unit.empty() && (of_model == 0 || !is_gltf(file))) return MeshUnit{model_unit, 1};
  if (of_model == 0)
    return Status(StatusCode::invalid_argument, "--mesh-unit: the model states " +
                                                    (model_unit.empty() ? "no unit" : "the unit " + model_unit) +
                                                    "; use --scale FACTOR");
  const std::string unit = options.unit.empty() ? "m" : options.unit;
  return MeshUnit{unit, micrometres_in(unit) / of_model};
}

double float_rounding(const Mesh& mesh) {
  double largest = 0;
  for (const float coordinate : mesh.positions) largest = std::max(largest, std::abs(double{coordinate}));
  return std::numbers::sqrt3 * 0x1p-24 * largest;  // half a unit in the last place of each coordinate
}

void scale_mesh(Mesh& mesh, double scale) {
  if (scale == 1) return;
  std::vector<double> positions;
  positions.reserve(mesh.positions.size());
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const Vec3 p = scale * render::position_of(mesh, k);
    positions.insert(positions.end(), {p.x, p.y, p.z});
  }
  mesh.model_positions = std::move(positions);
}

}  // namespace tessera::cli
