#include "convert/peer_cases.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "convert/peer_obj.h"

namespace tessera::test {
namespace {

using Json = nlohmann::json;

/// A component that the peer leaves open is null in the file, NaN here.
double number_from(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Vec3 vector_from(const Json& json) {
  return {number_from(json.at(0)), number_from(json.at(1)), json.size() > 2 ? number_from(json.at(2)) : 0};
}

std::vector<double> flat(const Json& rows) {
  std::vector<double> values;
  for (const Json& row : rows)
    for (const Json& value : row) values.push_back(value.get<double>());
  return values;
}

PeerSurface surface_from(const Json& json) {
  PeerSurface surface;
  surface.name = json.at("name");
  std::vector<Vec3> points;
  for (const Json& row : json.at("control_points"))
    for (const Json& point : row) points.push_back(vector_from(point));
  surface.dimension = static_cast<int>(json.at("control_points").at(0).at(0).size());
  const int p = json.at("degree_u"), q = json.at("degree_v");
  const auto u = json.at("knots_u").get<std::vector<double>>(), v = json.at("knots_v").get<std::vector<double>>();
  const std::string kind = json.at("kind");
  const bool patch = kind == "bezier" || kind == "rational_bezier";
  if (json.at("weights").is_null()) {
    surface.add(BSplineSurface::polynomial(p, u, q, v, points));
    if (patch) surface.add(BezierPatch::polynomial(p, q, points));
  } else {
    const std::vector<double> weights = flat(json.at("weights"));
    surface.add(BSplineSurface::rational(p, u, q, v, points, weights));
    if (patch) surface.add(BezierPatch::rational(p, q, points, weights));
  }
  return surface;
}

/// All keys that an evaluation may have: an unknown one must be an error.
void check_keys(const Json& eval) {
  for (const auto& [key, value] : eval.items())
    if (key != "params" && key != "point" && key != "derivs" && key != "tolerance" && key != "tolerance_derivs" &&
        key != "normal")
      throw std::runtime_error("an evaluation states its " + key);
}

PeerEval eval_from(const Json& json, const Json& surface) {
  check_keys(json);
  PeerEval eval;
  eval.u = json.at("params").at(0);
  eval.v = json.at("params").at(1);
  if (json.contains("point")) eval.point = vector_from(json["point"]);
  double slope = 0;
  if (json.contains("derivs"))
    for (const auto& [name, value] : json["derivs"].items()) {
      eval.derivatives[name] = vector_from(value);
      if (name.size() == 2) slope = std::max(slope, max_abs(eval.derivatives[name]));
    }
  if (surface.contains("tolerance_rel_point")) {
    eval.point_tolerance = surface["tolerance_rel_point"].get<double>() * surface.at("size").get<double>();
    // The file's convention: relative to the largest component of the first derivatives; 1e-6 for the second.
    eval.first_tolerance = surface.at("tolerance_rel_derivs").get<double>() * slope;
    double bend = slope;
    for (const auto& [name, value] : eval.derivatives) bend = std::max(bend, max_abs(value));
    eval.second_tolerance = 1e-6 * bend;
  } else {
    eval.point_tolerance = json.contains("tolerance") ? json["tolerance"] : surface.at("tolerance");
    eval.first_tolerance = eval.second_tolerance = json.value("tolerance_derivs", eval.point_tolerance);
  }
  return eval;
}

/// A hit is a point of the surface, on the ray.
void add_hits(const Json& json, PeerCase& out) {
  for (const Json& ray : json.at("rays")) {
    const bool line = ray.contains("line_hits");
    for (const Json& hit : ray.at(line ? "line_hits" : "hits")) {
      PeerEval eval;
      eval.u = hit.at("u");
      eval.v = hit.at("v");
      const double t = hit.at("t");
      eval.point = vector_from(ray.at("origin")) + t * vector_from(ray.at("direction"));
      // 1e-6 of the size is the convention of the file of lines.
      eval.point_tolerance = line ? 1e-6 * json.at("size").get<double>() : ray.at("tolerance").get<double>();
      out.evals.push_back(eval);
    }
  }
}

PeerCase case_from(const Json& json) {
  PeerCase result{surface_from(json), {}};
  if (json.contains("evals"))
    for (const Json& eval : json["evals"]) result.evals.push_back(eval_from(eval, json));
  if (json.contains("unit_normal_up_to_sign"))
    for (const Json& eval : json["unit_normal_up_to_sign"]) {
      result.evals.push_back(eval_from(eval, json));
      result.evals.back().normal_up_to_sign = vector_from(eval.at("normal"));
    }
  if (json.contains("rays")) add_hits(json, result);
  return result;
}

void read_obj_case(const std::filesystem::path& data, const Json& json, PeerFile& out) {
  const std::filesystem::path path = data / json.at("file").get<std::string>();
  const std::string name = path.stem();
  if (json.at("kind") == "invalid") {
    try {
      out.invalid.push_back(read_obj_surface(path));
    } catch (const std::runtime_error& error) {
      out.elsewhere.push_back(name + ": not a whole file (" + error.what() + "), a case for readers of files");
    }
  } else if (json.at("evals").empty()) {
    out.elsewhere.push_back(name + ": without values: " + json.at("note").get<std::string>());
  } else {
    PeerCase result{read_obj_surface(path), {}};
    for (const Json& eval : json.at("evals")) result.evals.push_back(eval_from(eval, json));
    out.cases.push_back(std::move(result));
  }
}

}  // namespace

PeerFile read_peer_file(const std::filesystem::path& data, const std::filesystem::path& file) {
  const Json json = Json::parse(std::ifstream(file));
  PeerFile result;
  result.peer = json.at("peer");
  if (json.at("schema") == "obj-freeform-cases/1") {
    for (const Json& entry : json.at("cases")) read_obj_case(data, entry, result);
    return result;
  }
  for (const Json& entry : json.at("surfaces")) {
    result.cases.push_back(case_from(entry));
    if (entry.contains("rays")) result.rays += entry["rays"].size();
  }
  return result;
}

}  // namespace tessera::test
