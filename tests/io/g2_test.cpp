// The reader of .g2 files: spline and elementary surfaces, what is skipped, and errors.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "io/reader_checks.h"
#include "support/errors.h"
#include "support/synthetic_sets.h"
#include "tessera/trim_region.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;

const std::string bent = "200 1 0 0\n3 0\n3 2\n0 0 1 2 2\n2 2\n0 0 5 5\n-1 0 0\n0 0 0\n0 -1 0\n-1 1 0\n1 1 0\n1 -1 0\n";
const std::string quarter =
    "200 1 0 4 255 0 0 255\n2 1\n3 3\n0 0 0 1 1 1\n2 2\n0 0 1 1\n"
    "1 0 1\n0.70710678118654752 0.70710678118654752 0.70710678118654752\n0 1 1\n"
    "2 0 1\n1.41421356237309505 1.41421356237309505 0.70710678118654752\n0 2 1\n";

Vec3 at(const Model& model, std::size_t surface, double u, double v) {
  const Result<SurfaceJet> jet = evaluate_jet(model.surfaces.at(surface), u, v);
  EXPECT_TRUE(jet.ok());
  return jet->position;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(G2, PointsRunAlongUFirst) {
  const Model model = model_of(parse_g2, bent);
  const auto& surface = std::get<BSplineSurface>(model.surfaces.at(0).surface);
  EXPECT_EQ(surface.degree_u(), 1);
  EXPECT_EQ(surface.count_u(), 3u);
  EXPECT_EQ(surface.count_v(), 2u);
  EXPECT_EQ(surface.domain(), (Domain{0, 2, 0, 5}));
  EXPECT_EQ(at(model, 0, 0, 0), (Vec3{-1, 0, 0}));
  EXPECT_EQ(at(model, 0, 2, 0), (Vec3{0, -1, 0}));
  EXPECT_EQ(at(model, 0, 0, 5), (Vec3{-1, 1, 0}));
  EXPECT_EQ(at(model, 0, 2, 5), (Vec3{1, -1, 0}));
}

TEST(G2, PlaneRationalSurfacesLieInZ0AndTheirPointsAreHomogeneous) {
  const Model model = model_of(parse_g2, bent + quarter);
  ASSERT_EQ(model.surfaces.size(), 2u);
  for (double u = 0; u <= 1; u += 0.125) {
    const Vec3 p = at(model, 1, u, 0.5);
    EXPECT_NEAR(std::hypot(p.x, p.y), 1.5, 1e-15);
    EXPECT_EQ(p.z, 0);
  }
  EXPECT_TRUE(model.warnings.empty());
}

TEST(G2, ElementarySurfacesHaveTheFilesParameters) {
  // Location (1,2,3), z along x, x along y: so the frame's y is z.
  const std::string frame = "\n1 2 3\n2 0 0\n0 3 0\n";
  const auto point = [](double x, double y, double z) { return Vec3{1 + z, 2 + x, 3 + y}; };
  const Model model = model_of(
      parse_g2, "250 1 0 0\n3" + frame + "1\n-1 2\n3 5\n0\n" + "260 1 0 0\n3\n2" + frame + "1\n0.5 2\n-1 4\n0\n" +
                    "270 1 0 0\n3\n1.5" + frame + "0 6.28318530717959\n-1.5707963267949 1\n0\n" + "280 1 0 0\n3\n2" +
                    frame + "0.5\n1\n0 6.283185307\n0 3\n0\n" + "280 1 0 0\n3\n2" + frame + "-0.5\n1\n0.5 2\n0 3\n0\n" +
                    "280 1 0 0\n3\n2" + frame + "0\n1\n0.5 2\n0 3\n0\n");
  ASSERT_EQ(model.surfaces.size(), 6u);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(domain(model.surfaces[0].surface), (Domain{-1, 2, 3, 5}));
  EXPECT_EQ(domain(model.surfaces[1].surface), (Domain{0.5, 2, -1, 4}));
  for (const auto& [u, v] : {std::pair(0.5, 0.0), {1.0, 0.75}, {1.5, 1.0}, {2.0, 0.25}}) {
    expect_near(at(model, 0, u, 3 + v), point(u, 3 + v, 0), 1e-15);
    expect_near(at(model, 1, u, v), point(2 * std::cos(u), 2 * std::sin(u), v), 4e-15);
    expect_near(at(model, 2, u, v),
                point(1.5 * std::cos(u) * std::cos(v), 1.5 * std::sin(u) * std::cos(v), 1.5 * std::sin(v)), 4e-15);
    // The own v of a cone is counted from its apex, where R + v tan(angle) = 0.
    const double slope = std::tan(0.5), apex = 2 / slope;
    const double wide = 2 + v * slope, narrow = 2 - v * slope;
    expect_near(at(model, 3, u, v + apex), point(wide * std::cos(u), wide * std::sin(u), v), 1e-14);
    expect_near(at(model, 4, u, v - apex), point(narrow * std::cos(u), narrow * std::sin(u), v), 1e-14);
    expect_near(at(model, 5, u, v), point(2 * std::cos(u), 2 * std::sin(u), v), 4e-15);
  }
  EXPECT_EQ(domain(model.surfaces[2].surface).v0, -pi / 2);  // printed with 14 digits
  for (const ModelSurface& surface : model.surfaces) EXPECT_TRUE(to_bezier(surface).ok());
}

TEST(G2, FlatAndSteepConesAreCones) {
  for (const double angle : {1e-6, 0.01, 1.57, 1.5707962}) {
    std::ostringstream text;
    text.precision(17);
    text << "280 1 0 0\n3\n1\n0 0 0\n0 0 1\n1 0 0\n" << angle << "\n1\n0 6.283185307179586\n0 1\n0\n";
    const Model model = model_of(parse_g2, text.str());
    ASSERT_EQ(model.surfaces.size(), 1u);
    const Domain d = domain(model.surfaces[0].surface);
    const double slope = std::tan(angle);
    for (const double u : {0.0, 1.0, 4.0}) {
      // Heights count from the apex, 1 / slope below: that costs so many digits.
      const double scale = 1e-15 * (1 + slope) * (1 + 1 / slope);
      expect_near(at(model, 0, u, d.v0), {std::cos(u), std::sin(u), 0}, 4 * scale);
      expect_near(at(model, 0, u, d.v1), {(1 + slope) * std::cos(u), (1 + slope) * std::sin(u), 1}, 4 * scale);
    }
  }
}

TEST(G2, ToriAreNurbsFromBorderToBorder) {
  const std::string frame = "\n1 2 3\n0 0 1\n1 0 0\n1\n";
  const Model model = model_of(parse_g2, "290 1 0 0\n3\n5 2" + frame + "0 6.28318530717959\n0 6.28318530717959\n0\n" +
                                             "290 1 0 0\n3\n5 2" + frame + "0.25 2.5\n-1 3\n1\n");
  ASSERT_EQ(model.surfaces.size(), 2u);
  EXPECT_EQ(model.warnings,
            std::vector<std::string>{"m: 1 elementary surface has u and v swapped in the file, but not here"});
  const auto torus = [](double u, double v) {
    const double r = 5 + 2 * std::cos(v);
    return Vec3{1 + r * std::cos(u), 2 + r * std::sin(u), 3 + 2 * std::sin(v)};
  };
  EXPECT_EQ(domain(model.surfaces[0].surface), (Domain{0, 1, 0, 1}));
  expect_near(at(model, 0, 0.25, 0.5), torus(pi / 2, pi), 1e-14);
  const Domain d = domain(model.surfaces[1].surface);
  for (const auto& [s, t] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}}) {
    expect_near(at(model, 1, d.u_at(s), d.v_at(t)), torus(s == 0 ? 0.25 : 2.5, t == 0 ? -1 : 3), 2e-14);
  }
  for (double s = 0; s <= 1; s += 0.125) {
    const Vec3 p = at(model, 1, d.u_at(s), d.v_at(1 - s)) - Vec3{1, 2, 3};
    EXPECT_NEAR(std::hypot(std::hypot(p.x, p.y) - 5, p.z), 2, 1e-14);
  }
}

TEST(G2, OtherObjectsArePassedOverAndCounted) {
  const std::string curve = "100 1 0 0\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n";
  const std::string volume = "700 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const std::string cylinder = "260 1 0 0\n3\n2\n0 0 0\n0 0 1\n1 0 0\n0\n0 6.28\n0\n";
  const std::string function = "200 1 0 0\n1 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0\n1\n0\n1\n";
  const Model model =
      model_of(parse_g2, curve + volume + bent + curve + cylinder + function + "999 1 0 0\n1 2\n3\n" + bent);
  EXPECT_EQ(model.surfaces.size(), 2u);
  EXPECT_EQ(model.warnings,
            (std::vector<std::string>{"m:1: 2 spline curves are not read", "m:7: 1 spline volume is not read",
                                      "m:37: 1 unbounded surface is not read",
                                      "m:46: 1 surface that is not in space is not read",
                                      "m:56: 1 object of another class is not read"}));
  EXPECT_EQ(error_of(parse_g2, volume + curve, StatusCode::unsupported),
            "m: no surface that can be read, but 1 spline volume, 1 spline curve");
}

TEST(G2, ErrorsSayWhereWhatAndWhatWasWanted) {
  const std::string header = "the header of an object (class, version 1 0, auxiliary numbers)";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "m:1: expected an object, found the end of the file"},
      {"\n\n", "m:2: expected an object, found the end of the file"},
      {"200 1 0\n", "m:1: expected " + header + ", found \"200\""},
      {"spline\n", "m:1: expected " + header + ", found \"spline\""},
      {bent + "1 2 3\n", "m:13: expected " + header + ", found \"1\""},
      {"200 1 0 0\n4 0\n", "m:2: expected the dimension of object 1 (class 200), from 1 to 3, found \"4\""},
      {"200 1 0 0\n3 2\n",
       "m:2: expected the flag of a rational surface of object 1 (class 200), from 0 to 1, found \"2\""},
      {"200 1 0 0\n3 0\n0 2\n",
       "m:3: expected the number of points along a direction of object 1 (class 200), from 1 to 1073741824, found "
       "\"0\""},
      {"200 1 0 0\n3 0\n3 1\n",
       "m:3: expected the order along a direction of object 1 (class 200), from 2 to 16, found \"1\""},
      {"200 1 0 0\n3 0\n2 2\n0 0 x 1\n", "m:4: expected a knot of object 1 (class 200), found \"x\""},
      {"200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 1 0 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n", "m:1: object 1 (class 200): "},
      {"200 1 0 0\n3 1\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0 0\n1 0 0 1\n0 1 0 1\n1 1 0 1\n",
       "m:7: expected a weight above 0 of object 1 (class 200), found \"0\""},
      {"200 1 0 0\n3 1\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0 1\n1 0 0 -2\n0 1 0 1\n1 1 0 1\n",
       "m:8: expected a weight above 0 of object 1 (class 200), found \"-2\""},
      {"270 1 0 0\n3\n-1\n0 0 0\n0 0 1\n1 0 0\n0 1\n0 1\n0\n", "m:1: object 1 (class 270): its radius is not above 0"},
      {"270 1 0 0\n3\n1\n0 0 0\n0 0 1\n0 0 2\n0 1\n0 1\n0\n",
       "m:1: object 1 (class 270): expected a z axis and an x axis of different directions"},
      {"290 1 0 0\n3\n5 1\n0 0 0\n0 0 1\n1 0 0\n1\n0 9\n0 1\n0\n",
       "m:1: object 1 (class 290): its ranges must be above 0 and at most a full turn"},
      {"260 1 0 0\n3\n1\n0 0 0\n0 0 1\n1 0 0\n2\n",
       "m:7: expected the flag of a bounded surface of object 1 (class 260), from 0 to 1, found \"2\""},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(parse_g2, text).substr(0, message.size()), message);
}

TEST(G2, NumbersThatAreNotFiniteAreErrors) {
  for (const char* bad : {"nan", "inf", "-inf", "1e400", "-1e400", "1,5"}) {
    const std::string message = error_of(
        parse_g2, "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 " + std::string(bad) + " 0\n0 1 0\n1 1 0\n");
    EXPECT_EQ(message, "m:8: expected a coordinate of object 1 (class 200), found \"" + std::string(bad) + "\"");
  }
}

TEST(G2, CountsThatTheFileCannotHoldAllocateNothing) {
  EXPECT_EQ(error_of(parse_g2, "200 1 0 0\n3 0\n1000000000 2\n0 0 1\n"),
            "m:4: expected a knot of object 1 (class 200), found the end of the file");
  std::string text = "200 1 0 0\n3 0\n";
  for (int direction = 0; direction < 2; ++direction) {
    text += "3000 2\n0";
    for (int k = 0; k < 3000; ++k) text += " " + std::to_string(k);
    text += " 2999\n";
  }
  EXPECT_EQ(error_of(parse_g2, text + "0 0 0\n"),
            "m:1: object 1 (class 200): the file is shorter than its 3000 x 3000 points");
}

TEST(G2, LayoutDoesNotMatter) {
  expect_layout_does_not_matter(parse_g2, bent + quarter);
  std::string line = bent + quarter;
  for (char& c : line) c = c == '\n' ? ' ' : c;
  expect_same(model_of(parse_g2, bent + quarter), model_of(parse_g2, line), "all in one line");
}
TEST(G2, CutsAreHarmless) {
  expect_cuts_are_harmless(parse_g2, bent + "290 1 0 0\n3\n5 2\n0 0 0\n0 0 1\n1 0 0\n1\n0 6.28\n0 1\n0\n" +
                                         "280 1 0 0\n3\n2\n0 0 0\n0 0 1\n1 0 0\n0.5\n1\n0 6\n0 3\n0\n100 1 0 0\n3 0\n" +
                                         quarter);
}
TEST(G2, SpoiledBytesAreHarmless) {
  expect_spoiled_bytes_are_harmless(parse_g2,
                                    bent + quarter + "270 1 0 0\n3\n1.5\n0 0 0\n0 0 1\n1 0 0\n0 6\n-1 1\n0\n");
}

/// A unit square, bilinear.
const std::string square = "3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
/// A circle about (0.5, 0.5) as four rational arcs; points are homogeneous.
std::string circle_of(double radius) {
  constexpr int x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  std::ostringstream text;
  text.precision(17);
  text << "0 100 0\n2 1\n9 3\n0 0 0 1 1 2 2 3 3 4 4 4\n";
  for (int k = 0; k < 9; ++k) {
    const double w = k % 2 == 0 ? 1 : std::sqrt(0.5);
    text << w * (0.5 + radius * x[k]) << ' ' << w * (0.5 + radius * y[k]) << ' ' << w << '\n';
  }
  return text.str();
}

TEST(G2, TrimmedSplinesHaveTheirLoops) {
  const std::string space = "3 0\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n";
  const std::string text = "210 1 0 0\n200\n" + square + "2\n1 1e-6\n" + circle_of(0.375) + "1 1e-6\n" +
                           circle_of(0.125).replace(0, 7, "1 100 100") + space + bent;
  const Model model = model_of(parse_g2, text);
  ASSERT_EQ(model.surfaces.size(), 2u);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_TRUE(model.surfaces[1].trims->empty());
  const std::vector<TrimLoop>& loops = model.surfaces[0].trims;
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_FALSE(loops[0].hole);
  EXPECT_TRUE(loops[1].hole);
  const Result<TrimRegion> region = TrimRegion::make(loops, domain(model.surfaces[0].surface));
  ASSERT_TRUE(region.ok());
  EXPECT_TRUE(region->remarks().empty());
  for (int i = 0; i <= 100; ++i)
    for (int k = 0; k <= 100; ++k) {
      const double u = i / 100.0, v = k / 100.0, r = std::hypot(u - 0.5, v - 0.5);
      if (std::abs(r - 0.375) < 1e-14 || std::abs(r - 0.125) < 1e-14) continue;
      ASSERT_EQ(region->locate(u, v), r < 0.375 && r > 0.125 ? TrimSide::inside : TrimSide::outside) << u << ' ' << v;
    }
}

/// A triangle of lines, one of them reversed, in a plane whose parameters the file swaps or not.
TEST(G2, TrimmedPlanesEndWhereTheirLoopsDo) {
  const std::string lines =
      "1\n3 0.001\n"
      "0 120 120\n2\n0 0\n1 0\n1\n0 4\n0\n3\n0 0 0\n1 0 0\n1\n0 4\n0\n"
      "0 120 130\n2\n0 2\n4 -2\n1\n0 1\n1\n3\n1\n0 0 0\n0 0 1\n1 0 0\n0 1\n0\n"
      "0 1 0\n2 0\n2 2\n0 0 1 1\n0 2\n0 0\n";
  const std::string frame = "3\n1 2 3\n0 0 1\n1 0 0\n";
  for (const std::string& bounds : {std::string("1\n-1e8 1e8\n-1e8 1e8\n"), std::string("0\n")})
    for (const bool swapped : {false, true}) {
      const Model model = model_of(parse_g2, "210 1 0 0\n250\n" + frame + bounds + (swapped ? "1\n" : "0\n") + lines);
      ASSERT_EQ(model.surfaces.size(), 1u);
      const ModelSurface& surface = model.surfaces[0];
      EXPECT_EQ(domain(surface.surface), swapped ? (Domain{0, 2, 0, 4}) : (Domain{0, 4, 0, 2}));
      const Result<TrimRegion> region = TrimRegion::make(*surface.trims, domain(surface.surface));
      ASSERT_TRUE(region.ok());
      EXPECT_TRUE(region->remarks().empty());
      for (const auto& [along, across] : {std::pair{1.0, 0.5}, std::pair{3.0, 0.25}, std::pair{3.0, 1.0}}) {
        const double u = swapped ? across : along, v = swapped ? along : across;
        EXPECT_EQ(region->locate(u, v), across < 2 - along / 2 ? TrimSide::inside : TrimSide::outside);
        expect_near(at(model, 0, u, v), Vec3{1 + u, 2 + v, 3}, 1e-15);
      }
    }
}

/// A rectangle of lines from (u0, v0) to (u1, v1), as one loop.
std::string window(double u0, double u1, double v0, double v1) {
  std::ostringstream text;
  text << "1\n4 0.001\n";
  const auto side = [&](double u, double v, double x, double y) {
    text << "0 100 0\n2 0\n2 2\n0 0 1 1\n" << u << ' ' << v << '\n' << x << ' ' << y << '\n';
  };
  side(u0, v0, u1, v0), side(u1, v0, u1, v1), side(u1, v1, u0, v1), side(u0, v1, u0, v0);
  return text.str();
}

/// The corners of the only loop of the model's only surface, in space.
std::vector<Vec3> loop_corners(const Model& model) {
  std::vector<Vec3> corners;
  for (const Curve& curve : model.surfaces.at(0).trims->at(0).curves)
    corners.push_back(at(model, 0, curve.points().front().x, curve.points().front().y));
  return corners;
}

void expect_corners(const std::string& text, const std::array<Vec3, 4>& corners) {
  const Model model = model_of(parse_g2, "210 1 0 0\n" + text);
  ASSERT_EQ(model.surfaces.size(), 1u);
  EXPECT_TRUE(model.warnings.empty());
  const std::vector<Vec3> found = loop_corners(model);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) expect_near(found[k], corners[k], 1e-14);
  const Result<PatchSet> set = make_patch_set(model);
  ASSERT_TRUE(set.ok()) << set.status().message();
  EXPECT_TRUE(set->trim_faults().empty());
}

/// Trimmed surfaces whose lines have no bounds, or bounds as good as infinite, end where their loops do.
TEST(G2, TrimmedElementarySurfacesKeepTheirParameters) {
  const std::string frame = "1 2 3\n0 0 1\n1 0 0\n";
  const auto around = [](double radius, double angle, double z) {
    return Vec3{1 + radius * std::cos(angle), 2 + radius * std::sin(angle), 3 + z};
  };
  const auto corners = [](auto&& point, double u0, double u1, double v0, double v1) {
    return std::array{point(u0, v0), point(u1, v0), point(u1, v1), point(u0, v1)};
  };
  const auto pipe = [&](double u, double v) { return around(0.5, u, v); };
  for (const char* bounds : {"0\n0 6.28318530717959\n", "1\n0 6.28318530717959\n-1e8 1e8\n"}) {
    expect_corners("260\n3\n0.5\n" + frame + bounds + "0\n" + window(0.3, 1, -2, 5), corners(pipe, 0.3, 1, -2, 5));
    const auto c = corners(pipe, 0.3, 1, -2, 5);
    expect_corners("260\n3\n0.5\n" + frame + bounds + "1\n" + window(-2, 5, 0.3, 1),
                   std::array{c[0], c[3], c[2], c[1]});
  }
  for (const double angle : {0.4, -0.4}) {
    const auto cone = [&](double u, double v) { return around(2 + v * std::tan(angle), u, v); };
    expect_corners("280\n3\n2\n" + frame + (angle > 0 ? "0.4" : "-0.4") + "\n0\n0 6.28318530717959\n0\n" +
                       window(0.3, 1, -0.5, 1.5),
                   corners(cone, 0.3, 1, -0.5, 1.5));
  }
  const auto ball = [&](double u, double v) { return around(2 * std::cos(v), u, 2 * std::sin(v)); };
  expect_corners(
      "270\n3\n2\n" + frame + "0 6.28318530717959 -1.5707963267949 1.5707963267949\n0\n" + window(0.3, 1, -0.5, 1.1),
      corners(ball, 0.3, 1, -0.5, 1.1));
}

TEST(G2, TrimmedExtrusionsKeepTheirParameters) {
  const std::string parabola = "3 0\n3 3\n0 0 0 2 2 2\n0 0 0\n1 0 0\n2 4 0\n", along = "0 0.5 2\n";
  const auto point = [](double u, double v) { return Vec3{u, u * u + 0.5 * v, 2 * v}; };
  const std::array corners{point(0.5, -1), point(1.5, -1), point(1.5, 3), point(0.5, 3)};
  for (const char* bounds : {"0\n0 2\n", "1\n0 2\n-1e8 1e8\n"}) {
    expect_corners("261\n3\n" + parabola + along + bounds + "0\n" + window(0.5, 1.5, -1, 3), corners);
    expect_corners("261\n3\n" + parabola + along + bounds + "1\n" + window(-1, 3, 0.5, 1.5),
                   {corners[0], corners[3], corners[2], corners[1]});
  }
}

TEST(G2, OtherTrimmedSurfacesAreSkipped) {
  const std::string torus = "290\n3\n2\n1\n0 0 0\n0 0 1\n1 0 0\n1\n0 1\n0 1\n0\n1\n1 0.01\n0 100 0\n";
  const std::string without = "200\n" + square + "1\n1 1e-6\n0 0 100\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n";
  const std::string conic = "200\n" + square + "1\n1 1e-6\n0 140 0\n2\n1 2 3 4\n";
  const std::string header = "210 1 0 0\n";
  const Model model = model_of(parse_g2, header + torus + header + without + header + conic + bent);
  EXPECT_EQ(model.surfaces.size(), 1u);
  EXPECT_EQ(model.warnings, (std::vector<std::string>{
                                "m:1: 1 trimmed torus or surface of another class is not read",
                                "m:16: 2 trimmed surfaces without splines or lines in their parameters are not read"}));
}

TEST(G2, LoopsThatAreWrong) {
  const std::string head = "210 1 0 0\n200\n" + square;
  expect_refused(parse_g2(head + "0\n", "m"), StatusCode::parse_error, Status::no_index,
                 "m:12: expected the number of loops of object 1 (class 210), from 1 to 1073741824, found \"0\"");
  expect_refused(parse_g2(head + "1\n1 0.1\n0 100 0\n3 0\n", "m"), StatusCode::parse_error, Status::no_index,
                 "m:15: expected the dimension 2 of a curve of object 1 (class 210), found \"3\"");
  expect_refused(parse_g2(head + "1\n1 0.1\n0 100 0\n2 0\n2 2\n0 1 0 1\n0 0\n1 1\n", "m"), StatusCode::parse_error,
                 Status::no_index, "m:1: object 1 (class 210): a curve of its loops: ");
  expect_refused(
      parse_g2("210 1 0 0\n250\n3\n0 0 0\n0 0 1\n1 0 0\n0\n0\n1\n1 0.1\n0 120 0\n2\n0 0\n1 0\n1\n0 4\n0\n", "m"),
      StatusCode::parse_error, Status::no_index, "its loops enclose nothing");
}

}}  // namespace tessera::test
