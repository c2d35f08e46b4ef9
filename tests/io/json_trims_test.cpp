// Trimming loops in .json models: surfaces of every kind may have them, and errors name their place.

#include <gtest/gtest.h>

#include <cmath>

#include "io/model_text.h"
#include "support/random_splines.h"
#include "tessera/trim_region.h"

namespace tessera::test { namespace {

/// A surface of each kind, without its closing brace.
const std::vector<std::pair<std::string, std::string>> curve_kinds{
    {"bezier", R"("points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])"},
    {"tensor", R"("basis": "power", "geometry": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])"},
    {"b_spline",
     R"("degree": 1, "knots_u": "clamped", "knots_v": "clamped", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])"},
    {"nurbs",
     R"("degree": 1, "knots_u": "clamped", "knots_v": "clamped", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]],
              "weights": [[1, 2], [3, 4]])"},
    {"sphere", R"("radius": 1)"},
    {"torus", R"("major": 2, "minor": 1)"},
    {"cylinder", R"("radius": 1, "height": 1)"},
    {"cone", R"("bottom": 1, "top": 0, "height": 1)"},
    {"revolution", R"("profile": {"kind": "bezier", "points": [[1,0,0],[1,0,1]]})"},
    {"hermite", R"("geometry": [[[0,0,0],[0,1,0],[0,1,0],[0,1,0]],[[1,0,0],[0,0,0],[0,0,0],[1,0,0]],
                [[1,0,0],[0,0,0],[0,0,0],[1,0,0]],[[1,0,0],[0,1,0],[0,1,0],[1,1,0]]])"},
    {"explicit_polynomial", R"("coefficients": [[0, 0, -1], [0, 0, 0], [1, 0, 0]])"},
    {"quadric", R"("coefficients": {"a": 1, "b": 1, "k": -1}, "range": [[0, 1], [0, 1]])"},
    {"parametric", R"("x": "u", "y": "v", "z": "u*v")"},
    {"ruled",
     R"("first": {"kind": "bezier", "points": [[0,0,0],[1,0,0]]}, "second": {"kind": "bezier", "points": [[0,1,0],[1,1,1]]})"},
    {"coons",
     R"("c1": {"kind": "bezier", "points": [[0,0,0],[1,0,0]]}, "c2": {"kind": "bezier", "points": [[0,1,0],[1,1,0]]},
              "d1": {"kind": "bezier", "points": [[0,0,0],[0,1,0]]}, "d2": {"kind": "bezier", "points": [[1,0,0],[1,1,0]]})"}};

const std::string circle = R"({"curves": [{"kind": "circle", "center": [0.5, 0.25], "radius": 0.125}], "hole": true})";

TEST(JsonTrims, SurfacesOfEveryKindHaveThem) {
  for (const auto& [kind, fields] : curve_kinds) {
    const Model model = parsed(json_with(surface_of(kind, fields + R"(, "trims": [)" + circle + "]")));
    EXPECT_TRUE(model.warnings.empty());
    const std::vector<TrimLoop>& loops = *model.surfaces.at(0).trims;
    ASSERT_EQ(loops.size(), 1u) << kind;
    EXPECT_TRUE(loops[0].hole);
    const Result<TrimRegion> region = TrimRegion::make(loops, domain(model.surfaces[0].surface));
    ASSERT_TRUE(region.ok()) << kind << region.status().message();
    EXPECT_TRUE(region->remarks().empty()) << kind;
    Random random(1);
    for (int k = 0; k < 1000; ++k) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
      const double distance = std::hypot(u - 0.5, v - 0.25) - 0.125;
      if (std::abs(distance) <= 1e-14) continue;
      EXPECT_EQ(region->locate(u, v), distance > 0 ? TrimSide::inside : TrimSide::outside) << kind;
    }
  }
}

/// The loop of these curves as text.
std::string json(const TrimLoop& loop) {
  std::string curves;
  for (const Curve& curve : loop.curves) {
    std::string points;
    for (const Vec3& p : curve.points())
      points += (points.empty() ? "[" : ", [") + test::json(p.x) + ", " + test::json(p.y) + "]";
    const std::string weights = curve.is_rational() ? R"(, "weights": )" + test::json(curve.weights()) : "";
    curves +=
        (curves.empty() ? "" : ", ") +
        surface_of(curve.is_rational() ? "nurbs" : "b_spline",
                   R"("degree": )" + std::to_string(curve.degree()) + R"(, "points": [)" + points + "]" + weights +
                       R"(, "knots": )" + test::json(curve.knots()) + R"(, "domain": )" + test::json(curve.domain()));
  }
  return R"({"curves": [)" + curves + R"(], "hole": )" + (loop.hole ? "true" : "false") + "}";
}

TEST(JsonTrims, SplinesAreReadBitForBit) {
  Random random(2);
  for (int degree = 1; degree <= max_degree; ++degree) {
    TrimLoop loop{{}, random() % 2 == 0};
    for (const bool rational : {false, true}) {
      const Curve curve = random_curve(random, degree, {}, rational);
      std::vector<Vec3> points(curve.points().begin(), curve.points().end());
      for (Vec3& p : points) p.z = 0;
      loop.curves.push_back(rational ? value_of(Curve::nurbs(degree, points, curve.weights(), curve.knots()))
                                     : value_of(Curve::b_spline(degree, points, curve.knots())));
    }
    const std::string fields = curve_kinds[0].second + R"(, "trims": [)" + json(loop) + "]";
    EXPECT_EQ(parsed(json_with(surface_of("bezier", fields))).surfaces[0].trims, std::vector{loop});
  }
}

TEST(JsonTrims, EveryKindOfCurveIsRead) {
  const std::string curves =
      R"({"kind": "bezier", "points": [["1/4", 0], [1, 0], [1, 1]], "weights": [1, "sqrt(2)/2", 1]},
      {"kind": "nurbs", "degree": 1, "knots": "clamped", "points": [[1, 1], [0, 1]], "weights": [1, 2]},
      {"kind": "b_spline", "degree": 2, "knots": [0, 0, 0, 1, 1, 1], "points": [[0, 1], [0.25, 1], [0.25, 0]], "domain": [0, 0.5]},
      {"kind": "circle", "center": ["1/3", 0.5], "radius": "1/8", "arcs": 3})";
  const std::string fields = curve_kinds[0].second + R"(, "trims": [{"curves": [)" + curves + "]}]";
  const std::vector<TrimLoop> loops = parsed(json_with(surface_of("bezier", fields))).surfaces[0].trims;
  ASSERT_EQ(loops.size(), 1u);
  ASSERT_EQ(loops[0].curves.size(), 4u);
  EXPECT_FALSE(loops[0].hole);
  EXPECT_EQ(loops[0].curves[0].points()[0], (Vec3{0.25, 0, 0}));
  EXPECT_EQ(loops[0].curves[0].weight(1), std::sqrt(2.0) / 2);
  EXPECT_EQ(loops[0].curves[2].domain(), (Interval{0, 0.5}));
  EXPECT_EQ(loops[0].curves[3].degree(), 2);
  for (int k = 0; k < 100; ++k) {
    const Vec3 p = position(loops[0].curves[3], k / 100.0);
    EXPECT_NEAR(std::hypot(p.x - 1.0 / 3, p.y - 0.5), 0.125, 1e-16);
  }
  EXPECT_TRUE(
      parsed(json_with(surface_of("bezier", curve_kinds[0].second + R"(, "trims": [])"))).surfaces[0].trims->empty());
}

std::string trims_error(const std::string& trims) {
  const Result<Model> model =
      parse_json_model(json_with(surface_of("bezier", curve_kinds[0].second + ",\n\"trims\": " + trims)), "m.json");
  EXPECT_FALSE(model.ok()) << trims;
  return model.ok() ? "" : model.status().message();
}
/// The error of this one curve, which stands on line 3.
std::string error_in_curve(const std::string& curve) { return trims_error("[{\"curves\": [" + curve + "]}]"); }

TEST(JsonTrims, ErrorsNameTheirPlace) {
  EXPECT_EQ(trims_error("1"), "m.json:3: /surfaces/0/trims: expected an array of loops, found 1");
  EXPECT_EQ(trims_error("[[]]"), "m.json:3: /surfaces/0/trims/0: expected an object, found an empty array");
  EXPECT_EQ(trims_error("[{}]"), "m.json:3: /surfaces/0/trims/0: \"curves\" is missing");
  EXPECT_EQ(trims_error(R"([{"curves": []}])"),
            "m.json:3: /surfaces/0/trims/0/curves: expected an array of curves, found an empty array");
  EXPECT_EQ(trims_error("[" + circle + ",\n{\"curve\": 1}]"),
            "m.json:4: /surfaces/0/trims/1: unknown key \"curve\"; known keys are curves, hole");
  EXPECT_EQ(trims_error(R"([{"hole": 1, "curves": [{"kind": "circle", "center": [0, 0], "radius": 1}]}])"),
            "m.json:3: /surfaces/0/trims/0/hole: expected true or false, found 1");
  EXPECT_EQ(error_in_curve("7"), "m.json:3: /surfaces/0/trims/0/curves/0: expected a curve, found 7");
  EXPECT_EQ(error_in_curve("{}"), "m.json:3: /surfaces/0/trims/0/curves/0: \"kind\" is missing");
  EXPECT_EQ(error_in_curve(R"({"kind": "parametric"})"),
            "m.json:3: /surfaces/0/trims/0/curves/0/kind: expected one of bezier, b_spline, nurbs, circle, found "
            "\"parametric\"");
  EXPECT_EQ(error_in_curve(R"({"kind": "bezier", "points": [[0, 0], [1, 1, 0]]})"),
            "m.json:3: /surfaces/0/trims/0/curves/0/points/1: expected 2 numbers [u, v], found an array of 3");
  EXPECT_EQ(error_in_curve(R"({"kind": "bezier", "points": [[0, 0], [1, "1/0"]]})").substr(0, 50),
            "m.json:3: /surfaces/0/trims/0/curves/0/points/1/1:");
  EXPECT_EQ(error_in_curve(R"({"kind": "bezier", "points": [[0, 0]]})"),
            "m.json:3: /surfaces/0/trims/0/curves/0: the degree is 0, it must be 1 to 15");
  EXPECT_EQ(error_in_curve(R"({"kind": "bezier", "points": [[0, 0], [1, 1]], "weights": [1, 0]})"),
            "m.json:3: /surfaces/0/trims/0/curves/0: weight [1] is 0, it must be finite and greater than 0");
  EXPECT_EQ(error_in_curve(R"({"kind": "circle", "radius": 1})"),
            "m.json:3: /surfaces/0/trims/0/curves/0: \"center\" is missing");
  EXPECT_EQ(error_in_curve(R"({"kind": "circle", "center": [0, 0], "radius": 0})"),
            "m.json:3: /surfaces/0/trims/0/curves/0: the radius is 0, it must be above 0");
  EXPECT_EQ(error_in_curve(R"({"kind": "circle", "axis": {}, "radius": 1})"),
            "m.json:3: /surfaces/0/trims/0/curves/0: unknown key \"axis\"; known keys are kind, center, radius, arcs");
}

}}  // namespace tessera::test
