// Files whose text OpenCASCADE does not read in full: what is completed, and what is said of the rest.

#include <gtest/gtest.h>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepTools.hxx>
#include <opencascade/TopTools_FormatVersion.hxx>
#include <opencascade/gp_Pnt.hxx>

#include <sstream>

#include "io_occt/cad_shapes.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

/// Lines of an IGES file of one bilinear surface over the square of 4 x 2: z = 0, u from 0 to 2 along x. `ranges` are
/// the last parameters of the surface.
std::string iges_text(const std::string& ranges) {
  const auto line = [](std::string text, const std::string& end) {
    text.resize(72 - (end[0] == 'P' ? 8 : 0), ' ');
    return text + (end[0] == 'P' ? "       1" : "") + end + "\n";
  };
  return line("", "S      1") + line("1H,,1H;,4Hpart,8Hpart.igs,4Hnone,1H1,32,38,6,308,15,4Hpart,1.,2,", "G      1") +
         line("2HMM,1,0.01,15H20260101.000000,1E-4,60.,4Hnone,4Hnone,11,0,", "G      2") +
         line("15H20260101.000000;", "G      3") +
         line("     128       1       0       0       0       0       0       000000000", "D      1") +
         line("     128       0       0       2       0                               0", "D      2") +
         line("128,1,1,1,1,0,0,1,0,0,0.,0.,2.,2.,0.,0.,1.,1.,1.,1.,1.,1.,", "P      1") +
         line("0.,0.,0.,4.,0.,0.,0.,2.,0.,4.,2.,0." + ranges + ";", "P      2") +
         line("S      1G      3D      2P      2", "T      1");
}

TEST(IgesRanges, ThatAreLeftOutAreThoseOfTheKnots) {
  const ScratchFolder folder;
  for (const char* const ranges : {"", ",,,,", ",0.,2.", ",0.,2.,0.,1."}) {
    const Model model = value_of(read_by_opencascade(folder.file("part.igs", iges_text(ranges))));
    ASSERT_EQ(model.surfaces.size(), 1u) << ranges;
    EXPECT_EQ(std::get<BSplineSurface>(model.surfaces[0].surface).domain(), (Domain{0, 2, 0, 1})) << ranges;
    EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
  }
}

TEST(IgesRanges, ArePartsOfTheSurface) {
  const ScratchFolder folder;
  const Model model = value_of(read_by_opencascade(folder.file("part.igs", iges_text(",0.5,1.5,0.25,1."))));
  ASSERT_EQ(model.surfaces.size(), 1u);
  const BSplineSurface& surface = std::get<BSplineSurface>(model.surfaces[0].surface);
  EXPECT_EQ(surface.domain(), (Domain{0.5, 1.5, 0.25, 1}));
  EXPECT_LT(length(evaluate_jet(surface, 0.5, 0.25).position - Vec3{1, 0.5, 0}), 1e-12);
  EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
}

TEST(IgesRanges, BeyondTheKnotsAreSaid) {
  const ScratchFolder folder;
  const Model model = value_of(read_by_opencascade(folder.file("part.igs", iges_text(",3.,4.,0.,1."))));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("is taken as the whole surface, its range is u from 3 to 4"), std::string::npos)
      << model.warnings[0];
}

TEST(Contents, OfFilesWithoutSurfacesAreSaid) {
  const ScratchFolder folder;
  write_cad(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder / "box.step");
  std::string step = content_of(folder / "box.step");
  const std::size_t solid = step.find("MANIFOLD_SOLID_BREP('',");
  ASSERT_NE(solid, std::string::npos);
  const std::string entities = "#90001=CSG_SOLID('',#90002);\n#90002=BLOCK('',#11,1.,2.,3.);\n";
  step.insert(step.rfind("ENDSEC;"), entities);
  const Model both = value_of(read_by_opencascade(folder.file("both.step", step)));
  ASSERT_EQ(both.warnings.size(), 1u);
  EXPECT_NE(both.warnings[0].find("shapes of these kinds are not read: 1 CSG_SOLID, 1 BLOCK"), std::string::npos);

  const std::string alone =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
      "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#11=CARTESIAN_POINT('',(0.,0.,0.));\n" +
      entities + "ENDSEC;\nEND-ISO-10303-21;\n";
  expect_refused(read_by_opencascade(folder.file("alone.step", alone)), StatusCode::parse_error, Status::no_index,
                 "it holds no surfaces (1 CSG_SOLID, 1 BLOCK)");

  write_cad(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape(), folder / "line.brep");
  expect_refused(read_by_opencascade(folder / "line.brep"), StatusCode::parse_error, Status::no_index,
                 "it holds no surfaces (1 edge, 2 vertices)");
}

TEST(BrepVersions, AreKnownByTheirNumber) {
  const ScratchFolder folder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  std::string text;
  std::size_t place = 0, end = 0;
  for (const TopTools_FormatVersion version :
       {TopTools_FormatVersion_VERSION_1, TopTools_FormatVersion_VERSION_2, TopTools_FormatVersion_VERSION_3}) {
    std::ostringstream stream;
    BRepTools::Write(box, stream, false, false, version);
    text = stream.str();
    const std::string mark = "CASCADE Topology V" + std::to_string(static_cast<int>(version));
    place = text.find(mark), end = text.find('\n', place);
    ASSERT_NE(place, std::string::npos) << mark;
    for (const char* const owner : {"Matra-Datavision", "Open Cascade", "Open CASCADE Tools\r"}) {
      std::string other = text;
      other.replace(place, end - place, mark + ", (c) " + owner);
      EXPECT_EQ(value_of(read_by_opencascade(folder.file("other.brep", other))).surfaces.size(), 6u) << mark << owner;
    }
  }
  text.replace(place, end - place, "CASCADE Topology V4, (c) Nobody");
  expect_refused(read_by_opencascade(folder.file("new.brep", text)), StatusCode::parse_error, Status::no_index,
                 "its version must be 1 to 3, found \"CASCADE Topology V4, (c) Nobody\"");
}

}}  // namespace tessera::test
