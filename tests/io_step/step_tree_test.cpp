// Parts of STEP texts and their places: products, assemblies, ties between representations, units, names.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_step/step_tree_text.h"

namespace tessera::test { namespace {

using Numbers = std::vector<std::uint64_t>;

void expect_place(const StepPlacedPart& found, const std::string& name, const Vec3& place) {
  EXPECT_EQ(found.name, name);
  EXPECT_LT(length(found.placement.point({}) - place), 1e-12)
      << name << " " << found.placement.translation.x << " " << found.placement.translation.y;
}

TEST(StepTree, HasTheShapesOfProducts) {
  const StepTree tree = tree_of(shape_text(1, {910, 921, 922}) + product_text(10, "box", {1}));
  ASSERT_EQ(tree.parts.size(), 1u);
  EXPECT_EQ(tree.parts[0].items, (Numbers{921, 922}));
  EXPECT_EQ(tree.parts[0].representation, 1u);
  EXPECT_EQ(tree.parts[0].name, "box");
  EXPECT_EQ(tree.parts[0].units.length, 1);
  EXPECT_EQ(tree.file_unit, "millimetre");
  ASSERT_EQ(tree.places.size(), 1u);
  expect_place(tree.places[0], "box", {});
  EXPECT_EQ(tree.remarks.count, 0u);
}

TEST(StepTree, TakesTheIdOfProductsWithoutAName) {
  std::string text = shape_text(1, {921}) + product_text(10, "box", {1});
  text.replace(text.find("'box'"), 5, "''");
  EXPECT_EQ(tree_of(text).parts.at(0).name, "id of box");
}

TEST(StepTree, FollowsPlainRelationshipsEitherWay) {
  for (const char* const tie : {"#1,#2", "#2,#1"}) {
    const std::string text = shape_text(1, {910}) + shape_text(2, {921}, 900, "ADVANCED_BREP_SHAPE_REPRESENTATION") +
                             product_text(10, "box", {1});
    for (const std::string begin :
         {"SHAPE_REPRESENTATION_RELATIONSHIP('','',", "(REPRESENTATION_RELATIONSHIP('','',"}) {
      const std::string end = begin[0] == '(' ? ")SHAPE_REPRESENTATION_RELATIONSHIP());\n" : ");\n";
      const StepTree tree = tree_of(text + "#3=" + begin + tie + end);
      ASSERT_EQ(tree.parts.size(), 1u) << tie;
      EXPECT_EQ(tree.parts[0].items, (Numbers{921}));
      EXPECT_EQ(tree.parts[0].name, "box");
    }
  }
}

TEST(StepTree, ListsAnItemOnce) {
  const std::string shapes = shape_text(1, {910, 921}) + shape_text(2, {921, 922, 921});
  const std::string tie = "#3=SHAPE_REPRESENTATION_RELATIONSHIP('','',#1,#2);\n";
  for (const std::string& text :
       {shapes + tie + product_text(10, "box", {1}), shapes + product_text(10, "box", {1, 2}), shapes, shapes + tie}) {
    const StepTree tree = tree_of(text);
    ASSERT_EQ(tree.parts.size(), 1u);
    EXPECT_EQ(tree.parts[0].items, (Numbers{921, 922}));
  }
}

TEST(StepTree, DoesNotTieTheShapesOfTwoProducts) {
  const StepTree tree = tree_of(shape_text(1, {921}) + shape_text(2, {922}) + product_text(10, "a", {1}) +
                                product_text(20, "b", {2}) + "#3=SHAPE_REPRESENTATION_RELATIONSHIP('','',#1,#2);\n");
  ASSERT_EQ(tree.places.size(), 2u);
  EXPECT_EQ(tree.parts[0].items, (Numbers{921}));
  EXPECT_EQ(tree.parts[1].items, (Numbers{922}));
}

TEST(StepTree, MakesOnePartOfTheShapesOfAProduct) {
  const std::string text = shape_text(1, {921}) + shape_text(2, {922});
  const StepTree tree = tree_of(text + product_text(10, "box", {1, 2, 1}));
  ASSERT_EQ(tree.parts.size(), 1u);
  EXPECT_EQ(tree.parts[0].items, (Numbers{921, 922}));
  // Representations of other units are parts of their own.
  const StepTree two = tree_of(shape_text(1, {921}) + shape_text(2, {922}, 901) + product_text(10, "box", {1, 2}));
  ASSERT_EQ(two.parts.size(), 2u);
  EXPECT_EQ(two.parts[0].units.length, 1);
  EXPECT_EQ(two.parts[1].units.length, 25.4);
}

/// An assembly of a box, at #911 in the box's shape and #913 in the assembly's.
std::string assembly_text(const std::string& place, int context = 900) {
  return shape_text(1, {910, 913}) + shape_text(2, {911, 921}, context) + product_text(10, "whole", {1}) +
         product_text(20, "box", {2}) + use_text(30, "left", 10, 20) + place;
}

TEST(StepTree, PlacesComponentsInTheirAssemblies) {
  // The origin of #911 goes to that of #913, x to y.
  const auto expect = [](const std::string& text, double unit) {
    const StepTree tree = tree_of(text);
    ASSERT_EQ(tree.places.size(), 1u);
    EXPECT_EQ(tree.parts[0].name, "box");
    EXPECT_EQ(tree.parts[0].units.length, unit);
    const Affine& place = tree.places[0].placement;
    EXPECT_LT(length(place.point({unit, 0, 0}) - Vec3{3, 0, 0}), 1e-12);
    EXPECT_LT(length(place.vector({1, 0, 0}) - Vec3{0, 1, 0}), 1e-12);
    EXPECT_LT(length(place.vector({0, 1, 0}) - Vec3{-1, 0, 0}), 1e-12);
    EXPECT_EQ(tree.places[0].name, "left");
    EXPECT_EQ(tree.remarks.count, 0u);
  };
  expect(assembly_text(place_text(30, 2, 1, 911, 913)), 1);
  expect(assembly_text(place_text(30, 1, 2, 913, 911)), 1);          // the representations in the other order
  expect(assembly_text(place_text(30, 2, 1, 913, 911)), 1);          // the placements alone in the other order
  expect(assembly_text(place_text(30, 2, 1, 911, 913), 901), 25.4);  // inches within millimetres
  expect(assembly_text(place_text(30, 1, 2, 913, 911), 901), 25.4);
  expect(assembly_text(place_text(30, 2, 1, 913, 911), 901), 25.4);
}

TEST(StepTree, TakesUsesOfSeveralKinds) {
  std::string text = assembly_text(place_text(30, 2, 1, 911, 913));
  const std::size_t begin = text.find("#30="), end = text.find(";\n", begin);
  text.replace(begin, end - begin,
               "#30=(ASSEMBLY_COMPONENT_USAGE($)NEXT_ASSEMBLY_USAGE_OCCURRENCE()"
               "PRODUCT_DEFINITION_RELATIONSHIP('id','left','',#10,#20)PRODUCT_DEFINITION_USAGE()"
               "QUANTIFIED_ASSEMBLY_COMPONENT_USAGE(#77))");
  const StepTree tree = tree_of(text);
  ASSERT_EQ(tree.places.size(), 1u);
  expect_place(tree.places[0], "left", {3, -1, 0});
}

TEST(StepTree, PutsUsesWithoutAPlaceAtTheOrigin) {
  const StepTree tree = tree_of(assembly_text(""));
  ASSERT_EQ(tree.places.size(), 1u);
  expect_place(tree.places[0], "left", {});
}

/// A whole of two pairs of two boxes, and a box of its own; `names` of the uses of pairs and of boxes.
std::string pairs_text(const std::vector<std::string>& names) {
  return shape_text(1, {910, 911, 912, 922}) + shape_text(2, {910, 911, 912}) + shape_text(3, {910, 921}) +
         product_text(10, "whole", {1}) + product_text(20, "pair", {2}) + product_text(40, "box", {3}) +
         use_text(100, names[0], 10, 20) + place_text(100, 2, 1, 910, 911) + use_text(110, names[1], 10, 20) +
         place_text(110, 2, 1, 910, 912) + use_text(120, names[2], 20, 40) + place_text(120, 3, 2, 910, 911) +
         use_text(130, names[3], 20, 40) + place_text(130, 3, 2, 910, 912);
}

TEST(StepTree, SharesPartsAmongPlaces) {
  const StepTree tree = tree_of(pairs_text({"p", "q", "a", "b"}));
  ASSERT_EQ(tree.parts.size(), 2u);
  ASSERT_EQ(tree.places.size(), 5u);
  expect_place(tree.places[0], "a", {2, 0, 0});
  expect_place(tree.places[1], "b", {3, 0, 0});
  expect_place(tree.places[2], "a", {3, 0, 0});
  expect_place(tree.places[3], "b", {4, 0, 0});
  expect_place(tree.places[4], "whole", {});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(tree.parts[tree.places[k].part].name, "box");
  for (const StepPlacedPart& place : tree.places) EXPECT_EQ(place.colours, 0u);
}

TEST(StepTree, NamesPlacesByTheNearestUse) {
  std::string text = pairs_text({"p", " ", "a", ""});
  for (std::size_t id = text.find("'id'"); id != std::string::npos; id = text.find("'id'")) text.replace(id, 4, "''");
  const StepTree tree = tree_of(text);
  ASSERT_EQ(tree.places.size(), 5u);
  const std::vector<std::string> names{"a", "p", "a", "box", "whole"};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(tree.places[k].name, names[k]) << k;
  EXPECT_EQ(tree_of(pairs_text({"p", "q", "a", ""})).places.at(1).name, "id");
}

TEST(StepTree, HasAllRoots) {
  const StepTree tree = tree_of(shape_text(1, {921}, 901) + shape_text(2, {922}) + product_text(10, "a", {1}) +
                                product_text(20, "b", {2}) + product_text(40, "none", {}));
  ASSERT_EQ(tree.places.size(), 2u);
  EXPECT_EQ(tree.places[0].name, "a");
  EXPECT_EQ(tree.places[1].name, "b");
  EXPECT_EQ(tree.file_unit, "INCH");
}

TEST(StepTree, DecodesNames) {
  const StepTextFile escaped(step_basics + shape_text(1, {921}) + product_text(10, "Geh\\X\\E4use", {1}));
  EXPECT_EQ(value_of(read_step_tree(escaped.index)).parts.at(0).name, "Geh\xC3\xA4use");
  const StepTextFile chinese(step_basics + shape_text(1, {921}) + product_text(10, "\xD7\xB0\xC5\xE4", {1}));
  ASSERT_EQ(encoding_of(chinese.text), TextEncoding::gbk);
  EXPECT_EQ(value_of(read_step_tree(chinese.index, TextEncoding::gbk)).parts.at(0).name, "\xE8\xA3\x85\xE9\x85\x8D");
}

TEST(StepTree, WithoutProductsHasAllShapesAsOnePart) {
  const StepTree tree = tree_of(shape_text(1, {921}) + shape_text(2, {922}, 900, "FACETED_BREP_SHAPE_REPRESENTATION") +
                                "#3=(REPRESENTATION('',(#923),#900)SHAPE_REPRESENTATION());\n" +
                                shape_text(4, {924}, 900, "REPRESENTATION"));
  ASSERT_EQ(tree.places.size(), 1u);
  EXPECT_EQ(tree.parts[0].items, (Numbers{921, 922, 923}));
  EXPECT_EQ(tree.parts[0].name, "");
}

TEST(StepTree, WithoutProductsPlacesShapesInOthers) {
  const StepTree tree = tree_of(shape_text(1, {910, 911, 921}) + shape_text(2, {910, 922}) +
                                "#3=(REPRESENTATION_RELATIONSHIP('','',#2,#1)"
                                "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#4)SHAPE_REPRESENTATION_RELATIONSHIP("
                                "));\n#4=ITEM_DEFINED_TRANSFORMATION('','',#910,#911);\n");
  ASSERT_EQ(tree.places.size(), 2u);
  EXPECT_EQ(tree.parts[tree.places[0].part].items, (Numbers{921}));
  EXPECT_EQ(tree.parts[tree.places[1].part].items, (Numbers{922}));
  EXPECT_EQ(tree.places[1].placement.translation, (Vec3{1, 0, 0}));
}

}}  // namespace tessera::test
