#pragma once
// STEP texts of whole parts, built instance by instance, and what their models must measure.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "io/step/read_step.h"
#include "support/synthetic_sets.h"
#include "tessera/measures.h"
#include "tessera/topology.h"

namespace tessera::test {

/// Adds instances #1, #2, ... and returns their numbers. Edges with a minus are used backwards.
class StepBuilder {
 public:
  using Numbers = std::vector<int>;

  int add(const std::string& record) {
    text_ += ref_of(++last_) + "=" + record + ";\n";
    return last_;
  }

  static std::string ref_of(int number) { return "#" + std::to_string(number); }
  static std::string real(double value) {
    char out[40];
    std::snprintf(out, sizeof out, "%#.17g", value);
    return out;
  }
  static std::string flag(bool value) { return value ? ".T." : ".F."; }
  static std::string list(const Numbers& numbers) {
    std::string out;
    for (const int number : numbers) out += (out.empty() ? "(" : ",") + ref_of(number);
    return out.empty() ? "()" : out + ")";
  }
  static std::string triple(const Vec3& p) { return "(" + real(p.x) + "," + real(p.y) + "," + real(p.z) + ")"; }

  int point(const Vec3& p) { return add("CARTESIAN_POINT(''," + triple(p) + ")"); }
  Numbers points(const std::vector<Vec3>& places) {
    Numbers out;
    for (const Vec3& p : places) out.push_back(point(p));
    return out;
  }
  int direction(const Vec3& d) { return add("DIRECTION(''," + triple(d) + ")"); }
  int axes(const Vec3& origin, const Vec3& z = {0, 0, 1}, const Vec3& x = {1, 0, 0}) {
    const int at = point(origin), up = direction(z), right = direction(x);
    return add("AXIS2_PLACEMENT_3D(''," + list({at, up, right}).substr(1));
  }
  /// A kind with a placement and numbers, such as CIRCLE or CYLINDRICAL_SURFACE.
  int placed(const std::string& kind, int axes, const std::vector<double>& numbers = {}) {
    std::string record = kind + "(''," + ref_of(axes);
    for (const double number : numbers) record += "," + real(number);
    return add(record + ")");
  }
  int vector(const Vec3& d) { return add("VECTOR(''," + ref_of(direction(d)) + "," + real(length(d)) + ")"); }
  int line(const Vec3& from, const Vec3& to) {
    const int at = point(from), along = vector(to - from);
    return add("LINE(''," + list({at, along}).substr(1));
  }
  /// One vertex at each place.
  int vertex(const Vec3& p) {
    int& number = vertices_[{p.x, p.y, p.z}];
    if (number == 0) number = add("VERTEX_POINT(''," + ref_of(point(p)) + ")");
    return number;
  }

  int edge(const Vec3& a, const Vec3& b, int curve, bool agrees = true) {
    const int start = vertex(a), end = vertex(b);
    return add("EDGE_CURVE(''," + ref_of(start) + "," + ref_of(end) + "," + ref_of(curve) + "," + flag(agrees) + ")");
  }
  /// The edge between two places: one for both directions.
  int straight(const Vec3& a, const Vec3& b) {
    const int start = vertex(a), end = vertex(b);
    if (const auto found = straight_.find({end, start}); found != straight_.end()) return -found->second;
    int& number = straight_[{start, end}];
    if (number == 0) number = edge(a, b, line(a, b));
    return number;
  }
  int loop(const Numbers& edges) {
    Numbers uses;
    for (const int one : edges)
      uses.push_back(add("ORIENTED_EDGE('',*,*," + ref_of(std::abs(one)) + "," + flag(one > 0) + ")"));
    return add("EDGE_LOOP(''," + list(uses) + ")");
  }
  int polygon_loop(const std::vector<Vec3>& corners) {
    Numbers edges;
    for (std::size_t k = 0; k < corners.size(); ++k)
      edges.push_back(straight(corners[k], corners[(k + 1) % corners.size()]));
    return loop(edges);
  }
  int vertex_loop(const Vec3& p) { return add("VERTEX_LOOP(''," + ref_of(vertex(p)) + ")"); }
  int bound(int loop, bool is_along = true, const std::string& kind = "FACE_BOUND") {
    return add(kind + "(''," + ref_of(loop) + "," + flag(is_along) + ")");
  }
  int face_of(int surface, const Numbers& bounds, bool agrees = true) {
    return add("ADVANCED_FACE(''," + list(bounds) + "," + ref_of(surface) + "," + flag(agrees) + ")");
  }
  int face(int surface, const Numbers& loops, bool agrees = true) {
    Numbers bounds;
    for (const int one : loops) bounds.push_back(bound(one));
    return face_of(surface, bounds, agrees);
  }
  /// A plane face with these loops, whose normal is z.
  int flat(const Vec3& origin, const Vec3& z, const Vec3& x, const Numbers& loops) {
    return face(placed("PLANE", axes(origin, z, x)), loops);
  }
  /// Faces of a box with outward normals, corners[k] at upper where the bit of k is set.
  Numbers box_faces(const Vec3& a, const Vec3& b) {
    const auto corner = [&](int k) { return Vec3{k & 1 ? b.x : a.x, k & 2 ? b.y : a.y, k & 4 ? b.z : a.z}; };
    constexpr int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Numbers out;
    for (const auto& side : sides) {
      const std::vector<Vec3> c{corner(side[0]), corner(side[1]), corner(side[2]), corner(side[3])};
      out.push_back(flat(c[0], cross(c[1] - c[0], c[3] - c[0]), c[1] - c[0], {polygon_loop(c)}));
    }
    return out;
  }
  int shell(const Numbers& faces, const std::string& kind = "CLOSED_SHELL") {
    return add(kind + "(''," + list(faces) + ")");
  }
  int solid(const Numbers& faces) { return add("MANIFOLD_SOLID_BREP(''," + ref_of(shell(faces)) + ")"); }

  /// The file that shows these items.
  ///
  /// - `units`: a list of instances, or empty for millimetres.
  std::string file(const Numbers& items, const Numbers& units = {}) {
    const int millimetre = add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
    const std::string used = units.empty() ? list({millimetre}) : list(units);
    const int context = add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(" + used +
                            ")REPRESENTATION_CONTEXT('',''))");
    add("SHAPE_REPRESENTATION(''," + list(items) + "," + ref_of(context) + ")");
    return whole();
  }
  /// The file as it is.
  std::string whole() const {
    return "ISO-10303-21;\nHEADER;ENDSEC;\nDATA;\n" + text_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  std::string text_;
  int last_ = 0;
  std::map<std::tuple<double, double, double>, int> vertices_;
  std::map<std::pair<int, int>, int> straight_;
};

/// Expects a model without warnings, of this area.
inline Model expect_area(const std::string& text, double area, double accuracy = 1e-9) {
  const Result<Model> model = read_step(text, "part");
  EXPECT_TRUE(model) << model.status().message() << '\n' << text;
  if (!model) return {};
  for (const std::string& warning : model->warnings) ADD_FAILURE() << warning << '\n' << text;
  const Status topology = check_topology(*model);
  EXPECT_TRUE(topology.ok()) << topology.message();
  const Result<AreaMeasures> measured = measure_surfaces(*model);
  EXPECT_TRUE(measured) << measured.status().message();
  if (!measured) return *model;
  for (const Status& fault : measured->faults) ADD_FAILURE() << fault.message() << '\n' << text;
  EXPECT_NEAR(measured->total.area.value, area, accuracy * area + measured->total.area.error) << text;
  return *model;
}

/// Expects, too, that all shells are closed, that faces meet along their edges, and that the solids have this volume.
inline Model expect_solid(const std::string& text, double area, double volume, double accuracy = 1e-9) {
  Model model = expect_area(text, area, accuracy);
  double sum = 0, error = 0;
  const Result<std::vector<BodyMeasures>> bodies = measure_solids(model);
  EXPECT_TRUE(bodies) << bodies.status().message() << '\n' << text;
  if (!bodies) return model;
  EXPECT_FALSE(bodies->empty());
  for (const BodyMeasures& body : *bodies) sum += body.volume.value, error += body.volume.error;
  EXPECT_NEAR(sum, volume, accuracy * volume + error) << text;
  EXPECT_LE(error, 1e-4 * volume);
  for (const Shape& shape : model.shapes) {
    const std::vector<bool> closed = value_of(closed_shells(shape));
    EXPECT_EQ(std::count(closed.begin(), closed.end(), false), 0) << text;
    const std::vector<double> gaps = value_of(edge_gaps(shape));
    const double gap = gaps.empty() ? 0 : *std::max_element(gaps.begin(), gaps.end());
    EXPECT_LE(gap, 10 * accuracy * std::cbrt(volume)) << text;
  }
  return model;
}

/// Expects that the normals of all faces of a convex body point away from a place within it.
inline void expect_outward(const Model& model, const Vec3& inside) {
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    const Domain d = domain(model.surfaces[k].surface);
    const SurfaceJet jet = value_of(evaluate_jet(model.surfaces[k], d.u_at(0.4), d.v_at(0.45)));
    EXPECT_GT(dot(cross(jet.du, jet.dv), jet.position - inside), 0) << "face " << k;
  }
}

}  // namespace tessera::test
