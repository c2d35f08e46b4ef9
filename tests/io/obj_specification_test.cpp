// Compares the examples that the OBJ specification prints with the formulas that it prints before them: points of
// surfaces, trimming loops. One example lost a line in print, one has a slip: their neighbours and texts show the
// intended values.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

using Blend = std::vector<double> (*)(double t);

std::vector<double> bezier_2(double t) { return {(1 - t) * (1 - t), 2 * t * (1 - t), t * t}; }
std::vector<double> bezier_3(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
std::vector<double> cardinal(double t) {
  return {(-t + 2 * t * t - t * t * t) / 2, (2 - 5 * t * t + 3 * t * t * t) / 2, (t + 4 * t * t - 3 * t * t * t) / 2,
          (t * t * t - t * t) / 2};
}
std::vector<double> bspline_3(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6,
          t * t * t / 6};
}

struct Example {
  std::string file;
  Blend blend;  // of both directions, over the range of the one piece
  std::string misprint = {}, correction = {};
};
const std::vector<Example> specified_examples{
    {"ex3_bspline_surface.obj", bspline_3, "7 8 1 2 3 4\n", "surf 0 1 0 1 13 14 15 16 9 10 11 12 5 6 7 8 1 2 3 4\n"},
    {"ex4_cardinal_surface.obj", cardinal},
    {"ex5_rational_bspline_surface.obj", bezier_2},  // open knots without inner ones: a Bezier patch
    {"ex6_trimmed_nurb_surface.obj", bezier_2, "-2.00 -2.00 -2.00 -2.00 -2.00 -2.00",
     "-2.00 -2.00 -2.00 2.00 2.00 2.00"},
    {"ex7_two_trims_with_holes.obj",
     [](double t) {
       return std::vector{1 - t, t};
     }},
    {"ss_bezier_patch.obj", bezier_3},
};

using Point4 = std::array<double, 4>;

/// The text read line by line: the range, and homogeneous control points with u first.
struct Printed {
  std::array<double, 4> range{};
  std::vector<Point4> points;
};

Printed printed_number(std::string text) {
  for (std::size_t at; (at = text.find("\\\n")) != std::string::npos;) text.replace(at, 2, " ");
  std::vector<Point4> vertices;
  Printed result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Point4 p{0, 0, 0, 1};
      for (double& x : p)
        if (double value; words >> value) x = value;
      for (int c = 0; c < 3; ++c) p[static_cast<std::size_t>(c)] *= p[3];
      vertices.push_back(p);
    }
    if (word != "surf") continue;
    for (double& x : result.range) words >> x;
    while (words >> word) {  // "7", "7/7" or "-3"
      const int index = std::atoi(word.c_str());
      result.points.push_back(
          vertices.at(static_cast<std::size_t>(index > 0 ? index - 1 : index + int(vertices.size()))));
    }
  }
  return result;
}

/// The point at (s, t) of the piece, which is [0,1]^2.
Vec3 by_formula(const Printed& surface, Blend blend, double s, double t) {
  const std::vector<double> along_u = blend(s), along_v = blend(t);
  Point4 sum{};
  for (std::size_t j = 0; j < along_v.size(); ++j)
    for (std::size_t i = 0; i < along_u.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        sum[c] += along_u[i] * along_v[j] * surface.points.at(j * along_u.size() + i)[c];
  return {sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
}

class ObjSpecification : public testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("TESSERA_TEST_DATA");
    if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    folder_ = std::filesystem::path(data) / "obj_freeform_spec";
  }
  std::string text_of(const Example& example) const {
    std::string text = test::content_of(folder_ / example.file);
    const std::size_t at = text.find(example.misprint);
    EXPECT_NE(at, std::string::npos) << example.file;
    return text.replace(at, example.misprint.size(), example.correction);
  }
  ModelSurface surface_of(const std::string& file) const {
    for (const Example& example : specified_examples)
      if (example.file == file) return parse_obj_freeform(text_of(example), file)->surfaces.at(0);
    throw std::runtime_error(file);
  }
  std::filesystem::path folder_;
};

TEST_F(ObjSpecification, SurfacesAreTheirFormulas) {
  for (const Example& example : specified_examples) {
    const std::string text = text_of(example);
    const Result<Model> model = parse_obj_freeform(text, example.file);
    ASSERT_TRUE(model.ok()) << model.status().message();
    ASSERT_EQ(model->surfaces.size(), 1u);
    const Printed surface = printed_number(text);
    const auto [u0, u1, v0, v1] = surface.range;
    EXPECT_EQ(domain(model->surfaces[0].surface), (Domain{u0, u1, v0, v1})) << example.file;
    for (double s = 0; s <= 1; s += 0.125)
      for (double t = 0; t <= 1; t += 0.125) {
        const Vec3 p = evaluate_jet(model->surfaces[0], u0 + s * (u1 - u0), v0 + t * (v1 - v0))->position;
        EXPECT_LE(length(p - by_formula(surface, example.blend, s, t)), 1e-14) << example.file << ' ' << s << ' ' << t;
      }
  }
}

TEST_F(ObjSpecification, TrimmingRegionsHaveTheirCornersAndHoles) {
  const ModelSurface surface = surface_of("ex7_two_trims_with_holes.obj");
  ASSERT_EQ(surface.trims->size(), 4u);
  const double lower[]{0.1, 0.3, 1.1, 1.3}, upper[]{0.9, 0.7, 1.9, 1.7};
  for (std::size_t k = 0; k < 4; ++k) {
    const TrimLoop& loop = surface.trims->at(k);
    EXPECT_EQ(loop.hole, k % 2 == 1);
    std::vector<Vec3> corners;
    for (const Curve& curve : loop.curves)
      for (const Vec3& p : curve.points())
        if (corners.empty() || corners.back() != p) corners.push_back(p);
    const double a = lower[k], b = upper[k];
    EXPECT_EQ(corners, (std::vector<Vec3>{{a, a, 0}, {b, a, 0}, {b, b, 0}, {a, b, 0}, {a, a, 0}}));
  }
}

TEST_F(ObjSpecification, TheTrimmedNurbHasItsRationalLoop) {
  const ModelSurface surface = surface_of("ex6_trimmed_nurb_surface.obj");
  ASSERT_EQ(surface.trims->size(), 1u);
  // Two cubics, from the first point through the fourth back to it.
  const std::vector<Point4> vp{{-0.675, 1.85, 0, 3}, {0.915, 1.93, 0, 1},     {2.485, 0.47, 0, 2},
                               {2.485, -1.03, 0, 1}, {1.605, -1.89, 0, 10.7}, {-0.745, -0.654, 0, 0.5},
                               {-0.675, 1.85, 0, 3}};
  const auto wanted = [&](std::size_t piece, double t) {
    const std::vector<double> blend = bezier_3(t);
    double x = 0, y = 0, w = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Point4& p = vp[3 * piece + k];
      x += blend[k] * p[3] * p[0], y += blend[k] * p[3] * p[1], w += blend[k] * p[3];
    }
    return Vec3{x / w, y / w, 0};
  };
  for (const TrimLoop& loop : *surface.trims) {
    EXPECT_FALSE(loop.hole);
    for (const Curve& curve : loop.curves)
      for (double t = curve.domain().from; t <= curve.domain().to; t += 0.125) {
        const std::size_t piece = t < 1 ? 0 : 1;
        EXPECT_LE(length(evaluate_jet(curve, t).position - wanted(piece, t - double(piece))), 1e-14) << t;
      }
  }
}

}}  // namespace tessera
