#include "stages/mesh.h"

#include <cmath>

namespace tessera::cli {
namespace {

/// The tolerances that the mesh keeps beside its bound, in words.
std::string kept(const MeshOptions& options, const Meshed& made) {
  std::string said;
  if (options.certified.angle) {
    said += ", their normals within " + readable(made.angle, 3) + " degrees";
    if (made.patches_without_angle > 0)
      said += " (except for " + counted(made.patches_without_angle, "patch", "patches") + ")";
  }
  if (options.pixels > 0) said += ", within " + readable(made.pixels, 3) + " pixels in the picture";
  if (!made.keeps_tolerances) return said + ", more than the tolerance";
  said += made.proven ? ", proven" : ", proven except for fits that are sampled";
  if (options.is_default) said += " (--relative " + readable(default_share) + ", the default)";
  if (options.certified.budget)
    said += ", the smallest tolerance for " + counted(*options.certified.budget, "triangle") + " is " +
            readable(made.tolerance);
  return said;
}

}  // namespace

void add_shape_facts(Report& report, const Model& model, const Meshed& made) {
  std::size_t solids = 0;
  for (const Instance& instance : model.instances) solids += model.shapes[instance.shape].solid_count;
  const std::string shapes = counted(model.shapes.size(), "shape") + " at " + counted(model.instances.size(), "place");
  report.add("shapes", model.shapes.size());
  report.add("instances", model.instances.size());
  report.add("solids", solids,
             !made.by_shapes ? ""
             : solids > 0    ? counted(solids, "solid") + " (" + shapes + "), "
                             : shapes + ", ");
}

void add_mesh_facts(Report& report, const MeshOptions& options, const Meshed& made) {
  report.add("vertices", made.size.vertices, counted(made.size.vertices, "vertex", "vertices") + ", ");
  report.add("triangles", made.size.triangles, counted(made.size.triangles, "triangle"));
  report.add("quads", made.size.quads, options.quads ? ", " + counted(made.size.quads, "quad") : "");
  if (options.grid) {
    report.add("rate_u", options.grid->first);
    report.add("rate_v", options.grid->second);
    return;
  }
  report.add("precision", made.has_doubles ? "double" : "float");
  report.add("default_relative", options.is_default ? Json(default_share) : Json());
  report.add("bound", made.bound, ", within " + readable(made.bound, 3) + " of the surfaces");
  report.add("certified", made.proven && made.keeps_tolerances, kept(options, made));
  report.add("tolerance", std::isinf(made.tolerance) ? Json() : Json(made.tolerance));
  report.add("weld", options.certified.joining.weld ? Json(*options.certified.joining.weld) : Json());
  report.add("gap", made.gap);
}

void add_border_facts(Report& report, const MeshOptions& options, const Meshed& made) {
  if (options.grid) return;
  if (made.gap > 0) report.say(", over gaps of up to " + readable(made.gap, 3) + " in the file");
  report.add("angle", options.certified.angle ? Json(made.angle) : Json());
  report.add("patches_without_angle", made.patches_without_angle);
  report.add("pixels", options.pixels > 0 ? Json(made.pixels) : Json());
  report.add("welded_borders", made.welded_borders,
             made.welded_borders ? ", " + counted(made.welded_borders, "border") + " welded" : "");
  report.add("open_edges", made.open_edges,
             made.open_edges ? ", " + counted(made.open_edges, "open edge") : ", closed");
  report.add("cut_patches", made.cut_patches);
  report.add("crossed_surfaces", made.crossed.size());
  report.add("rough_surfaces", made.rough.size());
}

void add_faults(Report& report, const MeshOptions& options, const std::vector<std::string>& faults) {
  if (!options.grid) report.add("faults", options.strict ? Json(faults) : Json());
}

}  // namespace tessera::cli
