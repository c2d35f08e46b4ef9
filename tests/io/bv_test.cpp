// The reader of .bv files: which segments become surfaces, what is skipped, and errors.

#include <gtest/gtest.h>

#include <cmath>

#include "io/reader_checks.h"

namespace tessera::test { namespace {

const std::string bilinear = "4 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
const std::string mixed = "Group 1 left\n5\n1 2\n0 0 0\n0 1 1\n0 2 0\n1 0 0\n1 1 1\n1 2 0\n" + bilinear +
                          "group 2 \xC3\xA9lytre\n8 1 1\n0 0 0 1\n0 2 0 2\n1 0 0 1\n3 3 0 3\n";

TEST(Bv, PointsRunAlongVFirst) {
  const Model model = model_of(parse_bv, mixed);
  ASSERT_EQ(model.surfaces.size(), 3u);
  const auto& patch = std::get<BezierPatch>(model.surfaces[0].surface);
  EXPECT_EQ(patch.degree_u(), 1);
  EXPECT_EQ(patch.degree_v(), 2);
  for (int i = 0; i <= 1; ++i) {
    for (int j = 0; j <= 2; ++j) EXPECT_EQ(patch.point(i, j), (Vec3{double(i), double(j), j == 1 ? 1.0 : 0.0}));
  }
  EXPECT_EQ(std::get<BezierPatch>(model.surfaces[1].surface).degree_v(), 1);
}

TEST(Bv, RationalPointsAreHomogeneous) {
  // A quarter of a cylinder: points (1,0), (1,1), (0,1) of weights 1, sqrt(1/2), 1.
  const Model model =
      model_of(parse_bv,
               "8 1 2\n1 0 0 1\n0.70710678118654752 0.70710678118654752 0 0.70710678118654752\n0 1 0 1\n"
               "1 0 2 1\n0.70710678118654752 0.70710678118654752 1.41421356237309505 "
               "0.70710678118654752\n0 1 2 1\n");
  for (double v = 0; v <= 1; v += 0.125) {
    const Vec3 p = evaluate_jet(model.surfaces.at(0), 0.5, v)->position;
    EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-15);
    EXPECT_NEAR(p.z, 1, 1e-15);
  }
}

TEST(Bv, GroupLinesNameWhatFollows) {
  const Model model = model_of(parse_bv, mixed);
  EXPECT_EQ(model.surfaces[0].name, "left");
  EXPECT_EQ(model.surfaces[1].name, "left");
  EXPECT_EQ(model.surfaces[2].name, "\xC3\xA9lytre");
  EXPECT_EQ(model_of(parse_bv, "group 1 \tthe left part \r\n" + bilinear).surfaces[0].name, "the left part");
  EXPECT_EQ(model_of(parse_bv, "GROUP 7\n" + bilinear).surfaces[0].name, "");
  // A name that is a large part of the file is not stored for each surface: at most 200 bytes, in whole characters.
  const Model long_name = model_of(parse_bv, "group 0 x" + std::string(1000, 'a') + "\n" + bilinear);
  EXPECT_EQ(long_name.surfaces[0].name->size(), 200u);
  std::string accents = "group 0 x";
  for (int k = 0; k < 200; ++k) accents += "\xC3\xA9";
  EXPECT_EQ(model_of(parse_bv, accents + "\n" + bilinear).surfaces[0].name->size(), 199u);
}

TEST(Bv, OtherKindsArePassedOverAndCounted) {
  const std::string triangle = "3 2\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const std::string polyhedron = "1\n3 2\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n";
  const std::string pn_triangle = "9 1 1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1\n0 0 1\n";
  const std::string pn_quad = "10 1 1 0 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n0 0 1\n0 0 1\n";
  const Model model = model_of(
      parse_bv, triangle + polyhedron + bilinear + pn_triangle + triangle + pn_quad + "group 1 last\n" + bilinear);
  ASSERT_EQ(model.surfaces.size(), 2u);
  EXPECT_EQ(model.surfaces[1].name, "last");
  EXPECT_EQ(model.warnings,
            (std::vector<std::string>{"m:1: 2 triangular patches are not read", "m:8: 1 polyhedron is not read",
                                      "m:20: 1 PN triangle is not read", "m:34: 1 PN quad is not read"}));
  EXPECT_EQ(error_of(parse_bv, polyhedron + triangle + polyhedron, StatusCode::unsupported),
            "m: no surface that can be read, but 2 polyhedra, 1 triangular patch");
}

TEST(Bv, ErrorsSayWhereWhatAndWhatWasWanted) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "m:1: expected a segment of surfaces, found the end of the file"},
      {"group 1 x\n", "m:1: expected a segment of surfaces, found the end of the file"},
      {"group x\n" + bilinear, "m:1: expected the number of the group, found \"x\""},
      {"7\n", "m:1: expected a group line or the kind of a segment (1, 3, 4, 5, 8, 9 or 10), found \"7\""},
      {bilinear + "11 3\n",
       "m:6: expected a group line or the kind of a segment (1, 3, 4, 5, 8, 9 or 10), found \"11\""},
      {"patch\n", "m:1: expected a group line or the kind of a segment (1, 3, 4, 5, 8, 9 or 10), found \"patch\""},
      {"4 0\n", "m:1: expected the degree along u of segment 1, from 1 to 15, found \"0\""},
      {"5 3 16\n", "m:1: expected the degree along v of segment 1, from 1 to 15, found \"16\""},
      {"5\n3\n", "m:2: expected the degree along v of segment 1, from 1 to 15, found the end of the file"},
      {"4 1\n0 0 0\n0 1 0\n", "m:3: the file ends after 2 of 4 control points of segment 1"},
      {"4 1\n0 0 0\n0 1 a\n",
       "m:3: expected 3 finite numbers for a control point (after 1 of 4 control points of segment 1), found \"a\""},
      {"8 1 1\n0 0 0 1\n0 2 0 0\n", "m:3: expected a weight above 0 for control point 2 of segment 1, found \"0\""},
      {"8 1 1\n0 0 0 1\n0 2 0 -1\n", "m:3: expected a weight above 0 for control point 2 of segment 1, found \"-1\""},
      {"8 1 1\n0 0 0 1\n0 1e300 0 1e-300\n",
       "m:3: control point 2 of segment 1 is too large for double after the division by its weight"},
      {"8 1 1\n0 0 0 1\n0 0 0 1e-200\n0 0 0 1\n0 0 0 1\n", "m:5: segment 1: "},
      {"1\n2 1\n0 0 0\n0 1 0\n2 0 2\n", "m:5: expected the index of a corner of segment 1, from 0 to 1, found \"2\""},
      {"1\n2 1\n0 0 0\n0 x 0\n", "m:4: expected a coordinate of the vertices of segment 1, found \"x\""},
      {"3 1\n0 0 0\n", "m:2: expected a coordinate of the control points of segment 1, found the end of the file"},
      {"3 -1\n", "m:1: expected the degree of segment 1, from 0 to 1000, found \"-1\""},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(parse_bv, text).substr(0, message.size()), message);
}

TEST(Bv, NumbersThatAreNotFiniteAreErrors) {
  for (const char* bad : {"nan", "inf", "-inf", "1e400", "-1e400", "1,5"}) {
    const std::string message = error_of(parse_bv, "4 1\n0 0 0\n0 1 0\n1 " + std::string(bad) + " 0\n1 1 0\n");
    EXPECT_EQ(message,
              "m:4: expected 3 finite numbers for a control point (after 2 of 4 control points of segment 1), "
              "found \"" +
                  std::string(bad) + "\"");
  }
}

TEST(Bv, CountsThatTheFileCannotHoldTakeNoTime) {
  EXPECT_EQ(error_of(parse_bv, "1\n1000000000000000000 3\n0 0 0\n"),
            "m:3: expected a coordinate of the vertices of segment 1, found the end of the file");
  EXPECT_EQ(error_of(parse_bv, "1\n0 1000000000000000000\n"),
            "m:2: expected the number of corners of a face of segment 1, from 0 to 1152921504606846976, found the end "
            "of the file");
  EXPECT_EQ(error_of(parse_bv, "1\n9223372036854775807 3\n").substr(0, 49),
            "m:2: expected the number of vertices of segment 1");
}

TEST(Bv, LayoutDoesNotMatter) { expect_layout_does_not_matter(parse_bv, mixed); }
TEST(Bv, CutsAreHarmless) {
  expect_cuts_are_harmless(parse_bv,
                           mixed + "9 1 1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1\n0 0 1\n1\n2 1\n0 0 0\n0 1 0\n2 0 1\n");
}
TEST(Bv, SpoiledBytesAreHarmless) { expect_spoiled_bytes_are_harmless(parse_bv, mixed); }

}}  // namespace tessera::test
