// B-spline and NURBS surfaces, and the NURBS of well-known shapes.

#include <algorithm>

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Repeats the first rows and columns at the end, as periodic knots need.
template <class T>
std::vector<T> wrapped(const Net<T>& net, std::size_t rows, std::size_t columns) {
  std::vector<T> elements;
  elements.reserve(rows * columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      elements.push_back(net.elements[i % net.rows * net.columns + j % net.columns]);
  return elements;
}

struct SplineNet {
  int degree_u = 0, degree_v = 0;
  std::vector<double> knots_u, knots_v, weights;
  std::vector<Vec3> points;
  std::optional<Domain> domain;

  explicit SplineNet(const Fields& fields) {
    read_degrees(fields.at("degree"));
    const Net<Vec3> net = read_vector_net(fields.at("points"));
    const Knots u = read_knots(fields.at("knots_u"), degree_u, net.rows);
    const Knots v = read_knots(fields.at("knots_v"), degree_v, net.columns);
    knots_u = u.values, knots_v = v.values;
    expect_knots(fields.at("knots_u"), u, degree_u, net.rows, "rows");
    expect_knots(fields.at("knots_v"), v, degree_v, net.columns, "columns");
    const std::size_t rows = net.rows + (u.periodic ? static_cast<std::size_t>(degree_u) : 0);
    const std::size_t columns = net.columns + (v.periodic ? static_cast<std::size_t>(degree_v) : 0);
    points = wrapped(net, rows, columns);
    if (const std::optional<JsonValue> given = fields.find("weights")) {
      const Net<double> all = read_number_net(*given, "weights");
      expect_shape(*given, all, net.rows, net.columns, "one per point");
      weights = wrapped(all, rows, columns);
    }
    if (const std::optional<JsonValue> part = fields.find("domain")) domain = read_domain(*part);
  }

 private:
  /// Reads one degree for both directions, or one for each.
  void read_degrees(const JsonValue& value) {
    if (!value.is(JsonKind::array)) {
      degree_u = degree_v = read_integer(value, 1, max_degree);
      return;
    }
    auto degree = array_of(value, "a degree, or 2 degrees [p, q]", 2).begin();
    degree_u = read_integer(*degree, 1, max_degree);
    ++degree;
    degree_v = read_integer(*degree, 1, max_degree);
  }
  static void expect_knots(const JsonValue& value, const Knots& knots, int degree, std::size_t count,
                           std::string_view of) {
    const std::size_t wanted = count + static_cast<std::size_t>(degree) + 1;
    if (value.is(JsonKind::array) && knots.values.size() != wanted)
      value.fail("expected " + std::to_string(wanted) + " knots, for " + std::to_string(count) + " " + std::string(of) +
                 " of points and degree " + std::to_string(degree) + ", found " + std::to_string(knots.values.size()));
  }
};

Axis axis_of(const Fields& fields) { return fields.get("axis", Axis{}, read_axis); }
CircleArcs arcs_of(const Fields& fields) { return fields.get("arcs", CircleArcs::four, read_arcs); }

}  // namespace

Surface read_b_spline_surface(const JsonValue& value) {
  const SurfaceFields fields(value, {"degree", "knots_u", "knots_v", "points", "domain"});
  SplineNet net(fields);
  return made(value, BSplineSurface::polynomial(net.degree_u, net.knots_u, net.degree_v, net.knots_v,
                                                std::move(net.points), net.domain));
}

Surface read_nurbs_surface(const JsonValue& value) {
  const SurfaceFields fields(value, {"degree", "knots_u", "knots_v", "points", "weights", "domain"});
  fields.at("weights");
  SplineNet net(fields);
  return made(value, BSplineSurface::rational(net.degree_u, net.knots_u, net.degree_v, net.knots_v,
                                              std::move(net.points), std::move(net.weights), net.domain));
}

Surface read_sphere(const JsonValue& value) {
  const SurfaceFields fields(value, {"radius", "axis", "arcs"});
  return made(value, make_nurbs_sphere(axis_of(fields), read_number(fields.at("radius")), arcs_of(fields)));
}

Surface read_torus(const JsonValue& value) {
  const SurfaceFields fields(value, {"major", "minor", "axis", "arcs"});
  return made(value, make_nurbs_torus(axis_of(fields), read_number(fields.at("major")), read_number(fields.at("minor")),
                                      arcs_of(fields)));
}

Surface read_cylinder(const JsonValue& value) {
  const SurfaceFields fields(value, {"radius", "height", "axis", "arcs"});
  return made(value, make_nurbs_cylinder(axis_of(fields), read_number(fields.at("radius")),
                                         read_number(fields.at("height")), arcs_of(fields)));
}

Surface read_cone(const JsonValue& value) {
  const SurfaceFields fields(value, {"bottom", "top", "height", "axis", "arcs"});
  return made(value, make_nurbs_cone(axis_of(fields), read_number(fields.at("bottom")), read_number(fields.at("top")),
                                     read_number(fields.at("height")), arcs_of(fields)));
}

Surface read_revolution(const JsonValue& value) {
  const SurfaceFields fields(value, {"profile", "axis", "arcs"});
  return made(value, make_surface_of_revolution(read_curve(fields.at("profile")), axis_of(fields), arcs_of(fields)));
}

}}  // namespace tessera::abi_0_1
