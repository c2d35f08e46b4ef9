#include "picture/mesh_error.h"

#include <algorithm>

#include "line/arguments.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace tessera::cli {
namespace {

/// Points of all patches that are compared with a mesh.
constexpr std::size_t max_points = 500000;

Result<Mesh> made(const PatchSet& set, double relative, MeshError& error) {
  const Result<Tessellation> plan = Tessellation::make(set, {.tolerance = relative,
                                                             .relative = true,
                                                             .joining = {.weld = 1e-6 * set.box().diagonal()},
                                                             .parameters = VertexParameters::patch});
  if (!plan) return plan.status();
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  if (const Status status = plan->run(set, mesh->views()); !status.ok()) return status;
  error.red = plan->bound();
  error.certified = plan->certified();
  return mesh;
}

double largest(const render::MeshDistance& mesh, const PatchSet& set) {
  int steps = 32;
  while (steps > 2 && set.patch_count() * static_cast<std::size_t>(steps * steps) > max_points) steps /= 2;
  const double size = set.box().diagonal();
  double most = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j)
        most = std::max(most, mesh.distance(de_casteljau(set.patch(k), double(i) / steps, double(j) / steps), size));
  return most;
}

}  // namespace

void MeshError::add_to(Report& report) const {
  report.add("error", {{"triangles", triangles}, {"found", found}, {"red", red}, {"certified", certified}},
             "\n" + std::to_string(triangles) + " triangles, up to " + readable(found, 3) +
                 " from the surfaces; red is " + readable(red, 3) + (certified ? ", the proven bound" : ""));
}

std::string MeshError::caption() const {
  return "red: " + readable(red, 3) + ", mesh: " + std::to_string(triangles) + " triangles";
}

void add_error_options(Command& command, MeshErrorOptions& options, const Option& shade) {
  const Option& mesh =
      command
          .add_text("--mesh", "FILE",
                    "The mesh whose distance --shade error shows (.obj, .ply, .stl, .glb, .gltf) [a certified mesh]",
                    options.mesh)
          .check(fault_of_name)
          .need(shade);
  command
      .add_length("--relative", "SHARE",
                  "The tolerance of the certified mesh that --shade error shows, a share of the model's size [0.001]",
                  [&options](double share) { options.relative = share; })
      .need(shade)
      .exclude(mesh);
}

void check_error_options(Command& command, render::Shade shade) {
  if (command.option("--mesh").count + command.option("--relative").count > 0 && shade != render::Shade::error)
    throw UsageError("--shade", "--mesh and --relative need --shade error");
}

Result<MeshError> measure_error(const MeshErrorOptions& options, const PatchSet& set) {
  MeshError error;
  std::vector<std::string> warnings;
  const Result<Mesh> mesh =
      options.mesh.empty() ? made(set, options.relative, error) : read_mesh(options.mesh, {.warnings = &warnings});
  for (const std::string& warning : warnings) warn(warning);
  if (!mesh) return mesh.status();
  Result<render::MeshDistance> distance = render::MeshDistance::make(*mesh);
  if (!distance) return options.mesh.empty() ? distance.status() : in_file(options.mesh, distance.status());
  error.triangles = mesh->triangle_count();
  error.found = largest(*distance, set);
  if (!options.mesh.empty()) error.red = error.found;
  error.red = std::max(error.red, 1e-12 * set.box().diagonal());  // above 0 also for an exact mesh
  error.mesh = std::make_shared<const render::MeshDistance>(std::move(*distance));
  return error;
}

}  // namespace tessera::cli
