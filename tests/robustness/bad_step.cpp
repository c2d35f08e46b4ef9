// Texts of STEP files.

#include "robustness/bad_step.h"

#include "tessera/cad.h"

namespace tessera::test {
namespace {

std::string step_file(const std::string& data) {
  return "ISO-10303-21;\nHEADER;ENDSEC;\nDATA;\n" + data +
         "#90=SHAPE_REPRESENTATION('',(#10),#91);\n#91=GEOMETRIC_REPRESENTATION_CONTEXT('','',3);\n"
         "#92=CARTESIAN_POINT('',(0.,0.,0.));\n#93=AXIS2_PLACEMENT_3D('',#92,$,$);\n#94=VERTEX_POINT('',#95);\n"
         "#95=CARTESIAN_POINT('',(0.,0.,2.));\n#96=VERTEX_LOOP('',#94);\n#97=FACE_BOUND('',#96,.T.);\n"
         "#98=SPHERICAL_SURFACE('',#93,2.);\n#99=ADVANCED_FACE('',(#97),#98,.T.);\nENDSEC;\nEND-ISO-10303-21;\n";
}

/// A shell of a face with one loop on the surface #12.
std::string faced(const std::string& surface, const std::string& loop = "VERTEX_LOOP('',#94)") {
  return step_file("#10=CLOSED_SHELL('',(#11));\n#11=ADVANCED_FACE('',(#13),#12,.T.);\n#12=" + surface +
                   ";\n#13=FACE_BOUND('',#14,.T.);\n#14=" + loop + ";\n");
}

}  // namespace

Status parse_step(std::string_view text) {
  const Result<Model> model = parse_cad(text, "m.stp");
  return model ? Status() : model.status();
}

void step_rows(const std::function<void(const std::string& input, const std::string& text, StatusCode code)>& row) {
  using enum StatusCode;
  row("no DATA section", "ISO-10303-21;\nHEADER;ENDSEC;\nEND-ISO-10303-21;\n", parse_error);
  row("a text that is cut", step_file("#10=CLOSED_SHELL('',(#99));\n").substr(0, 150), parse_error);
  row("no shapes", step_file("#10=CARTESIAN_POINT('',(0.,0.,0.));\n"), parse_error);
  row("a shell that lists nothing in the file", step_file("#10=CLOSED_SHELL('',(#77));\n"), parse_error);
  row("a shell that lists itself", step_file("#10=CLOSED_SHELL('',(#10));\n"), parse_error);
  row("a shell of a number", step_file("#10=CLOSED_SHELL('',(7));\n"), parse_error);
  row("a sphere of radius 0", faced("SPHERICAL_SURFACE('',#93,0.)"), parse_error);
  row("a sphere of radius 1e400", faced("SPHERICAL_SURFACE('',#93,1.E400)"), parse_error);
  row("a cone of 2 radians", faced("CONICAL_SURFACE('',#93,1.,2.)"), parse_error);
  row("a placement that is a point", faced("PLANE('',#92)"), parse_error);
  row("a plane without bounds", faced("PLANE('',#93)"), unsupported);
  row("a loop of no edges", faced("PLANE('',#93)", "EDGE_LOOP('',())"), unsupported);
  row("an edge that is a face", faced("PLANE('',#93)", "EDGE_LOOP('',(#99))"), parse_error);
  row("an offset of itself", faced("OFFSET_SURFACE('',#12,1.,.F.)"), unsupported);
  row("2,000,000,000 knots in 100 bytes",
      faced("B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#92,#95),(#92,#95)),.UNSPECIFIED.,.F.,.F.,.F.,"
            "(2000000000,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)"),
      parse_error);
  row("a degree of 99",
      faced("B_SPLINE_SURFACE_WITH_KNOTS('',99,1,((#92,#95),(#92,#95)),.UNSPECIFIED.,.F.,.F.,.F.,"
            "(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)"),
      unsupported_degree);
  row("100,000 parentheses", faced("PLANE('',#93" + std::string(100000, '(')), parse_error);
}

void step_answers(Table& table) {
  const Result<Model> part = parse_cad(
      step_file(
          "#10=CLOSED_SHELL('',(#99,#11));\n#11=ADVANCED_FACE('',(#97),#12,.T.);\n#12=SPHERICAL_SURFACE('',#93,0.);\n"),
      "m.stp");
  table.gives("a sphere of radius 0 beside another one",
              "the other one, and a warning that names the surface and its line",
              part && part->surfaces.size() == 1 && part->warnings.size() == 1 &&
                  part->warnings[0].find("#12 SPHERICAL_SURFACE in line 6") != std::string::npos);
}

}  // namespace tessera::test
