#include "convert/peer_cases.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

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

bool is_patch(const std::string& kind) { return kind == "bezier" || kind == "rational_bezier"; }

void make_surface(const Json& json, PeerSurface& out) {
  std::vector<Vec3> points;
  for (const Json& row : json.at("control_points"))
    for (const Json& point : row) points.push_back(vector_from(point));
  out.dimension = static_cast<int>(json.at("control_points").at(0).at(0).size());
  const int p = json.at("degree_u"), q = json.at("degree_v");
  const auto u = json.at("knots_u").get<std::vector<double>>(), v = json.at("knots_v").get<std::vector<double>>();
  if (json.at("weights").is_null()) {
    out.surface = BSplineSurface::polynomial(p, u, q, v, points);
    if (is_patch(out.kind)) out.patch = BezierPatch::polynomial(p, q, points);
  } else {
    const std::vector<double> weights = flat(json.at("weights"));
    out.surface = BSplineSurface::rational(p, u, q, v, points, weights);
    if (is_patch(out.kind)) out.patch = BezierPatch::rational(p, q, points, weights);
  }
}

PeerEval eval_from(const Json& json, const Json& surface) {
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

/// The one `surf` of a Wavefront file of kind bezier or bspline: enough of the format for the cases, none of its
/// freedom.
void read_obj(const std::filesystem::path& path, PeerSurface& out) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no file " + path.string());
  std::vector<Vec3> vertices, points;
  std::vector<double> parm_u, parm_v;
  int degree_u = 0, degree_v = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    std::string key;
    in >> key;
    if (key == "v") {
      Vec3 p;
      in >> p.x >> p.y >> p.z;
      vertices.push_back(p);
    } else if (key == "deg") {
      in >> degree_u >> degree_v;
    } else if (key == "surf") {
      double ends[4];
      for (double& end : ends) in >> end;
      for (std::string reference; in >> reference;) {
        const int index = std::stoi(reference);  // what follows a slash is texture
        points.push_back(index > 0 ? vertices.at(static_cast<std::size_t>(index) - 1)
                                   : vertices.at(vertices.size() - static_cast<std::size_t>(-index)));
      }
    } else if (key == "parm") {
      in >> key;
      std::vector<double>& parm = key == "u" ? parm_u : parm_v;
      for (double value; in >> value;) parm.push_back(value);
    }
  }
  const auto knots = [&](const std::vector<double>& parm, int degree) {
    if (out.kind == "bspline") return parm;
    std::vector<double> all{parm.front()};  // breakpoints, each as a knot of full multiplicity
    for (const double t : parm) all.insert(all.end(), static_cast<std::size_t>(degree), t);
    all.push_back(parm.back());
    return all;
  };
  const std::vector<double> u = knots(parm_u, degree_u), v = knots(parm_v, degree_v);
  const std::size_t count_u = u.size() - static_cast<std::size_t>(degree_u) - 1;
  std::vector<Vec3> ordered;  // u runs fastest in the file
  for (std::size_t i = 0; i < count_u; ++i)
    for (std::size_t k = i; k < points.size(); k += count_u) ordered.push_back(points[k]);
  out.surface = BSplineSurface::polynomial(degree_u, u, degree_v, v, ordered);
}

void read_obj_case(const std::filesystem::path& data, const Json& json, PeerFile& out) {
  PeerSurface surface;
  surface.name = std::filesystem::path(json.at("file").get<std::string>()).stem();
  surface.kind = json.at("kind");
  if (!is_patch(surface.kind) && surface.kind != "bspline") {
    out.elsewhere.push_back(surface.name + ": " + std::to_string(json.at("evals").size()) + " evaluations of kind " +
                            surface.kind);
    return;
  }
  read_obj(data / json.at("file").get<std::string>(), surface);
  for (const Json& eval : json.at("evals")) surface.evals.push_back(eval_from(eval, json));
  out.surfaces.push_back(std::move(surface));
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
    if (!entry.contains("evals")) {
      result.elsewhere.push_back(entry.at("name").get<std::string>() + ": " + std::to_string(entry.at("rays").size()) +
                                 " rays");
      continue;
    }
    PeerSurface surface;
    surface.name = entry.at("name");
    surface.kind = entry.at("kind");
    make_surface(entry, surface);
    for (const Json& eval : entry.at("evals")) surface.evals.push_back(eval_from(eval, entry));
    if (entry.contains("unit_normal_up_to_sign"))
      for (const Json& eval : entry["unit_normal_up_to_sign"]) {
        surface.evals.push_back(eval_from(eval, entry));
        surface.evals.back().normal_up_to_sign = vector_from(eval.at("normal"));
      }
    result.surfaces.push_back(std::move(surface));
  }
  return result;
}

}  // namespace tessera::test
