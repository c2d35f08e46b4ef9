// Errors of the geometry of STEP files: each names the instance and its line. Texts with changed bytes end well.

#include <gtest/gtest.h>

#include <string>

#include "io/step/step_geometry.h"
#include "io_step/step_text_file.h"
#include "support/random_patches.h"

namespace tessera::test { namespace {

/// Converts #30, which is in line 5 as the first of `data`, and returns the error.
Status error_of(const std::string& data, bool is_surface, bool has_range = false) {
  const StepTextFile file(data + step_axes +
                          "#40=CARTESIAN_POINT('',(0.,0.,0.));\n#41=CARTESIAN_POINT('',(1.,0.,0.));\n"
                          "#42=CARTESIAN_POINT('',(1.,1.,0.));\n#43=CIRCLE('',#20,1.);\n");
  const StepGeometry geometry(file.index);
  if (is_surface) return geometry.surface(30, has_range ? std::optional(Domain{}) : std::nullopt).status();
  return geometry.curve(30, has_range ? std::optional(Interval{}) : std::nullopt).status();
}

struct Wrong {
  std::string record, message;
  StatusCode code = StatusCode::parse_error;
};

void expect_error(const Wrong& wrong, bool is_surface, bool has_range = false) {
  const Status status = error_of("#30=" + wrong.record + ";\n", is_surface, has_range);
  EXPECT_EQ(status.code(), wrong.code) << wrong.record << ": " << status.message();
  EXPECT_NE(status.message().find(wrong.message), std::string::npos) << wrong.record << ": " << status.message();
  EXPECT_TRUE(status.message().starts_with('#')) << status.message();
}

TEST(StepGeometryErrors, NameTheCurveAndItsLine) {
  const Wrong all[] = {
      {"CIRCLE('',#20,0.)", "#30 CIRCLE in line 4: its radius is 0, expected a number above 0"},
      {"CIRCLE('',#20,-1.)", "its radius is -1, expected a number above 0"},
      {"CIRCLE('',#20,1.E999)", "found a number beyond the range of double"},
      {"CIRCLE('',#20,1.7E308)", "#30 CIRCLE in line 4: ", StatusCode::non_finite},
      {"CIRCLE('',#20,$)", "expected a finite number, found $"},
      {"CIRCLE('',#20)", "expected at least 3 attributes, found 2"},
      {"CIRCLE('',20,1.)", "expected a reference to an instance, found an integer"},
      {"CIRCLE('',#99,1.)", "#30 CIRCLE in line 4: refers to #99, which is not in the file"},
      {"CIRCLE('',#1,1.)", "#1 CARTESIAN_POINT in line 5: expected AXIS2_PLACEMENT_3D"},
      {"CIRCLE('',#20,1.", "#30 CIRCLE in line 4: expected"},
      {"LINE('',#1,#23)", "needs an interval", StatusCode::invalid_argument},
      {"HYPERBOLA('',#20,1.,1.)", "#30 HYPERBOLA in line 4: needs an interval", StatusCode::invalid_argument},
      {"OFFSET_CURVE_3D('',#43,1.,.F.,#2)", "#30 OFFSET_CURVE_3D in line 4", StatusCode::unsupported},
      {"PLANE('',#20)", "is no curve that can be converted", StatusCode::unsupported},
      {"(A()B())", "#30 A in line 4: is no curve", StatusCode::unsupported},
      {"POLYLINE('',(#40))", "degree 1 needs more than 1 point"},
      {"POLYLINE('',())", "degree 1 needs more than 0 points"},
      {"POLYLINE('',#40)", "expected a list, found #40"},
      {"POLYLINE('',(#40,#2))", "#2 DIRECTION in line 6: expected CARTESIAN_POINT"},
      {"POLYLINE('',(#40,#98))", "refers to #98, which is not in the file"},
      {"TRIMMED_CURVE('',#30,(0.),(1.),.T.,.PARAMETER.)", "is made of too many curves, or of itself"},
      {"TRIMMED_CURVE('',#43,(),(1.),.T.,.PARAMETER.)", "a trim with neither a parameter nor a point"},
      {"TRIMMED_CURVE('',#43,(0.),(1.),.U.,.PARAMETER.)", "expected .T. or .F., found .U."},
      {"TRIMMED_CURVE('',#43,(1.E300),(1.E300),.T.,.PARAMETER.)", "must not be empty", StatusCode::invalid_argument},
      {"TRIMMED_CURVE('',#43,(0.),(1.E300),.T.,.PARAMETER.)", "a full turn", StatusCode::invalid_argument},
      {"TRIMMED_CURVE('',#24,(1.),(0.),.T.,.PARAMETER.)", "must not be empty", StatusCode::invalid_argument},
      {"SURFACE_CURVE('',#30,(),.CURVE_3D.)", "is made of too many curves, or of itself"},
  };
  for (const Wrong& wrong : all) expect_error(wrong, false);
  EXPECT_EQ(StepGeometry(StepTextFile("").index).curve(7).status().message(), "#7 is not in the file");
}

TEST(StepGeometryErrors, NameWhatASplineLacks) {
  const auto spline = [](const std::string& degree, const std::string& knots) {
    return "B_SPLINE_CURVE_WITH_KNOTS(''," + degree + ",(#40,#41,#42),.UNSPECIFIED.,.F.,.F.," + knots + ",.U.)";
  };
  const auto weighted = [](const std::string& weights) {
    return "(BOUNDED_CURVE()BEZIER_CURVE()B_SPLINE_CURVE(2,(#40,#41,#42),.U.,.F.,.F.)RATIONAL_B_SPLINE_CURVE(" +
           weights + "))";
  };
  const Wrong all[] = {
      {spline("2", "(3,2),(0.,1.)"), "the multiplicities of the knots sum up to 5, expected 6"},
      {spline("2", "(3,2147483647),(0.,1.)"), "sum up to 2147483650, expected 6"},
      {spline("2", "(3,99999999999),(0.,1.)"), "expected an integer, found an integer"},
      {spline("2", "(3,3),(0.,1.,2.)"), "has 2 multiplicities for 3 knots"},
      {spline("2", "(6,0),(0.,1.)"), "the multiplicity of knot 2 is below 1"},
      {spline("2", "(3,3),(1.,0.)"), "knot 2 is below the one before"},
      {spline("2", "(3,3),(1.,1.)"), "must not be empty", StatusCode::invalid_argument},
      {spline("2", "(3,3),(0.,1.E999)"), "beyond the range of double"},
      {spline("2", "(3,3),(0.,'')"), "expected a finite number, found a text"},
      {spline("3", "(3,3),(0.,1.)"), "degree 3 needs more than 3 points"},
      {spline("0", "(3,3),(0.,1.)"), "degree 0 is not from 1 to", StatusCode::unsupported_degree},
      {spline("-5", "(3,3),(0.,1.)"), "degree -5 is not from 1 to", StatusCode::unsupported_degree},
      {spline("2000000000", "(3,3),(0.,1.)"), "degree 2000000000", StatusCode::unsupported_degree},
      {spline("2.", "(3,3),(0.,1.)"), "expected an integer, found a real number"},
      {spline("1", "(1,3,1),(0.,1.,2.)"), "#30 B_SPLINE_CURVE_WITH_KNOTS in line 4: ", StatusCode::invalid_argument},
      {weighted("(1.,0.,1.)"), "#30 B_SPLINE_CURVE in line 4: ", StatusCode::invalid_weight},
      {weighted("(1.,-1.,1.)"), "#30 B_SPLINE_CURVE in line 4: ", StatusCode::invalid_weight},
      {weighted("(1.,1.)"), "has 2 weights for 3 points"},
      {weighted("*"), "expected a list, found *"},
      {"(BEZIER_CURVE()BOUNDED_CURVE())", "a part that its kind must have is missing"},
      {"BEZIER_CURVE('',1,(#40,(#41),#42),.U.,.F.,.F.)", "expected a reference to an instance, found a list"},
  };
  for (const Wrong& wrong : all) expect_error(wrong, false);
  expect_error({"BEZIER_CURVE('',2,(#40,#41,#42,#43),.U.,.F.,.F.)", "#43 CIRCLE in line 16: expected CARTESIAN_POINT"},
               false);
  expect_error({"BEZIER_CURVE('',2,(#40,#41,#42,#40),.U.,.F.,.F.)", "4 points cannot make segments of degree 2"},
               false);
}

TEST(StepGeometryErrors, NameTheSurfaceAndItsLine) {
  const Wrong unbounded[] = {
      {"PLANE('',#20)", "is unbounded and needs a rectangle", StatusCode::invalid_argument},
      {"CYLINDRICAL_SURFACE('',#20,1.)", "is unbounded", StatusCode::invalid_argument},
      {"SURFACE_OF_LINEAR_EXTRUSION('',#43,#23)", "is unbounded", StatusCode::invalid_argument},
      {"SURFACE_OF_REVOLUTION('',#24,#21)", "#24 LINE in line 12: needs an interval", StatusCode::invalid_argument},
      {"RECTANGULAR_TRIMMED_SURFACE('',#30,0.,1.,0.,1.,.T.,.T.)", "is made of too many surfaces, or of itself"},
  };
  for (const Wrong& wrong : unbounded) expect_error(wrong, true);
  const std::string rows = "((#40,#41),(#42,#40))", flags = ",.U.,.F.,.F.,.F.";
  const Wrong all[] = {
      {"CYLINDRICAL_SURFACE('',#20,0.)",
       "#30 CYLINDRICAL_SURFACE in line 4: its radius is 0, expected a number above 0"},
      {"CONICAL_SURFACE('',#20,1.,1.6)", "its half angle is 1.6 radians, expected less than a right angle"},
      {"CONICAL_SURFACE('',#20,-1.,0.5)", "its radius is -1, expected 0 or more"},
      {"SPHERICAL_SURFACE('',#20,1.7E308)", "#30 SPHERICAL_SURFACE in line 4: ", StatusCode::non_finite},
      {"TOROIDAL_SURFACE('',#20,1.,-1.)", "its minor radius is -1, expected a number above 0"},
      {"OFFSET_SURFACE('',#20,1.,.F.)", "#30 OFFSET_SURFACE in line 4: is no surface", StatusCode::unsupported},
      {"CIRCLE('',#20,1.)", "is no surface that can be converted", StatusCode::unsupported},
      {"SURFACE_OF_REVOLUTION('',#30,#21)", "#30 SURFACE_OF_REVOLUTION in line 4: is no curve",
       StatusCode::unsupported},
      {"SURFACE_OF_REVOLUTION('',#24,#23)", "#23 VECTOR in line 11: expected AXIS2_PLACEMENT_3D"},
      {"SURFACE_OF_LINEAR_EXTRUSION('',#24,#2)", "#2 DIRECTION in line 6: expected VECTOR"},
      {"RECTANGULAR_TRIMMED_SURFACE('',#30,0.,1.,0.,1.,.T.,.T.)", "too many surfaces, or of itself"},
      {"RECTANGULAR_TRIMMED_SURFACE('',#20,0.,1.,0.,1.,.F.,.T.)", "against its basis", StatusCode::unsupported},
      {"BEZIER_SURFACE('',1,1,((#40,#41),(#42))" + flags + ")", "row 2 has 1 point, row 1 has 2"},
      {"BEZIER_SURFACE('',1,1,()" + flags + ")", "degree 1 needs more than 0 points"},
      {"BEZIER_SURFACE('',1,1,(#40,#41)" + flags + ")", "expected a list, found #40"},
      {"BEZIER_SURFACE('',1,2," + rows + flags + ")", "degree 2 needs more than 2 points"},
      {"B_SPLINE_SURFACE_WITH_KNOTS('',1,1," + rows + flags + ",(2,2),(2,3),(0.,1.),(0.,1.),.U.)",
       "sum up to 5, expected 4"},
      {"(BEZIER_SURFACE()B_SPLINE_SURFACE(1,1," + rows + flags + ")RATIONAL_B_SPLINE_SURFACE(((1.,1.),(1.,0.))))",
       "#30 B_SPLINE_SURFACE in line 4: ", StatusCode::invalid_weight},
      {"(BEZIER_SURFACE()B_SPLINE_SURFACE(1,1," + rows + flags + ")RATIONAL_B_SPLINE_SURFACE(((1.,1.),(1.))))",
       "a row has 1 weight, expected 2"},
      {"(BEZIER_SURFACE()B_SPLINE_SURFACE(1,1," + rows + flags + ")RATIONAL_B_SPLINE_SURFACE(((1.,1.))))",
       "has 2 weights for 4 points"},
  };
  for (const Wrong& wrong : all) expect_error(wrong, true, true);
}

TEST(StepGeometryErrors, NameZeroDirectionsAndCoordinates) {
  const auto with = [](const std::string& instances) {
    return error_of("#30=LINE('',#31,#32);\n#32=VECTOR('',#33,1.);\n" + instances, false, true).message();
  };
  const std::string point = "#31=CARTESIAN_POINT('',(0.,0.,0.));\n", along = "#33=DIRECTION('',(1.,0.,0.));\n";
  EXPECT_EQ(with(point + along), "");
  EXPECT_EQ(with(point + "#33=DIRECTION('',(0.,0.,0.));\n"), "#33 DIRECTION in line 7: a direction of length 0");
  EXPECT_EQ(with(along + "#31=CARTESIAN_POINT('',(0.,0.));\n"),
            "#31 CARTESIAN_POINT in line 7: expected 3 coordinates, found 2");
  EXPECT_EQ(with(along + "#31=CARTESIAN_POINT('',(0.,0.,1.E999));\n"),
            "#31 CARTESIAN_POINT in line 7: expected a finite number, found a number beyond the range of double");
  const StepTextFile file("#1=CARTESIAN_POINT('',(1.E308,0.,0.));\n#2=DIRECTION('',(1.E308,1.E308,0.));\n");
  EXPECT_EQ(StepGeometry(file.index, {25.4, 1}).point(1).status().code(), StatusCode::non_finite);
  EXPECT_NEAR(value_of(StepGeometry(file.index).direction(2)).y, std::sqrt(0.5), 1e-15);
}

TEST(StepGeometryErrors, RangesMustFit) {
  const StepTextFile file(step_axes + "#30=CIRCLE('',#20,1.);\n#31=SPHERICAL_SURFACE('',#20,1.);\n");
  const StepGeometry geometry(file.index);
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Interval& range : {Interval{0, 7}, Interval{1, 1}, Interval{2, 1}, Interval{0, nan}, Interval{0, infinity},
                                Interval{1e17, 1e17 + 64}, Interval{-1e308, 1e308}}) {
    EXPECT_EQ(geometry.curve(30, range).status().code(), StatusCode::invalid_argument);
    const Domain box{range.from, range.to, 0, 1}, other{0, 1, range.from, range.to};
    EXPECT_EQ(geometry.surface(31, box).status().code(), StatusCode::invalid_argument);
    EXPECT_EQ(geometry.surface(31, other).status().code(), StatusCode::invalid_argument);
  }
}

TEST(StepGeometryErrors, ChangedBytesEndWell) {
  const std::string data =
      step_axes +
      "#30=CIRCLE('',#20,1.5);\n#31=TRIMMED_CURVE('',#30,(PARAMETER_VALUE(1.)),(#40),.T.,.PARAMETER.);\n"
      "#32=SURFACE_OF_REVOLUTION('',#31,#21);\n#33=RECTANGULAR_TRIMMED_SURFACE('',#36,0.,1.,0.,1.,.T.,.T.);\n"
      "#34=B_SPLINE_CURVE_WITH_KNOTS('',2,(#40,#41,#42,#40),.U.,.F.,.F.,(3,1,3),(0.,1.,2.),.U.);\n"
      "#35=(BEZIER_CURVE()B_SPLINE_CURVE(2,(#40,#41,#42),.U.,.F.,.F.)RATIONAL_B_SPLINE_CURVE((1.,2.,1.)));\n"
      "#36=CONICAL_SURFACE('',#20,3.,0.2);\n#37=DEGENERATE_TOROIDAL_SURFACE('',#20,1.,2.,.T.);\n"
      "#38=BEZIER_SURFACE('',1,1,((#40,#41),(#42,#40)),.U.,.F.,.F.,.F.);\n#39=PARABOLA('',#20,1.);\n"
      "#40=CARTESIAN_POINT('',(0.,0.,0.));\n#41=CARTESIAN_POINT('',(1.,0.,0.));\n#42=CARTESIAN_POINT('',(1.,1.,0.));\n";
  const std::string letters = "0123456789.,()#'$*-+E;T\n";
  Random random(11);
  std::size_t good = 0, bad = 0;
  for (int k = 0; k < 3000; ++k) {
    std::string changed = data;
    for (int change = 0; change <= k % 4; ++change) {
      const std::size_t at = random() % changed.size();
      if (random() % 3 == 0)
        changed.erase(at, 1 + random() % 4);
      else
        changed[at] = letters[random() % letters.size()];
    }
    const StepTextFile file(changed);
    const StepGeometry geometry(file.index);
    for (const StepInstance& one : file.index.instances())
      for (const bool has_range : {false, true}) {
        const auto curve = geometry.curve(one.number, has_range ? std::optional(Interval{0.1, 0.7}) : std::nullopt);
        const auto box = has_range ? std::optional(Domain{0.1, 0.7, 0.2, 0.8}) : std::nullopt;
        const auto surface = geometry.surface(one.number, box);
        EXPECT_TRUE(curve || curve.status().message().starts_with('#')) << curve.status().message();
        EXPECT_TRUE(surface || surface.status().message().starts_with('#')) << surface.status().message();
        good += curve.ok() || surface.ok(), bad += !curve.ok() && !surface.ok();
      }
  }
  EXPECT_GT(good, 30000u);
  EXPECT_GT(bad, 30000u);
}

}}  // namespace tessera::test
