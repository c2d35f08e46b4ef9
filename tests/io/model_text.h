#pragma once
// Surfaces as the text of JSON models: numbers with 17 digits, so that they read back as they were.

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::test {

inline std::string json(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}
inline std::string json(const Vec3& p) { return "[" + json(p.x) + ", " + json(p.y) + ", " + json(p.z) + "]"; }
inline std::string json(const HermiteNode& n) {
  return R"({"position": )" + json(n.position) + R"(, "du": )" + json(n.du) + R"(, "dv": )" + json(n.dv) +
         R"(, "duv": )" + json(n.duv) + "}";
}

template <class T>
std::string json(std::span<const T> list) {
  std::string text;
  for (const T& element : list) text += (text.empty() ? "[" : ", ") + json(element);
  return text + "]";
}
template <class T>
std::string json(const std::vector<T>& list) {
  return json(std::span<const T>(list));
}
/// Rows [i][j] of `columns` elements.
template <class T>
std::string json_net(std::span<const T> net, std::size_t columns) {
  std::string text;
  for (std::size_t k = 0; k < net.size(); k += columns)
    text += (text.empty() ? "[" : ",\n ") + json(net.subspan(k, columns));
  return text + "]";
}
inline std::string json(const Domain& d) {
  return "[[" + json(d.u0) + ", " + json(d.u1) + "], [" + json(d.v0) + ", " + json(d.v1) + "]]";
}
inline std::string json(const Interval& d) { return "[" + json(d.from) + ", " + json(d.to) + "]"; }
inline std::string json(const Curve& curve) {
  const std::string weights = curve.is_rational() ? R"(, "weights": )" + json(curve.weights()) : "";
  return R"({"kind": ")" + std::string(curve.is_rational() ? "nurbs" : "b_spline") + R"(", "degree": )" +
         std::to_string(curve.degree()) + R"(, "points": )" + json(curve.points()) + weights + R"(, "knots": )" +
         json(curve.knots()) + R"(, "domain": )" + json(curve.domain()) + "}";
}

/// A model of one surface, on the second line.
inline std::string json_with(const std::string& surface) {
  return "{\"format\": \"tessera\", \"version\": 1, \"surfaces\": [\n" + surface + "\n]}\n";
}
/// A surface of this kind with these fields.
inline std::string surface_of(const std::string& kind, const std::string& fields) {
  return R"({"kind": ")" + kind + "\"" + (fields.empty() ? "" : ", ") + fields + "}";
}

inline Model parsed(const std::string& text) { return value_of(parse_json_model(text, "m.json")); }
/// The one surface of a kind with these fields.
template <class T>
T read_as(const std::string& kind, const std::string& fields) {
  return std::get<T>(parsed(json_with(surface_of(kind, fields))).surfaces.at(0).surface);
}

}  // namespace tessera::test
