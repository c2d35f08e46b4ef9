// RIB files as scenes: blocks, transformations, objects, names, what is skipped, and errors.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/reader_checks.h"

namespace tessera::test { namespace {

const std::string quad = "Patch \"bilinear\" \"P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n";

Vec3 placed(const Model& model, std::size_t surface, const Vec3& point) {
  return model.surfaces.at(surface).placement->point(point);
}

void expect_near_scene(const Vec3& a, const Vec3& b) {
  EXPECT_LE(length(a - b), 1e-14) << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(RibScene, TheLastTransformationActsFirst) {
  const Model model = model_of(parse_rib, "Translate 10 0 0\nRotate 90 0 0 1\nScale 2 3 4\n" + quad);
  // Scaled, turned from x to y, moved.
  expect_near_scene(placed(model, 0, {1, 0, 0}), {10, 2, 0});
  expect_near_scene(placed(model, 0, {0, 1, 0}), {7, 0, 0});
  expect_near_scene(placed(model, 0, {0, 0, 1}), {10, 0, 4});
  expect_near_scene(evaluate_jet(model.surfaces[0], 1, 0)->position, {10, 2, 0});
}

TEST(RibScene, MatricesActOnRowVectors) {
  const Model model =
      model_of(parse_rib, "Translate [1 1 1] ConcatTransform [0 1 0 0  -1 0 0 0  0 0 1 0  5 6 7 1]\n" + quad +
                              "Transform [2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 2]\n" + quad + "Identity\n" + quad);
  expect_near_scene(placed(model, 0, {1, 0, 0}), {6, 8, 8});  // (0,1,0) + (5,6,7), then moved
  expect_near_scene(placed(model, 0, {0, 1, 0}), {5, 7, 8});  // (-1,0,0)
  EXPECT_EQ(model.surfaces[1].placement, Affine{});           // homogeneous: 2 over 2
  EXPECT_EQ(model.surfaces[2].placement, Affine{});
}

TEST(RibScene, TheWorldIsTheModelsSpace) {
  const Model model = model_of(parse_rib, "Translate 0 0 400 Rotate -115 1 0 0\nWorldBegin\n" + quad +
                                              "Translate 1 2 3\n" + quad + "WorldEnd\n");
  EXPECT_EQ(model.surfaces[0].placement, Affine{});
  EXPECT_EQ(placed(model, 1, {0, 0, 0}), (Vec3{1, 2, 3}));
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(model_of(parse_rib, "WorldBegin " + quad + "WorldEnd WorldBegin " + quad + "WorldEnd").warnings,
            std::vector<std::string>{"m:1: 2 worlds share one space, their surfaces may overlap"});
}

TEST(RibScene, BlocksBringBackWhatTheySaved) {
  const std::string name = "Attribute \"identifier\" \"string name\" [\"inner\"] ";
  const Model model =
      model_of(parse_rib, "Attribute \"identifier\" \"name\" \"outer\" AttributeBegin Translate 1 0 0 " + name + quad +
                              "AttributeEnd " + quad + "TransformBegin Translate 0 1 0 " + name +
                              "Basis \"b-spline\" 1 \"b-spline\" 1 " + quad + "TransformEnd " + quad);
  const std::vector<std::pair<std::string, Vec3>> wanted{
      {"inner", {1, 0, 0}}, {"outer", {}}, {"inner", {0, 1, 0}}, {"inner", {}}};
  ASSERT_EQ(model.surfaces.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(model.surfaces[k].name, wanted[k].first);
    EXPECT_EQ(model.surfaces[k].placement->translation, wanted[k].second);
  }
}

TEST(RibScene, AttributesOfOtherFormsAreNoErrors) {
  const Model model = model_of(parse_rib,
                               "Attribute \"identifier\" \"name\" [\"a\" \"b\"] Attribute \"identifier\" \"name\" 5 "
                               "Attribute [\"x\" 1] Attribute \"visibility\" \"int camera\" [1]\n" +
                                   quad);
  EXPECT_EQ(model.surfaces.at(0).name, "");
  EXPECT_EQ(model.warnings, std::vector<std::string>{"m:1: requests that are skipped: Attribute 4"});
}

TEST(RibScene, ObjectsStandWhereTheirInstancesAre) {
  const Model model = model_of(parse_rib, "Translate 9 9 9 ObjectBegin 1 Translate 1 0 0 " + quad +
                                              "ObjectEnd ObjectBegin \"two\" "
                                              "Scale 2 2 2 ObjectInstance 1 " +
                                              quad +
                                              "ObjectEnd Identity\n"
                                              "ObjectInstance 1 Translate 0 0 5 ObjectInstance \"two\"");
  ASSERT_EQ(model.surfaces.size(), 3u);
  EXPECT_EQ(placed(model, 0, {}), (Vec3{1, 0, 0}));
  EXPECT_EQ(placed(model, 1, {1, 0, 0}), (Vec3{4, 0, 5}));
  EXPECT_EQ(placed(model, 2, {1, 0, 0}), (Vec3{2, 0, 5}));
}

TEST(RibScene, CopiesAreBoundedByTheFile) {
  // Each object holds the one before it ten times: 10^30 quads.
  std::string text = "ObjectBegin 0 " + quad + "ObjectEnd\n";
  for (int k = 1; k <= 30; ++k) {
    text += "ObjectBegin " + std::to_string(k) + "\n";
    for (int n = 0; n < 10; ++n) text += "ObjectInstance " + std::to_string(k - 1) + "\n";
    text += "ObjectEnd\n";
  }
  const std::string message = error_of(parse_rib, text + "ObjectInstance 30\n");
  EXPECT_NE(message.find("ObjectInstance: copies of objects would take more than 4 times the file"), std::string::npos)
      << message;
}

TEST(RibScene, OfWhatMovesTheFirstMomentIsRead) {
  const Model model = model_of(parse_rib,
                               "MotionBegin [0 1] Translate 1 0 0 Translate 2 0 0 MotionEnd\n"
                               "MotionBegin [0 0.5 1] " +
                                   quad + quad + quad + "MotionEnd");
  ASSERT_EQ(model.surfaces.size(), 1u);
  EXPECT_EQ(placed(model, 0, {}), (Vec3{1, 0, 0}));
  EXPECT_EQ(model.warnings,
            std::vector<std::string>{"m:1: motions are read at their first moment only, 3 others are skipped"});
}

TEST(RibScene, OtherRequestsArePassedOverAndCounted) {
  const Model model = model_of(parse_rib,
                               "##RenderMan RIB\nversion 3.03\nDeclare \"P\" \"vertex point\"\n# Patch\n"
                               "Display \"a ] # \\\" b.tif\" \"file\" \"rgb\" \"list\" [\"x[\" \"]y\"]\n"
                               "Color [1 .5 0] Color 1 1 1 Curves 1 -1 1 360 Skew 45 0 1 0 1 0 0\n"
                               "Polygon \"P\"[0 0 0 1 0 0 0 1 0] Curves [1 -1 1 360]" +
                                   quad);
  EXPECT_EQ(model.surfaces.size(), 1u);
  EXPECT_EQ(model.warnings, (std::vector<std::string>{
                                "m:6: shapes that are not read: Curves 2, Polygon 1",
                                "m:6: transformations that are not read, surfaces after them are misplaced: Skew 1",
                                "m:5: requests that are skipped: Color 2, Display 1"}));
  EXPECT_EQ(error_of(parse_rib, "Points 1 -1 1 360\n", StatusCode::unsupported),
            "m: no surface that can be read, but Points 1");
  EXPECT_EQ(error_of(parse_rib, "Color 1 1 1\n"),
            "m: no surface that can be read: expected Patch, PatchMesh, NuPatch or a quadric, found none");
}

TEST(RibScene, OpenBlocksAtTheEndAreAWarning) {
  EXPECT_EQ(
      model_of(parse_rib, "WorldBegin\nAttributeBegin\n" + quad).warnings,
      std::vector<std::string>{"m: expected the blocks to end with the file, but AttributeBegin of line 2 is open"});
}

TEST(RibScene, ErrorsSayWhereWhatAndWhatWasWanted) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "m: no surface that can be read: expected Patch"},
      {"\n17 Patch", "m:2: expected a request (a word without quotes), found \"17\""},
      {"]", "m:1: expected a request (a word without quotes), found \"]\""},
      {"Patch \"bicubic\"\n\"P\" [0 0 0]", "m:1: Patch: expected 48 numbers for P, found 3"},
      {"Patch \"bilinear\" \"Pw\" [0 0 0]", "m:1: Patch: expected 16 numbers for Pw, found 3"},
      {"Patch \"bilinear\" \"st\" [0 0 0]\n", "m:1: expected positions (\"P\", \"Pw\" or \"Pz\") of Patch, found"},
      {"Patch \"cubic\" \"P\" [0]", "m:1: Patch: expected \"bilinear\" or \"bicubic\", found \"cubic\""},
      {"Patch 3", "m:1: expected \"bilinear\" or \"bicubic\", found \"3\""},
      {"Patch \"bilinear\" \"P\"\n[0 0 0 1\nb", "m:3: expected a finite number for P, found \"b\""},
      {"Patch \"bilinear\" \"P\"\n[0 0 0 1\n", "m:2: expected a finite number for P, found the end of the file"},
      {"Patch \"bilinear\" \"P\n", "m:1: the file ends within a string that begins here"},
      {"Color [1 1\n\"red\n", "m:2: the file ends within a string that begins here"},
      {"Color [1 1\n", "m:1: the file ends within an array that begins here"},
      {"Patch \"bilinear\" \"Pw\" [0 0 0 1 1 0 0 1 0 1 0 0 1 1 0 1]",
       "m:1: Patch: weight 0 of control point 1 is not above 0"},
      {"PatchMesh \"bicubic\" 5 \"nonperiodic\" 4 \"nonperiodic\" \"P\" [" +
           [] {
             std::string zeros;
             for (int k = 0; k < 60; ++k) zeros += "0 ";
             return zeros;
           }() +
           "]",
       "m:1: PatchMesh: 5 points along one direction make no mesh with this basis, which needs 4 plus a multiple of 3"},
      {"PatchMesh \"bicubic\" 4 \"open\"", "m:1: PatchMesh: expected \"periodic\" or \"nonperiodic\", found \"open\""},
      {"PatchMesh \"bicubic\" -4", "m:1: expected the number of points along u, from 1 to 1073741824, found \"-4\""},
      {"PatchMesh \"bicubic\" 4.5", "m:1: expected the number of points along u, from 1 to 1073741824, found \"4.5\""},
      {"PatchMesh \"bilinear\" 1000000000 \"periodic\" 1000000000 \"periodic\" \"P\" [0 0 0]",
       "m:1: PatchMesh: expected 3000000000000000000 numbers for P, found 3"},
      {"NuPatch 3 17", "m:1: expected the order along u, from 2 to 16, found \"17\""},
      {"NuPatch 3 2 [0 0 1]", "m:1: NuPatch: expected 5 knots along u, found 3"},
      {"NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 nan",
       "m:1: expected the range along v (2 finite numbers), found \"nan\""},
      {"NuPatch 2 2 [0 0 1 1] 0 2 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]", "m:1: NuPatch: "},
      {"NuPatch 2 2 [0 1 0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]", "m:1: NuPatch: "},
      {"Basis \"beta\" 1", "m:1: Basis: expected bezier, b-spline, catmull-rom, hermite, power or a matrix, found"},
      {"Basis \"bezier\" 0", "m:1: expected the step of the basis, from 1 to 1073741824, found \"0\""},
      {"Basis [1 2 3] 1", "m:1: expected the name of a basis or the 16 numbers of its matrix, found \"]"},
      {"Translate 1 2", "m:1: expected 3 finite numbers after Translate, found the end of the file"},
      {"Scale 1 1e400 1", "m:1: expected 3 finite numbers after Scale, found \"1e400\""},
      {"Scale 1e200 1 1\nScale 1e200 1 1", "m:2: Scale: the transformation is too large for double"},
      {"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]",
       "m:1: Transform: expected an affine matrix, whose fourth column is 0 0 0 1"},
      {"AttributeEnd", "m:1: expected AttributeEnd to end a block that AttributeBegin began, but no block is open"},
      {"WorldBegin\n\nTransformBegin\nWorldEnd",
       "m:4: expected WorldEnd to end a block that WorldBegin began, but TransformBegin of line 3 is open"},
      {"ObjectInstance 1", "m:1: expected the number or name of an object above, found \"1\""},
      {"ObjectBegin 1 ObjectBegin 2", "m:1: ObjectBegin: an object cannot be within another"},
      {"TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1]",
       "m:1: expected w of trimming curves, found the end of the file"},
      {"TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1]",
       "m:1: TrimCurve: its arrays have lengths that do not fit each other"},
      {"TrimCurve [2] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1]",
       "m:1: TrimCurve: the numbers of curves per loop do not fit the number of orders"},
      {"TrimCurve [1] [2] [0 0 1 1] [0] [1] [1e9] [0 1] [0 1] [1 1]",
       "m:1: TrimCurve: curve 0 has an order, a number of points and knots that do not fit each other"},
      {"TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 0]", "m:1: TrimCurve: weight 1 is not above 0"},
      {"TrimCurve [1] [2] [0 0 1 1 2] [0] [1] [2] [0 1] [0 1] [1 1]",
       "m:1: TrimCurve: numbers are left over after the last curve"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(parse_rib, text).substr(0, message.size()), message);
}

TEST(RibScene, CompressedAndBinaryFilesAreSaidToBeSo) {
  EXPECT_EQ(error_of(parse_rib, std::string("\x1f\x8b\x08\0\0", 5), StatusCode::unsupported),
            "m: this text is packed by gzip; read_model() unpacks files");
  EXPECT_EQ(error_of(parse_rib, "version 3.03\n\xCC\x01\x02"), "m:2: binary RIB is not read: convert it to text first");
}

TEST(RibScene, BlocksMayBeNestedAThousandDeep) {
  std::string text;
  for (int k = 0; k < 1000; ++k) text += "AttributeBegin\n";
  EXPECT_EQ(model_of(parse_rib, text + quad).surfaces.size(), 1u);
  EXPECT_EQ(error_of(parse_rib, text + "TransformBegin\n"), "m:1001: blocks are nested deeper than 1000 levels");
}

const std::string scene =
    "##RenderMan RIB\nWorldBegin\nAttributeBegin\nAttribute \"identifier\" \"name\" [\"a_b\"]\nRotate 30 0 1 1\n" +
    quad +
    "Basis \"catmull-rom\" 1 [-1 3 -3 1 3 -6 3 0 -3 3 0 0 1 0 0 0] 3\nPatchMesh \"bilinear\" 2 \"periodic\" 2 "
    "\"nonperiodic\" \"Pw\" [0 0 0 1 1 0 0 1 0 1 0 1 1 1 0 1] \"s\" [1 2]\n"
    "TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1]\n"
    "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"Pz\" [0 1 2 3]\nMotionBegin [0 1]\n" +
    quad + quad + "MotionEnd\nAttributeEnd\nObjectBegin 4\nConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1]\n" + quad +
    "ObjectEnd\nObjectInstance 4\nWorldEnd\n";

TEST(RibScene, LayoutDoesNotMatter) { expect_layout_does_not_matter(parse_rib, scene); }
TEST(RibScene, CutsAreHarmless) { expect_cuts_are_harmless(parse_rib, scene); }
TEST(RibScene, SpoiledBytesAreHarmless) { expect_spoiled_bytes_are_harmless(parse_rib, scene); }

}}  // namespace tessera::test
