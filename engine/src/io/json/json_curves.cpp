// Curves of JSON models, and their parts: knots, axes.

#include <algorithm>
#include <array>

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::vector<double> weights_of(const Fields& fields, std::size_t count) {
  std::vector<double> weights;
  const std::optional<JsonValue> value = fields.find("weights");
  if (value) weights = read_numbers(*value);
  if (value && weights.size() != count)
    value->fail("expected " + std::to_string(count) + " weights, one per point, found " +
                std::to_string(weights.size()));
  return weights;
}

/// Reads a point of a curve: in space, or in a surface's parameters.
using PointReader = Vec3(const JsonValue&);

Vec3 read_parameters(const JsonValue& value) {
  auto coordinate = array_of(value, "2 numbers [u, v]", 2).begin();
  Vec3 point{.x = read_number(*coordinate)};
  ++coordinate;
  point.y = read_number(*coordinate);
  return point;
}

std::vector<Vec3> read_points(const JsonValue& value, PointReader& read) {
  std::vector<Vec3> points;
  for (const JsonValue point : array(value, "an array of points")) points.push_back(read(point));
  return points;
}

Curve read_bezier_curve(const JsonValue& value, PointReader& read) {
  const Fields fields(value, {"kind", "points", "weights", "domain"});
  const std::vector<Vec3> points = read_points(fields.at("points"), read);
  const Interval domain = fields.get("domain", Interval{}, read_interval);
  return made(value, Curve::bezier(points, weights_of(fields, points.size()), domain));
}

std::optional<Interval> part_of(const Fields& fields) {
  return fields.get("domain", std::optional<Interval>{}, [](const JsonValue& v) { return read_interval(v); });
}

/// Points and weights, wrapped around where knots are periodic.
struct CurveNet {
  int degree;
  std::vector<Vec3> points;
  std::vector<double> weights, knots;

  CurveNet(const Fields& fields, PointReader& read_point)
      : degree(read_integer(fields.at("degree"), 1, max_degree)), points(read_points(fields.at("points"), read_point)) {
    weights = weights_of(fields, points.size());
    const Knots read = read_knots(fields.at("knots"), degree, points.size());
    knots = read.values;
    for (int k = 0; read.periodic && k < degree; ++k) {
      points.push_back(points[static_cast<std::size_t>(k)]);
      if (!weights.empty()) weights.push_back(weights[static_cast<std::size_t>(k)]);
    }
  }
};

Curve read_b_spline_curve(const JsonValue& value, PointReader& read) {
  const Fields fields(value, {"kind", "degree", "points", "knots", "domain"});
  const CurveNet net(fields, read);
  return made(value, Curve::b_spline(net.degree, net.points, net.knots, part_of(fields)));
}

Curve read_nurbs_curve(const JsonValue& value, PointReader& read) {
  const Fields fields(value, {"kind", "degree", "points", "weights", "knots", "domain"});
  fields.at("weights");
  const CurveNet net(fields, read);
  return made(value, Curve::nurbs(net.degree, net.points, net.weights, net.knots, part_of(fields)));
}

Curve read_circle(const JsonValue& value) {
  const Fields fields(value, {"kind", "axis", "radius", "arcs"});
  return made(value, make_nurbs_circle(fields.get("axis", Axis{}, read_axis), read_number(fields.at("radius")),
                                       fields.get("arcs", CircleArcs::four, read_arcs)));
}

const JsonValue& object(const JsonValue& value, std::string_view what) {
  if (!value.is(JsonKind::object)) value.fail_expected(what);
  return value;
}

JsonValue kind_of(const JsonValue& value) {
  const std::optional<JsonValue> kind = object(value, "a curve").find("kind");
  if (!kind) value.fail("\"kind\" is missing");
  return *kind;
}

/// Reads an exact curve; `kind` is the index of its word in bezier, b_spline, nurbs, circle.
Curve read_exact_curve(const JsonValue& value, std::size_t kind) {
  constexpr std::array curve_readers{read_bezier_curve, read_b_spline_curve, read_nurbs_curve};
  return kind < curve_readers.size() ? curve_readers[kind](value, read_vector) : read_circle(value);
}

/// Reads a circle in a surface's parameters.
Curve read_parameter_circle(const JsonValue& value) {
  const Fields fields(value, {"kind", "center", "radius", "arcs"});
  const Axis axis{.origin = read_parameters(fields.at("center"))};
  return made(value, make_nurbs_circle(axis, read_number(fields.at("radius")),
                                       fields.get("arcs", CircleArcs::four, read_arcs)));
}

}  // namespace

Curve read_curve(const JsonValue& value) {
  return read_exact_curve(value, read_word(kind_of(value), {"bezier", "b_spline", "nurbs", "circle"}));
}

BorderCurve read_border(const JsonValue& value) {
  const std::size_t kind = read_word(kind_of(value), {"bezier", "b_spline", "nurbs", "circle", "parametric"});
  if (kind == 4) return read_parametric_curve(value);
  return read_exact_curve(value, kind);
}

Curve read_parameter_curve(const JsonValue& value) {
  constexpr std::array curve_readers{read_bezier_curve, read_b_spline_curve, read_nurbs_curve};
  const std::size_t kind = read_word(kind_of(value), {"bezier", "b_spline", "nurbs", "circle"});
  return kind < curve_readers.size() ? curve_readers[kind](value, read_parameters) : read_parameter_circle(value);
}

Axis read_axis(const JsonValue& value) {
  const Fields fields(value, {"origin", "direction", "zero"});
  Axis axis;
  axis.origin = fields.get("origin", axis.origin, read_vector);
  axis.direction = fields.get("direction", axis.direction, read_vector);
  axis.zero = fields.get("zero", axis.zero, read_vector);
  return axis;
}

CircleArcs read_arcs(const JsonValue& value) { return static_cast<CircleArcs>(read_integer(value, 3, 4)); }

Knots read_knots(const JsonValue& value, int degree, std::size_t count) {
  if (!value.is(JsonKind::string)) return {read_numbers(value)};
  const std::size_t kind = read_word(value, {"clamped", "uniform", "periodic"});
  const bool clamped = kind == 0, periodic = kind == 2;
  const auto points = static_cast<std::ptrdiff_t>(count);
  if (points <= degree)
    value.fail("degree " + std::to_string(degree) + " needs " + std::to_string(degree + 1) + " points or more, found " +
               std::to_string(count));
  const std::ptrdiff_t spans = periodic ? points : points - degree;
  Knots knots{.values = {}, .periodic = periodic};
  for (std::ptrdiff_t k = -degree; k <= spans + degree; ++k)
    knots.values.push_back(static_cast<double>(clamped ? std::clamp<std::ptrdiff_t>(k, 0, spans) : k));
  return knots;
}

}}  // namespace tessera::abi_0_1
