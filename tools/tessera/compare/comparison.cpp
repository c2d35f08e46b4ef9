#include "compare/comparison.h"

#include <array>

#include "console/console.h"
#include "tessera/surface.h"

namespace tessera::cli {
namespace {

std::string triple_text(const Vec3& p) {
  return "(" + readable(p.x) + ", " + readable(p.y) + ", " + readable(p.z) + ")";
}

/// The parameters of the model's point, in those of its surface.
std::array<double, 2> own_parameters_of(const DeviationPlace& place, const Model& model) {
  return own_parameters(model.surfaces[place.surface.surface].surface, place.surface.u, place.surface.v);
}

Json place_json(const DeviationPlace& place, const Model& model) {
  const std::array<double, 2> at = own_parameters_of(place, model);
  return {{"mesh_point", to_json(place.mesh_point)},
          {"model_point", to_json(place.surface.position)},
          {"surface", place.surface.surface},
          {"name", *model.surfaces[place.surface.surface].name},
          {"u", at[0]},
          {"v", at[1]}};
}

Json way_json(const Deviations& way, const Model& model) {
  return {{"vertices", way.vertices},
          {"samples", way.samples},
          {"largest", way.largest.distance},
          {"mean", way.mean},
          {"rms", way.rms},
          {"percentile_99", way.percentile_99},
          {"uncertified", way.uncertified},
          {"largest_at", place_json(way.largest, model)}};
}

/// The figures of one way; `from` is the side whose points are compared.
std::string way_text(const Deviations& way, const std::string& from, const Model& model) {
  const std::array<double, 2> at = own_parameters_of(way.largest, model);
  const std::string& name = *model.surfaces[way.largest.surface.surface].name;
  const auto length = [&](double value) { return length_text(value, model.unit); };
  std::string text = "largest " + length(way.largest.distance);
  if (way.samples > 0)
    text += ", mean " + length(way.mean) + ", root mean square " + length(way.rms) + ", 99% within " +
            length(way.percentile_99);
  text += "\n    points         " + counted(way.vertices, "vertex", "vertices") + " of the " + from + ", and " +
          std::to_string(way.samples) + " spread evenly" +
          (way.uncertified > 0 ? ", " + std::to_string(way.uncertified) + " not proven" : "");
  return text + "\n    largest at     " + triple_text(way.largest.mesh_point) + " of the mesh, " +
         triple_text(way.largest.surface.position) + " of surface " + std::to_string(way.largest.surface.surface) +
         (name.empty() ? "" : " (" + name + ")") + " at u, v = " + readable(at[0]) + ", " + readable(at[1]);
}

void add_sides(Report& report, const Comparison& found, const Model& model) {
  const std::optional<SignedDeviations>& sides = found.mesh.to_sides;
  const std::string label = "\n    sides          ";
  report.add("closed", sides.has_value());
  if (!sides) return report.add("sides", Json(), label + "not told: the surfaces are not closed");
  const auto length = [&](double value) { return length_text(value, model.unit); };
  report.add("sides",
             {{"outside", sides->outside}, {"inside", sides->inside}, {"mean", sides->mean}, {"unsure", sides->unsure}},
             label + length(sides->outside) + " outside, " + length(sides->inside) + " inside, mean " +
                 length(sides->mean) +
                 (sides->unsure > 0 ? ", " + counted(sides->unsure, "point") + " not certain" : ""));
}

void add_mesh(Report& report, const Comparison& found, const Model& model) {
  const std::string& unit = found.unit.unit;
  report.add("mesh", found.file);
  report.add("mesh_vertices", found.vertices,
             "\n  mesh             " + found.file + ": " + counted(found.vertices, "vertex", "vertices"));
  report.add("mesh_triangles", found.triangles, ", " + counted(found.triangles, "triangle"));
  report.add("mesh_unit", unit.empty() ? Json() : Json(unit), unit.empty() ? "" : ", in " + unit);
  report.add("scale", found.unit.scale,
             found.unit.scale == 1 ? "" : ", multiplied by " + readable(found.unit.scale, 9));
  report.add("mesh_rounding", found.rounding,
             found.rounding > 0.01 * found.largest() && found.largest() > 0
                 ? ", read as floats, within " + length_text(found.rounding, model.unit)
                 : "");
  report.add("unit", model.unit.empty() ? Json() : Json(model.unit));
}

}  // namespace

std::string length_text(double length, const std::string& unit) {
  return readable(length) + (unit.empty() ? "" : " " + unit);
}

void add_comparison(Report& report, const Comparison& found, const Model& model) {
  add_mesh(report, found, model);
  report.add("mesh_to_model", way_json(found.mesh.all, model),
             "\n  mesh to model    " + way_text(found.mesh.all, "mesh", model));
  add_sides(report, found, model);
  report.add("model_to_mesh", way_json(found.model, model),
             "\n  model to mesh    " + way_text(found.model, "model's own mesh", model));
  if (!found.tolerance) {
    report.add("tolerance", Json());
    return report.add("within_tolerance", Json());
  }
  report.add("tolerance", *found.tolerance, "\n  tolerance        " + length_text(*found.tolerance, model.unit));
  report.add("within_tolerance", found.within_tolerance(), found.within_tolerance() ? ", kept" : ", not kept");
}

}  // namespace tessera::cli
