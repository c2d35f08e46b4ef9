// Facts that files state of single instances: colours, names, scales and mirrors.

#include <gtest/gtest.h>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/TopoDS_Compound.hxx>
#include <opencascade/gp_Trsf.hxx>

#include <algorithm>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tess_trim/closed_shape.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

/// The number of the k-th entity of a kind: "#15" of "#15 = ADVANCED_FACE(".
std::string instances_number_of(const std::string& step, const std::string& kind, int k = 0) {
  std::size_t end = step.find(" = " + kind + "(");
  while (k-- > 0) end = step.find(" = " + kind + "(", end + 1);
  EXPECT_NE(end, std::string::npos) << kind;
  const std::size_t begin = step.rfind('#', end);
  return step.substr(begin, end - begin);
}

void insert(std::string& step, const std::string& entities) { step.insert(step.rfind("ENDSEC;"), entities); }

/// A box of 1 x 2 x 3.
std::string box_text(const ScratchFolder& folder) {
  write_cad(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder / "plain.step");
  return content_of(folder / "plain.step");
}

/// Two instances of the box as an assembly, 10 apart.
std::string assembly_text(const ScratchFolder& folder) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  gp_Trsf right;
  right.SetTranslation(gp_Vec(10, 0, 0));
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  BRep_Builder().Add(both, box);
  BRep_Builder().Add(both, box.Moved(right));
  write_cad(both, folder / "both.step");
  return content_of(folder / "both.step");
}

/// Entities from #90001 on that colour an item red, if there is a context in it alone.
std::string red_style(const std::string& item, const std::string& context) {
  return "#90001=STYLED_ITEM('',(#90002)," + item + ");\n#90002=" +
         (context.empty() ? "PRESENTATION_STYLE_ASSIGNMENT((#90003)"
                          : "PRESENTATION_STYLE_BY_CONTEXT((#90003)," + context) +
         ");\n#90003=SURFACE_STYLE_USAGE(.BOTH.,#90004);\n#90004=SURFACE_SIDE_STYLE('',(#90005));\n"
         "#90005=SURFACE_STYLE_FILL_AREA(#90006);\n#90006=FILL_AREA_STYLE('',(#90007));\n"
         "#90007=FILL_AREA_STYLE_COLOUR('',#90008);\n#90008=DRAUGHTING_PRE_DEFINED_COLOUR('red');\n";
}

std::size_t red_faces(const Shape& shape) {
  return static_cast<std::size_t>(std::ranges::count_if(shape.faces, [](const ShapeFace& face) {
    return face.colour == Colour{1, 0, 0};
  }));
}

TEST(Instances, HaveColoursOfTheirOwn) {
  const ScratchFolder folder;
  std::string step = assembly_text(folder);
  ASSERT_NE(step.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE"), std::string::npos);
  const std::string use = instances_number_of(step, "NEXT_ASSEMBLY_USAGE_OCCURRENCE", 1);
  insert(step, "#90010=PRODUCT_DEFINITION_SHAPE('',''," + use +
                   ");\n#90011=SHAPE_DEFINITION_REPRESENTATION(#90010,#90012);\n"
                   "#90012=SHAPE_REPRESENTATION('',(),$);\n" +
                   red_style(instances_number_of(step, "MANIFOLD_SOLID_BREP"), "#90012"));
  const Model model = value_of(read_by_opencascade(folder.file("coloured.step", step)));
  EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(red_faces(model.shapes[model.instances[0].shape]), 0u);
  EXPECT_EQ(red_faces(model.shapes[model.instances[1].shape]), 6u);
  EXPECT_EQ(model.instances[1].placement->point({}).x, 10);
}

TEST(Instances, ColoursOfOtherContextsAreSaid) {
  const ScratchFolder folder;
  std::string step = box_text(folder);
  insert(step, red_style(instances_number_of(step, "MANIFOLD_SOLID_BREP"),
                         instances_number_of(step, "ADVANCED_BREP_SHAPE_REPRESENTATION")));
  const Model model = value_of(read_by_opencascade(folder.file("context.step", step)));
  EXPECT_EQ(red_faces(model.shapes.at(0)), 0u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find(": 1 colour of single contexts not read"), std::string::npos) << model.warnings[0];
}

TEST(Instances, AreNamedByTheirIdWhereTheNameIsEmpty) {
  const ScratchFolder folder;
  std::string step = assembly_text(folder);
  std::size_t use = 0;
  for (const std::string name : {"left", "right"}) {
    use = step.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE(", use + 1);
    ASSERT_NE(use, std::string::npos);
    const std::size_t id = step.find('\'', use);  // the quotes of two words
    std::size_t end = id;
    for (int k = 0; k < 3; ++k) end = step.find('\'', end + 1);
    step.replace(id, end + 1 - id, "'" + name + "',''");
  }
  const Model model = value_of(read_by_opencascade(folder.file("named.step", step)));
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(*model.instances[0].name, "left");
  EXPECT_EQ(*model.instances[1].name, "right");
}

/// The box as a mapped item: its representation is mapped from the origin to `target`, an operator #90003.
std::string mapped_text(const ScratchFolder& folder, const std::string& target) {
  std::string step = box_text(folder);
  const std::string whole = instances_number_of(step, "ADVANCED_BREP_SHAPE_REPRESENTATION");
  const std::size_t begin = step.find(whole + " = ADVANCED"), context_end = step.find(");", begin);
  const std::string context = step.substr(step.rfind('#', context_end), context_end - step.rfind('#', context_end));
  const std::string origin = instances_number_of(step, "AXIS2_PLACEMENT_3D");
  const std::size_t link = step.find(",", step.find("SHAPE_DEFINITION_REPRESENTATION(")) + 1;
  step.replace(link, step.find(')', link) - link, "#90006");
  insert(step, "#90001=REPRESENTATION_MAP(" + origin + "," + whole + ");\n#90002=MAPPED_ITEM('',#90001,#90003);\n" +
                   target + "#90006=SHAPE_REPRESENTATION('',(#90002)," + context + ");\n");
  return step;
}

TEST(Instances, KeepTheScalesAndMirrorsOfMappedItems) {
  const std::string axes =
      "#90004=CARTESIAN_POINT('',(5.,0.,0.));\n#90007=DIRECTION('',(1.,0.,0.));\n#90008=DIRECTION('',(0.,-1.,0.));\n"
      "#90009=DIRECTION('',(0.,0.,1.));\n";
  const std::string begin = "#90003=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,";
  struct Case {
    std::string target;
    double volume, lowest_y;
  };
  const std::vector<Case> cases{{begin + "$,$,#90004,2.,$);\n", 48, 0},
                                {begin + "#90007,#90008,#90004,1.,#90009);\n", 6, -2},
                                {begin + "#90007,#90008,#90004,2.,#90009);\n", 48, -4},
                                {begin + "$,$,#90004,1.,$);\n", 6, 0}};
  for (const Case& c : cases) {
    const ScratchFolder folder;
    const Model model = value_of(read_by_opencascade(folder.file("mapped.step", mapped_text(folder, axes + c.target))));
    ASSERT_EQ(model.instances.size(), 1u) << c.target;
    const PatchSet set = value_of(make_patch_set(model));
    const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.1}));
    Mesh mesh = value_of(plan.allocate());
    ASSERT_TRUE(plan.run(set, mesh.views()).ok());
    EXPECT_NEAR(volume_and_area(mesh)[0], c.volume, 1e-4) << c.target;
    double lowest_x = 1e9, lowest_y = 1e9;
    for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
      lowest_x = std::min(lowest_x, vertex(mesh, k).x);
      lowest_y = std::min(lowest_y, vertex(mesh, k).y);
    }
    EXPECT_NEAR(lowest_x, 5, 1e-5);
    EXPECT_NEAR(lowest_y, c.lowest_y, 1e-5);
  }
}

TEST(Instances, OfMappedItemsHaveColoursOfTheirOwn) {
  const ScratchFolder folder;
  std::string step = mapped_text(folder,
                                 "#90003=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,$,#90004,1.,$);\n"
                                 "#90004=CARTESIAN_POINT('',(5.,0.,0.));\n");
  const std::string items = "SHAPE_REPRESENTATION('',(#90002)";
  step.replace(step.find(items), items.size(), "SHAPE_REPRESENTATION('',(#90002,#90022)");
  insert(step,
         "#90022=MAPPED_ITEM('',#90001,#90023);\n#90024=CARTESIAN_POINT('',(9.,0.,0.));\n"
         "#90023=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,$,#90024,1.,$);\n");
  std::string style = red_style("#90022", "");
  for (int k = 1; k <= 8; ++k) {  // numbers that are free
    const std::string given = "#9000" + std::to_string(k), free = "#9010" + std::to_string(k);
    for (std::size_t at = style.find(given); at != std::string::npos; at = style.find(given))
      style.replace(at, given.size(), free);
  }
  insert(step, style);
  const Model model = value_of(read_by_opencascade(folder.file("coloured.step", step)));
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(model.instances[0].placement->point({}).x, 5);
  EXPECT_EQ(red_faces(model.shapes[model.instances[0].shape]), 0u);
  EXPECT_EQ(red_faces(model.shapes[model.instances[1].shape]), 6u);
}

TEST(Names, OfLatin1AndGbkBecomeUtf8) {
  const ScratchFolder folder;
  const std::vector<std::array<std::string, 3>> names{{"Geh\xE4use", "Geh\xC3\xA4use", "Latin-1"},
                                                      {"\xD7\xB0\xC5\xE4", "\xE8\xA3\x85\xE9\x85\x8D", "GBK"},
                                                      {"Geh\xC3\xA4use", "Geh\xC3\xA4use", ""}};
  for (const auto& [given, expected, encoding] : names) {
    std::string step = box_text(folder);
    const std::size_t product = step.find("PRODUCT('") + 9;
    step.replace(product, step.find('\'', product) - product, "1");
    const std::size_t name = step.find('\'', product + 2) + 1;
    step.replace(name, step.find('\'', name) - name, given);
    const Model model = value_of(read_by_opencascade(folder.file("named.step", step)));
    EXPECT_EQ(*model.shapes.at(0).name, expected);
    EXPECT_EQ(model.warnings.size(), encoding.empty() ? 0u : 1u);
    for (const std::string& warning : model.warnings) EXPECT_NE(warning.find(encoding), std::string::npos) << warning;
  }
}

}}  // namespace tessera::test
