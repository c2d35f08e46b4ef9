// Colours of STEP texts: of items everywhere, of single instances, and what is malformed.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "io_step/step_tree_text.h"

namespace tessera::test { namespace {

constexpr Colour red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};
const std::string red_text = "DRAUGHTING_PRE_DEFINED_COLOUR('red')", green_text = "PRE_DEFINED_COLOUR('green')",
                  blue_text = "COLOUR_RGB('',0.,0.,1.)";

std::optional<Colour> colour_of(const StepTree& tree, std::size_t place, std::uint64_t item) {
  const Colour* const found = tree.colours[tree.places.at(place).colours].find(item);
  return found == nullptr ? std::optional<Colour>() : *found;
}

const std::string styled_box = shape_text(1, {910, 921, 922}) + product_text(10, "box", {1});

TEST(StepStyles, AreThoseOfTheFile) {
  struct Case {
    std::string text;
    std::optional<Colour> colour;
  };
  for (const Case& c :
       {Case{red_text, red}, Case{green_text, green}, Case{"COLOUR_RGB('',0.25,0.5,1)", Colour{0.25F, 0.5F, 1}},
        Case{"COLOUR_RGB('',255.,51.,0.)", Colour{1, 0.2F, 0}}, Case{"COLOUR_RGB('',-1.,0.5,0.)", Colour{0, 0.5F, 0}},
        Case{"DRAUGHTING_PRE_DEFINED_COLOUR('puce')", {}}, Case{"COLOUR()", {}}}) {
    const StepTree tree = tree_of(styled_box + style_text(100, "#921", c.text));
    EXPECT_EQ(colour_of(tree, 0, 921), c.colour) << c.text;
    EXPECT_EQ(colour_of(tree, 0, 922), std::nullopt);
    EXPECT_EQ(tree.remarks.count, 0u) << c.text;
  }
}

TEST(StepStyles, LaterOnesAndThoseThatOverrideCount) {
  const StepTree tree = tree_of(styled_box + style_text(100, "#921", red_text, "OVER_RIDING_STYLED_ITEM", ",#110") +
                                style_text(110, "#921", green_text) + style_text(120, "#922", red_text) +
                                style_text(130, "#922", blue_text));
  EXPECT_EQ(colour_of(tree, 0, 921), red);
  EXPECT_EQ(colour_of(tree, 0, 922), blue);
}

/// The box with a style whose side has these elements.
std::string side_text(const std::string& elements, const std::string& more, const std::string& side = "BOTH") {
  return styled_box +
         "#100=STYLED_ITEM('',(#101),#921);\n#101=PRESENTATION_STYLE_ASSIGNMENT((#102));\n"
         "#102=SURFACE_STYLE_USAGE(." +
         side + ".,#103);\n#103=SURFACE_SIDE_STYLE('',(" + elements + "));\n" + more;
}

TEST(StepStyles, OfRenderingGoBeforeFills) {
  const std::string more =
      "#110=SURFACE_STYLE_FILL_AREA(#111);\n#111=FILL_AREA_STYLE('',(#112));\n#112=FILL_AREA_STYLE_COLOUR('',#113);\n"
      "#113=COLOUR_RGB('',1.,0.,0.);\n"
      "#120=SURFACE_STYLE_RENDERING_WITH_PROPERTIES(.NORMAL_SHADING.,#121,(#122));\n#121=COLOUR_RGB('',0.,1.,0.);\n"
      "#122=SURFACE_STYLE_TRANSPARENT(0.75);\n#130=SURFACE_STYLE_RENDERING(.NORMAL_SHADING.,#131);\n"
      "#131=COLOUR_RGB('',0.,0.,1.);\n";
  EXPECT_EQ(colour_of(tree_of(side_text("#110", more)), 0, 921), red);
  EXPECT_EQ(colour_of(tree_of(side_text("#110,#120", more)), 0, 921), (Colour{0, 1, 0, 0.25F}));
  EXPECT_EQ(colour_of(tree_of(side_text("#120,#110", more)), 0, 921), (Colour{0, 1, 0, 0.25F}));
  EXPECT_EQ(colour_of(tree_of(side_text("#130", more)), 0, 921), blue);
  EXPECT_EQ(colour_of(tree_of(side_text("#110", more, "NEGATIVE")), 0, 921), red);
  EXPECT_EQ(colour_of(tree_of(side_text("", more)), 0, 921), std::nullopt);
}

TEST(StepStyles, OfTheNegativeSideCountAlone) {
  std::string text = styled_box + style_text(100, "#921", red_text) + style_text(110, "#922", green_text);
  const std::string list = "(NULL_STYLE(.NULL.),#102)";
  text.replace(text.find(list), list.size(), "(#102,#112)");
  const std::size_t both = text.find(".BOTH.", text.find("#112=SURFACE_STYLE_USAGE"));
  EXPECT_EQ(colour_of(tree_of(text), 0, 921), green);
  text.replace(both, 6, ".NEGATIVE.");
  EXPECT_EQ(colour_of(tree_of(text), 0, 921), red);
}

TEST(StepStyles, ThatAreMalformedAreRemarks) {
  for (const std::string bad :
       {"#200=STYLED_ITEM('',(#100),#77);\n", "#200=STYLED_ITEM('',#101,#921);\n", "#200=STYLED_ITEM('');\n",
        "#200=STYLED_ITEM('',(#201),#921);\n#201=PRESENTATION_STYLE_ASSIGNMENT((#77));\n",
        "#200=STYLED_ITEM('',(#201),#921);\n#201=PRESENTATION_STYLE_ASSIGNMENT((#202));\n#202=SURFACE_STYLE_USAGE(1,#"
        "203);\n",
        "#200=STYLED_ITEM('',(#201),#921);\n#201=PRESENTATION_STYLE_ASSIGNMENT((#202));\n"
        "#202=SURFACE_STYLE_USAGE(.BOTH.,#203);\n#203=SURFACE_SIDE_STYLE('',(#204));\n#204=SURFACE_STYLE_RENDERING(.A.,"
        "#205);\n"
        "#205=COLOUR_RGB('',1.E999,0.,0.);\n"}) {
    const StepTree tree = tree_of(styled_box + style_text(100, "#922", red_text) + bad);
    EXPECT_EQ(colour_of(tree, 0, 922), red) << bad;
    EXPECT_EQ(colour_of(tree, 0, 921), std::nullopt) << bad;
    EXPECT_EQ(tree.remarks.count, 1u) << bad;
  }
}

/// Two uses of the box in an assembly, and a representation #60 that is the context of the second.
const std::string uses_text = shape_text(1, {910, 921}) + shape_text(2, {910, 911}) + product_text(10, "box", {1}) +
                              product_text(20, "whole", {2}) + use_text(30, "a", 20, 10) +
                              place_text(30, 1, 2, 910, 910) + use_text(40, "b", 20, 10) +
                              place_text(40, 1, 2, 910, 911) +
                              "#60=SHAPE_REPRESENTATION('',(),$);\n"
                              "#61=SHAPE_DEFINITION_REPRESENTATION(#41,#60);\n";

TEST(StepStyles, OfContextsAreThoseOfSingleInstances) {
  std::string limited = uses_text + style_text(100, "#921", red_text);
  const std::string kind = "PRESENTATION_STYLE_ASSIGNMENT((NULL_STYLE(.NULL.),#102))";
  limited.replace(limited.find(kind), kind.size(), "PRESENTATION_STYLE_BY_CONTEXT((#102),#60)");
  const std::string begin = uses_text + style_text(200, "#921", green_text);
  const auto overriding = [&](const std::string& contexts) {
    return begin +
           style_text(100, "#921", red_text, "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM", ",#200,(" + contexts + ")");
  };
  for (const std::string& text :
       {limited, overriding("#60"), overriding("#40"), overriding("#42"), overriding("#43")}) {
    const StepTree tree = tree_of(text);
    ASSERT_EQ(tree.places.size(), 2u);
    EXPECT_EQ(tree.places[0].part, tree.places[1].part);
    EXPECT_NE(tree.places[0].colours, tree.places[1].colours);
    EXPECT_EQ(colour_of(tree, 0, 921), text == limited ? std::optional<Colour>() : green);
    EXPECT_EQ(colour_of(tree, 1, 921), red);
    EXPECT_EQ(tree.remarks.count, 0u);
  }
}

TEST(StepStyles, OfOtherContextsAreSaid) {
  const StepTree tree =
      tree_of(uses_text + style_text(100, "#921", red_text, "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM", ",#100,(#1)"));
  EXPECT_EQ(colour_of(tree, 0, 921), std::nullopt);
  ASSERT_EQ(tree.remarks.count, 1u);
  EXPECT_EQ(tree.remarks.texts[0], "1 colour of single contexts not read");
}

TEST(StepStyles, NeedAllOfTheirContexts) {
  // Two pairs of two boxes; the second box of the first pair is red.
  const std::string pairs = shape_text(1, {910, 921}) + product_text(10, "box", {1}) + product_text(20, "pair", {}) +
                            product_text(50, "whole", {}) + use_text(30, "a", 20, 10) + use_text(31, "b", 20, 10) +
                            use_text(40, "p", 50, 20) + use_text(41, "q", 50, 20);
  const StepTree tree = tree_of(
      pairs + style_text(100, "#921", red_text, "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM", ",#100,(#31,#40)"));
  ASSERT_EQ(tree.places.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(colour_of(tree, k, 921), k == 1 ? std::optional<Colour>(red) : std::nullopt) << k;
  // The outer instance's colour goes before that of the inner one.
  const std::string kind = "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM";
  const StepTree both = tree_of(pairs + style_text(100, "#921", red_text, kind, ",#100,(#40)") +
                                style_text(110, "#921", blue_text, kind, ",#100,(#30)"));
  EXPECT_EQ(colour_of(both, 0, 921), red);
  EXPECT_EQ(colour_of(both, 1, 921), red);
  EXPECT_EQ(colour_of(both, 2, 921), blue);
  EXPECT_EQ(colour_of(both, 3, 921), std::nullopt);
}

TEST(StepStyles, OfMappedItemsAreThoseOfTheirShape) {
  const StepTree tree = tree_of(shape_text(1, {100, 110}) + shape_text(2, {910, 921}) + product_text(10, "p", {1}) +
                                mapped_text(100, 2, 910, 911) + mapped_text(110, 2, 910, 912) +
                                style_text(200, "#110", red_text) + style_text(210, "#1", blue_text));
  ASSERT_EQ(tree.places.size(), 2u);
  EXPECT_EQ(colour_of(tree, 0, 2), std::nullopt);
  EXPECT_EQ(colour_of(tree, 1, 2), red);
  EXPECT_EQ(colour_of(tree, 0, 921), std::nullopt);
  EXPECT_EQ(colour_of(tree, 1, 921), red);  // the only item
  EXPECT_EQ(tree.places[0].colour, blue);   // that of the representation which holds them
  EXPECT_EQ(tree.places[1].colour, blue);
}

}}  // namespace tessera::test
