// Colours of STEP files: those of solids and faces, in sRGB as the files' authors see them.

#include <gtest/gtest.h>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>

#include <filesystem>
#include <map>
#include <string>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

/// The number of the first entity of a kind: 15 of "#15 = ADVANCED_FACE(".
std::string number_of(const std::string& step, const std::string& kind) {
  const std::size_t end = step.find(" = " + kind + "("), begin = step.rfind('#', end);
  EXPECT_NE(end, std::string::npos) << kind;
  return step.substr(begin, end - begin);
}

/// The entities with numbers from `first` on that give an item a colour, which is the last of them. `assignment` is
/// PRESENTATION_STYLE_ASSIGNMENT, or that of a context with `context` as its second argument.
std::string style(int first, const std::string& item, const std::string& colour,
                  const std::string& assignment = "PRESENTATION_STYLE_ASSIGNMENT", const std::string& context = "") {
  const auto id = [first](int k) { return "#" + std::to_string(first + k); };
  return id(0) + "=STYLED_ITEM('color',(" + id(1) + ")," + item + ");\n" + id(1) + "=" + assignment + "((" + id(2) +
         ")" + context + ");\n" + id(2) + "=SURFACE_STYLE_USAGE(.BOTH.," + id(3) + ");\n" + id(3) +
         "=SURFACE_SIDE_STYLE('',(" + id(4) + "));\n" + id(4) + "=SURFACE_STYLE_FILL_AREA(" + id(5) + ");\n" + id(5) +
         "=FILL_AREA_STYLE('',(" + id(6) + "));\n" + id(6) + "=FILL_AREA_STYLE_COLOUR(''," + id(7) + ");\n" + id(7) +
         "=" + colour + ";\n";
}

class StepColours : public testing::Test {
 protected:
  StepColours() {
    const std::string path = folder_ / "plain.step";
    write_cad(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
    step_ = content_of(path);
  }

  /// The box with more entities, of which `styles` are those of a presentation.
  Model box_with(const std::string& entities, const std::string& styles) {
    std::string step = step_;
    step.insert(step.rfind("ENDSEC;"), entities +
                                           "#90000=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(" +
                                           styles + ")," + context() + ");\n");
    return value_of(read_by_opencascade(folder_.file("box.step", step)));
  }
  std::string context() const {
    const std::size_t end = step_.find(" = ( GEOMETRIC_REPRESENTATION_CONTEXT(3)"), begin = step_.rfind('#', end);
    EXPECT_NE(end, std::string::npos);
    return step_.substr(begin, end - begin);
  }

  ScratchFolder folder_;
  std::string step_;
};

void expect_near(const std::optional<Colour>& found, const Colour& expected) {
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->red, expected.red, 1e-6);
  EXPECT_NEAR(found->green, expected.green, 1e-6);
  EXPECT_NEAR(found->blue, expected.blue, 1e-6);
  EXPECT_NEAR(found->alpha, expected.alpha, 1e-6);
}

TEST_F(StepColours, ValuesOfTheFileAreSrgb) {
  const Model model =
      box_with(style(90001, number_of(step_, "MANIFOLD_SOLID_BREP"), "COLOUR_RGB('',0.25,0.5,0.75)"), "#90001");
  ASSERT_EQ(model.shapes.size(), 1u);
  ASSERT_EQ(model.shapes[0].faces.size(), 6u);
  for (const ShapeFace& face : model.shapes[0].faces) expect_near(face.colour, {0.25f, 0.5f, 0.75f});
}

TEST_F(StepColours, FacesHaveTheirOwnColours) {
  const Model model =
      box_with(style(90001, number_of(step_, "MANIFOLD_SOLID_BREP"), "COLOUR_RGB('',0.25,0.5,0.75)") +
                   style(90011, number_of(step_, "ADVANCED_FACE"), "DRAUGHTING_PRE_DEFINED_COLOUR('red')"),
               "#90001,#90011");
  std::size_t red = 0;
  for (const ShapeFace& face : model.shapes.at(0).faces) red += face.colour == Colour{1, 0, 0};
  EXPECT_EQ(red, 1u);
  expect_near(model.shapes[0].faces.back().colour, {0.25f, 0.5f, 0.75f});
}

TEST_F(StepColours, StylesOfOneContextAreLeftOut) {
  const Model model =
      box_with(style(90001, number_of(step_, "MANIFOLD_SOLID_BREP"), "COLOUR_RGB('',0.25,0.5,0.75)",
                     "PRESENTATION_STYLE_BY_CONTEXT", "," + number_of(step_, "ADVANCED_BREP_SHAPE_REPRESENTATION")),
               "#90001");
  for (const ShapeFace& face : model.shapes.at(0).faces) EXPECT_FALSE(face.colour);
}

TEST(RealColours, EachPartOfAnAssemblyHasItsOwn) {
  for (const std::filesystem::path& path : real_cad_files()) {
    if (path.filename() != "as1-oc-214.stp") continue;
    const Model model = value_of(read_by_opencascade(path));
    // STYLED_ITEMs of the file.
    const std::map<std::string, Colour> expected{{"nut", {1, 0, 0}},
                                                 {"rod", {1, 0.5f, 0}},
                                                 {"bolt", {0, 0, 1}},
                                                 {"l-bracket", {0, 1, 0}},
                                                 {"plate", {0.8f, 1, 0}}};
    ASSERT_EQ(model.shapes.size(), expected.size());
    for (const Shape& shape : model.shapes)
      for (const ShapeFace& face : shape.faces) {
        SCOPED_TRACE(*shape.name);
        expect_near(face.colour, expected.at(*shape.name));
      }
    return;
  }
  GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
}

}}  // namespace tessera::test
