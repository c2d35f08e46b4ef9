// Mapped items of STEP texts: nested, scaled and mirrored ones, and operators of other relationships.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/step/step_transform.h"
#include "io_step/step_tree_text.h"
#include "support/errors.h"

namespace tessera::test { namespace {

/// An operator: x and y, its origin, scale, and z.
std::string operator_text(int number, const std::string& x, const std::string& y, int origin, const std::string& scale,
                          const std::string& z) {
  return ref(number) + "=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$," + x + "," + y + "," + ref(origin) + "," +
         scale + "," + z + ");\n";
}

TEST(MappedItems, PlaceARepresentationAtSeveralPlaces) {
  const StepTree tree = tree_of(shape_text(1, {100, 110}) + shape_text(2, {911, 921}) + product_text(10, "tetra", {1}) +
                                mapped_text(100, 2, 911, 912) + mapped_text(110, 2, 911, 913));
  ASSERT_EQ(tree.parts.size(), 1u);
  EXPECT_EQ(tree.parts[0].name, "tetra");
  ASSERT_EQ(tree.places.size(), 2u);
  EXPECT_LT(length(tree.places[0].placement.point({1, 0, 0}) - Vec3{2, 0, 0}), 1e-12);
  EXPECT_LT(length(tree.places[1].placement.point({1, 0, 0}) - Vec3{3, 0, 0}), 1e-12);
  EXPECT_FALSE(tree.places[0].is_mirrored());
}

TEST(MappedItems, ScaleAndMirror) {
  const std::string text = shape_text(1, {100}) + shape_text(2, {910, 921}) + product_text(10, "p", {1}) +
                           mapped_text(100, 2, 910, 200) + "#908=DIRECTION('',(0.,-1.,0.));\n";
  struct Case {
    std::string target;
    double volume;
    Vec3 image;  ///< of (1, 2, 4)
  };
  for (const Case& c : {Case{operator_text(200, "$", "$", 931, "2.", "$"), 8, {3, 4, 8}},
                        Case{operator_text(200, "$", "#908", 931, "1.", "#906"), -1, {2, -2, 4}},
                        Case{operator_text(200, "$", "#908", 931, "2.", "#906"), -8, {3, -4, 8}},
                        Case{operator_text(200, "$", "$", 930, "$", "#907"), 1, {1, -2, -4}},
                        Case{operator_text(200, "#905", "$", 930, "1.", "$"), 1, {-2, 1, 4}}}) {
    const StepTree tree = tree_of(text + c.target);
    ASSERT_EQ(tree.places.size(), 1u) << c.target;
    const StepPlacedPart& place = tree.places[0];
    EXPECT_NEAR(place.placement.determinant(), c.volume, 1e-12) << c.target;
    EXPECT_EQ(place.is_mirrored(), c.volume < 0);
    EXPECT_LT(length(place.placement.point({1, 2, 4}) - c.image), 1e-12) << c.target;
  }
}

TEST(MappedItems, HoldOthersAndHaveTheirOwnUnits) {
  // An inch of the innermost shape is moved by an inch, then doubled and moved by a millimetre.
  const StepTree tree = tree_of(shape_text(1, {100}) + shape_text(2, {910, 110}, 901) + shape_text(3, {910, 921}, 901) +
                                product_text(10, "p", {1}) + mapped_text(100, 2, 910, 200) +
                                mapped_text(110, 3, 910, 911) + operator_text(200, "$", "$", 931, "2.", "$"));
  ASSERT_EQ(tree.places.size(), 1u);
  EXPECT_EQ(tree.parts[0].units.length, 25.4);
  EXPECT_LT(length(tree.places[0].placement.point({25.4, 0, 0}) - Vec3{1 + 4 * 25.4, 0, 0}), 1e-12);
  EXPECT_EQ(tree.file_unit, "millimetre");
}

TEST(MappedItems, OfOperatorsIgnoreTheOrigin) {
  const StepTree tree = tree_of(shape_text(1, {100}) + shape_text(2, {911, 921}) + product_text(10, "p", {1}) +
                                mapped_text(100, 2, 911, 200) + operator_text(200, "$", "$", 933, "1.", "$"));
  ASSERT_EQ(tree.places.size(), 1u);
  EXPECT_EQ(tree.places[0].placement.translation, (Vec3{3, 0, 0}));
}

TEST(MappedItems, OfAnAssemblyStandForItsUses) {
  const std::string text = shape_text(1, {100, 110}) + shape_text(2, {910, 921}) + product_text(10, "whole", {1}) +
                           product_text(20, "box", {2}) + mapped_text(100, 2, 910, 911) +
                           mapped_text(110, 2, 910, 912) + use_text(30, "left", 10, 20) + use_text(40, "right", 10, 20);
  const StepTree tree = tree_of(text);
  ASSERT_EQ(tree.places.size(), 2u);
  for (const StepPlacedPart& place : tree.places) EXPECT_EQ(place.name, "box");
  EXPECT_EQ(tree.places[1].placement.translation, (Vec3{2, 0, 0}));
}

TEST(MappedItems, MayHaveSeveralKinds) {
  const StepTree tree = tree_of(shape_text(1, {100}) + shape_text(2, {910, 921}) + product_text(10, "p", {1}) +
                                "#100=(GEOMETRIC_REPRESENTATION_ITEM()MAPPED_ITEM(#101,#911)REPRESENTATION_ITEM(''));\n"
                                "#101=REPRESENTATION_MAP(#910,#2);\n");
  ASSERT_EQ(tree.places.size(), 1u);
  EXPECT_EQ(tree.places[0].placement.translation, (Vec3{1, 0, 0}));
}

TEST(Operators, PlaceComponentsOfAssemblies) {
  std::string text = shape_text(1, {910}) + shape_text(2, {910, 921}) + product_text(10, "whole", {1}) +
                     product_text(20, "box", {2}) + use_text(30, "left", 10, 20) + place_text(30, 2, 1, 910, 910);
  const std::size_t begin = text.find("#34=");
  text.replace(begin, text.find(";\n", begin) + 2 - begin, operator_text(34, "$", "$", 932, "3.", "$"));
  const StepTree tree = tree_of(text);
  ASSERT_EQ(tree.places.size(), 1u);
  EXPECT_LT(length(tree.places[0].placement.point({1, 1, 1}) - Vec3{5, 3, 3}), 1e-12);
}

TEST(Operators, ThatAreMalformedAreErrors) {
  const auto place = [](const std::string& text) {
    const StepTextFile file(step_basics + text);
    return step_place(file.index, {200, {}});
  };
  EXPECT_TRUE(place(operator_text(200, "$", "$", 931, "2.", "$")).ok());
  for (const auto& [text, words] : std::vector<std::array<std::string, 2>>{
           {operator_text(200, "$", "$", 931, "0.", "$"), "its scale is 0"},
           {operator_text(200, "$", "$", 931, "-1.", "$"), "its scale is -1"},
           {operator_text(200, "$", "$", 931, "1.E999", "$"), "a number beyond the range of double"},
           {operator_text(200, "$", "$", 905, "1.", "$"), "expected CARTESIAN_POINT"},
           {operator_text(200, "#931", "$", 931, "1.", "$"), "expected DIRECTION"},
           {"#200=CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$);\n", "expected a"},
           {"#200=CIRCLE('',#910,1.);\n", "expected AXIS2_PLACEMENT_3D"},
           {"", "#200 is not in the file"}})
    expect_refused(place(text), StatusCode::parse_error, Status::no_index, words);
}

TEST(Moves, AreUndoneByTheirInverse) {
  const StepTextFile file(step_basics + operator_text(200, "#905", "#906", 933, "2.5", "$"));
  for (const std::uint64_t number : {200u, 911u, 913u}) {
    const Affine map = value_of(step_place(file.index, {number, {}})), both = inverse_place(map) * map;
    EXPECT_LT(length(both.point({1, 2, 3}) - Vec3{1, 2, 3}), 1e-12);
    const Affine none = value_of(step_move(file.index, {number, {}}, {number, {}}));
    EXPECT_LT(length(none.point({1, 2, 3}) - Vec3{1, 2, 3}), 1e-12);
  }
}

}}  // namespace tessera::test
