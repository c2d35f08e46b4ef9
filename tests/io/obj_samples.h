#pragma once
// Free-form OBJ texts: pieces of them out of numbers, and small whole models.

#include <gtest/gtest.h>

#include <charconv>
#include <span>
#include <string>
#include <vector>

#include "support/random_splines.h"
#include "tessera/io.h"

namespace tessera::test {

inline std::string number_text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}
inline std::string numbers_text(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += " " + number_text(value);
  return text;
}

/// "v x y z" or, with weights, "v x y z w", a line each.
inline std::string vertices_text(std::span<const Vec3> points, std::span<const double> weights = {}) {
  std::string text;
  for (std::size_t k = 0; k < points.size(); ++k) {
    text += "v" + numbers_text(std::vector{points[k].x, points[k].y, points[k].z});
    if (!weights.empty()) text += " " + number_text(weights[k]);
    text += "\n";
  }
  return text;
}

/// " first first+1 ..", `count` of them.
inline std::string range_text(std::size_t count, std::size_t first = 1) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += " " + std::to_string(first + k);
  return text;
}

/// Attributes and one surface over the vertices 1 to `points`.
inline std::string surface_text(const std::string& attributes, const Domain& range, std::size_t points,
                                std::span<const double> parm_u, std::span<const double> parm_v) {
  return attributes + "\nsurf" + numbers_text(std::vector{range.u0, range.u1, range.v0, range.v1}) +
         range_text(points) + "\nparm u" + numbers_text(parm_u) + "\nparm v" + numbers_text(parm_v) + "\nend\n";
}

/// Rows [i][j] in the order of the file, where u runs first.
template <class T>
std::vector<T> u_first(std::span<const T> values, std::size_t count_u, std::size_t count_v) {
  std::vector<T> turned;
  for (std::size_t j = 0; j < count_v && !values.empty(); ++j)
    for (std::size_t i = 0; i < count_u; ++i) turned.push_back(values[i * count_v + j]);
  return turned;
}

inline std::string surface_text(const BSplineSurface& s) {
  return vertices_text(u_first(s.points(), s.count_u(), s.count_v()), u_first(s.weights(), s.count_u(), s.count_v())) +
         surface_text(std::string("cstype ") + (s.is_rational() ? "rat " : "") + "bspline\ndeg " +
                          std::to_string(s.degree_u()) + " " + std::to_string(s.degree_v()),
                      s.domain(), s.points().size(), s.knots_u(), s.knots_v());
}

inline Model model_of(std::string_view text) {
  Result<Model> model = parse_obj_freeform(text, "m.obj");
  if (!model) {
    ADD_FAILURE() << model.status().message() << "\n" << text;
    return {};
  }
  return *std::move(model);
}

/// The one surface of a text.
inline Surface surface_of(std::string_view text) {
  Model model = model_of(text);
  EXPECT_EQ(model.surfaces.size(), 1u);
  if (model.surfaces.empty()) std::abort();
  return std::move(model.surfaces[0].surface);
}

inline Vec3 position(const Surface& surface, double u, double v) { return evaluate_jet(surface, u, v)->position; }

/// Four corners, and a bilinear patch over them.
inline const std::string four_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n";
inline const std::string bilinear = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n";

/// One of every kind of statement, each model in a few lines.
inline std::vector<std::string> small_models() {
  const std::string unit = "\nsurf 0 1 0 1" + range_text(16) + "\nparm u 0 1\nparm v 0 1\nend\n";
  std::string vertices;
  for (int k = 0; k < 16; ++k) vertices += "v " + std::to_string(k % 4) + " " + std::to_string(k / 4) + " 0.5 1.5\n";
  const std::string trimming =
      "vp 0.1 0.1\nvp 0.9 0.1\nvp 0.5 0.9 2\ncstype rat bezier\ndeg 1\ncurv2 1 2 -1 1\nparm u 0 1 2 3\nsp 1\nend\n";
  return {
      four_vertices + bilinear,
      vertices + "cstype rat cardinal" + unit,
      vertices + "cstype taylor\ndeg 3 3" + unit,
      vertices + "cstype rat bspline\ndeg 1 3\nsurf 0 2 0.5 1 1 2 3 4 5 6 7 8 9 10 11 12\n" +
          "parm u 0 0 1 2 2\nparm v 0 0 0 0 1 1 1 1\nend\n",
      vertices + "vt 0\nvn 0 0 1\ncstype bmatrix\ndeg 1 1\nstep 1 1\nbmat u 1 -1 0 1\nbmat v 1 -1 \\\n 0 1\n" +
          "surf 0.5 2 0 1 1//-1 2/1 3 4/1/1 5 6\nparm u 0 1 2\nparm v 0 1\nend\n",
      four_vertices + trimming + "g lid\n" + bilinear.substr(0, bilinear.size() - 4) +
          "trim 0 3 1\nhole 0 1 1 1 3 1\nend\n",
      vertices + "bzp" + range_text(16) + "\nf 1 2 3\n",
  };
}

}  // namespace tessera::test
