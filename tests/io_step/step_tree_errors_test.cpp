// STEP texts whose structure is malformed, endless or too large: what is left out with a remark, and what is an error.

#include <gtest/gtest.h>

#include <string>

#include "io_step/step_tree_text.h"
#include "support/errors.h"

namespace tessera::test { namespace {

void expect_remark(const StepTree& tree, const std::string& words) {
  for (const std::string& text : tree.remarks.texts)
    if (text.find(words) != std::string::npos) return;
  ADD_FAILURE() << "no remark has: " << words << (tree.remarks.texts.empty() ? "" : "; " + tree.remarks.texts[0]);
}

/// An assembly of a box and of what else `more` adds.
std::string boxed_text(const std::string& more) {
  return shape_text(1, {910, 911}) + shape_text(2, {910, 921}) + product_text(10, "whole", {1}) +
         product_text(20, "box", {2}) + use_text(30, "left", 10, 20) + place_text(30, 2, 1, 910, 911) + more;
}

TEST(StepTreeErrors, OfOnePartLeaveTheOthers) {
  struct Case {
    std::string more, words;
  };
  for (const Case& c :
       {Case{"#40=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#10,#77,$);\n", "refers to #77, which is not in the file"},
        Case{"#40=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#10,#1,$);\n", "it does not tie two instances"},
        Case{"#40=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','');\n", "expected at least 4 attributes, found 2"},
        Case{"#40=SHAPE_DEFINITION_REPRESENTATION(#23,#77);\n", "a shape is left out: #40"},
        Case{"#40=SHAPE_DEFINITION_REPRESENTATION($,#1);\n", "found $"},
        Case{"#40=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#77,#31);\n", "a place in an assembly is not read: #40"},
        Case{"#40=SHAPE_REPRESENTATION_RELATIONSHIP('','',#2,#77);\n", "two representations are not tied: #40"},
        Case{use_text(40, "b", 10, 20) + place_text(40, 2, 1, 910, 930), "#930 CARTESIAN_POINT"},
        Case{use_text(40, "b", 10, 20) + place_text(40, 2, 1, 910, 77), "#77, which is not in the file"}}) {
    const StepTree tree = tree_of(boxed_text(c.more));
    ASSERT_EQ(tree.places.size(), 1u) << c.more;
    EXPECT_EQ(tree.places[0].placement.translation, (Vec3{1, 0, 0}));
    EXPECT_GE(tree.remarks.count, 1u) << c.more;
    expect_remark(tree, c.words);
  }
}

TEST(StepTreeErrors, OfRepresentationsLeaveTheirPartOut) {
  const auto tree_with = [](const std::string& shape) {
    return tree_of(shape + shape_text(2, {922}) + product_text(10, "bad", {1}) + product_text(20, "good", {2}));
  };
  struct Case {
    std::string shape, words;
  };
  for (const Case& c :
       {Case{"#1=SHAPE_REPRESENTATION('',(#921),#800);\n", "#1 SHAPE_REPRESENTATION in line 24: refers to #800"},
        Case{"#1=SHAPE_REPRESENTATION('',#921,#900);\n", "expected a list, found #921"},
        Case{"#1=SHAPE_REPRESENTATION('');\n", "expected at least 3 attributes, found 1"},
        Case{"#1=SHAPE_REPRESENTATION('',(#921),#800);\n#800=(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
             "GLOBAL_UNIT_ASSIGNED_CONTEXT((#801))REPRESENTATION_CONTEXT('',''));\n"
             "#801=(CONVERSION_BASED_UNIT('NIL',#802)LENGTH_UNIT()NAMED_UNIT($));\n"
             "#802=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.),#902);\n",
             "#802 LENGTH_MEASURE_WITH_UNIT in line 27: its value is 0, expected a number above 0"}}) {
    const StepTree tree = tree_with(c.shape);
    ASSERT_EQ(tree.places.size(), 1u) << c.shape;
    EXPECT_EQ(tree.places[0].name, "good");
    expect_remark(tree, c.words);
  }
  const StepTree some = tree_with("#1=SHAPE_REPRESENTATION('',(#921,#77,$),$);\n");
  ASSERT_EQ(some.places.size(), 2u);
  EXPECT_EQ(some.parts[0].items, (std::vector<std::uint64_t>{921}));
  EXPECT_EQ(some.parts[0].units.length, 1);
  expect_remark(some, "2 items left out");
}

TEST(StepTreeErrors, OfMappedItemsLeaveTheOthers) {
  for (const std::string bad :
       {"#100=MAPPED_ITEM('',#101,#77);\n#101=REPRESENTATION_MAP(#910,#2);\n",
        "#100=MAPPED_ITEM('',#101,#911);\n#101=REPRESENTATION_MAP(#910);\n",
        "#100=MAPPED_ITEM('',#101,#911);\n#101=REPRESENTATION_MAP(#930,#2);\n", "#100=MAPPED_ITEM('',$,#911);\n"}) {
    const StepTree tree =
        tree_of(shape_text(1, {100, 921}) + shape_text(2, {910, 922}) + product_text(10, "p", {1}) + bad);
    ASSERT_EQ(tree.places.size(), 1u) << bad;
    expect_remark(tree, "a mapped item is left out: #");
  }
}

TEST(StepTreeErrors, OfCyclesAreRemarks) {
  // A product in itself, and below a root: the rest stays.
  const StepTree own = tree_of(boxed_text(use_text(40, "loop", 20, 20)));
  ASSERT_EQ(own.places.size(), 1u);
  expect_remark(own, "#40 NEXT_ASSEMBLY_USAGE_OCCURRENCE in line");
  const StepTree above =
      tree_of(boxed_text(use_text(40, "up", 20, 10) + product_text(50, "top", {}) + use_text(60, "", 50, 10)));
  ASSERT_EQ(above.places.size(), 1u);
  expect_remark(above, "it puts a whole into itself, and is left out");
  // Without a root, the shapes are read as those of a file without products.
  EXPECT_EQ(tree_of(boxed_text(use_text(40, "up", 20, 10))).places.size(), 1u);
  // Mapped items and relationships.
  const StepTree mapped =
      tree_of(shape_text(1, {910, 921, 100}) + shape_text(2, {910, 922, 110}) + product_text(10, "p", {1}) +
              mapped_text(100, 2, 910, 911) + mapped_text(110, 1, 910, 911));
  EXPECT_EQ(mapped.places.size(), 2u);
  expect_remark(mapped, "#110 MAPPED_ITEM in line");
  EXPECT_EQ(tree_of(shape_text(1, {910, 921, 100}) + mapped_text(100, 1, 910, 911)).places.size(), 1u);
  EXPECT_EQ(
      tree_of(shape_text(1, {910, 921, 100}) + shape_text(2, {922}) + mapped_text(100, 1, 910, 911)).places.size(), 1u);
}

/// Assemblies 0 to `levels`, each of two of the next one; the last has the shape #1.
std::string doubling_text(int levels, int uses) {
  std::string out = shape_text(1, {910, 921});
  for (int k = 0; k <= levels; ++k) {
    const int first = 1000 + 100 * k;
    out += product_text(first, "p", k == levels ? std::vector<int>{1} : std::vector<int>{});
    for (int use = 0; use < uses && k < levels; ++use) out += use_text(first + 50 + use, "u", first, first + 100);
  }
  return out;
}

TEST(StepTreeErrors, OfTooManyPlacesAreSaid) {
  EXPECT_EQ(tree_of(doubling_text(10, 2)).places.size(), 1024u);
  for (const int levels : {21, 40, 200}) {
    const StepTextFile file(step_basics + doubling_text(levels, 2));
    expect_refused(read_step_tree(file.index), StatusCode::unsupported, Status::no_index,
                   "it places parts more than 1048576 times");
  }
  // Assemblies of nothing have no places, however many they are.
  std::string empty = doubling_text(60, 2);
  empty.replace(empty.find("(#910,#921)"), 11, "(#910)");
  EXPECT_EQ(tree_of(empty).places.size(), 0u);
}

TEST(StepTreeErrors, OfTooDeepAssembliesAreSaid) {
  EXPECT_EQ(tree_of(doubling_text(250, 1)).places.size(), 1u);
  for (const int levels : {300, 20000}) {
    const StepTextFile file(step_basics + doubling_text(levels, 1));
    expect_refused(read_step_tree(file.index), StatusCode::unsupported, Status::no_index,
                   "assemblies within each other more than 256 times");
  }
}

TEST(StepTreeErrors, OfPlacesBeyondDoubleLeaveTheirPartOut) {
  std::string text = shape_text(1, {910, 100}) + shape_text(2, {910, 110}) + shape_text(3, {910, 921}) +
                     product_text(10, "p", {1}) + mapped_text(100, 2, 910, 200) + mapped_text(110, 3, 910, 201);
  for (const std::string number : {"#200", "#201"})
    text += number + "=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,$,#931,1.E200,$);\n";
  const StepTree tree = tree_of(text);
  EXPECT_EQ(tree.places.size(), 0u);
  expect_remark(tree, "its place is beyond the range of double");
}

TEST(StepTreeErrors, OfFilesWithoutShapesAreNone) {
  const StepTree none = tree_of("");
  EXPECT_TRUE(none.places.empty());
  EXPECT_TRUE(none.parts.empty());
  EXPECT_EQ(none.file_unit, "");
  EXPECT_EQ(none.colours.size(), 1u);
  EXPECT_TRUE(tree_of(product_text(10, "p", {}) + "#5=PRODUCT_DEFINITION('','',#77,$);\n").places.empty());
}

}}  // namespace tessera::test
