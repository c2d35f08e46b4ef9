// Units of contexts: SI units, multiples of others, uncertainties, and what is malformed.

#include <gtest/gtest.h>

#include <string>

#include "io/step/step_units.h"
#include "io_step/step_text_file.h"
#include "support/errors.h"

namespace tessera::test { namespace {

/// The units of a context #1 of unit #2, and of an uncertainty #3 if `more` has it.
Result<StepContextUnits> units_of(const std::string& units, const std::string& uncertainty = "") {
  const std::string of_uncertainty = uncertainty.empty() ? "" : "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3))";
  const StepTextFile file("#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3)" + of_uncertainty +
                          "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2))REPRESENTATION_CONTEXT('',''));\n" + units + uncertainty);
  return step_units(file.index, 1);
}

TEST(StepUnits, OfLengthsHaveAllPrefixes) {
  struct Case {
    std::string prefix;
    double length;
    std::string name;
  };
  for (const Case& c :
       {Case{"$", 1e3, "metre"}, Case{".MILLI.", 1, "millimetre"}, Case{".CENTI.", 10, "centimetre"},
        Case{".DECI.", 100, "decimetre"}, Case{".MICRO.", 1e-3, "micrometre"}, Case{".KILO.", 1e6, "kilometre"},
        Case{".HECTO.", 1e5, "hectometre"}, Case{".NANO.", 1e-6, "nanometre"}, Case{".DECA.", 1e4, "decametre"}}) {
    const StepContextUnits units =
        value_of(units_of("#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + c.prefix + ",.METRE.));\n"));
    EXPECT_NEAR(units.units.length, c.length, 1e-15 * c.length) << c.prefix;
    EXPECT_EQ(units.length, c.name);
    EXPECT_EQ(units.units.angle, 1);
    EXPECT_EQ(units.uncertainty, 0);
  }
}

TEST(StepUnits, MayStandAloneOrLackThePrefix) {
  EXPECT_EQ(value_of(units_of("#2=SI_UNIT(*,.MILLI.,.METRE.);\n")).units.length, 1);
  EXPECT_EQ(value_of(units_of("#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.METRE.));\n")).units.length, 1000);
  EXPECT_EQ(value_of(units_of("#2=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());\n")).units.length, 1);
  const StepTextFile file("#1=GEOMETRIC_REPRESENTATION_CONTEXT('','',3);\n");
  const StepContextUnits units = value_of(step_units(file.index, 1));
  EXPECT_EQ(units.units.length, 1);
  EXPECT_EQ(units.length, "");
}

TEST(StepUnits, AreMultiplesOfOthers) {
  const std::string metre = "#9=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n";
  const std::string inch =
      "(CONVERSION_BASED_UNIT('INCH',#8)LENGTH_UNIT()NAMED_UNIT(#7));\n"
      "#8=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9);\n";
  const StepContextUnits inches = value_of(units_of("#2=" + inch + metre));
  EXPECT_EQ(inches.units.length, 25.4);
  EXPECT_EQ(inches.length, "INCH");
  const StepContextUnits feet =
      value_of(units_of("#2=(CONVERSION_BASED_UNIT('FOOT',#5)LENGTH_UNIT()NAMED_UNIT(#7));\n"
                        "#5=(LENGTH_MEASURE_WITH_UNIT()MEASURE_WITH_UNIT(LENGTH_MEASURE(12),#6));\n#6=" +
                        inch + metre));
  EXPECT_NEAR(feet.units.length, 304.8, 1e-12);
  EXPECT_EQ(feet.length, "FOOT");
  const StepContextUnits degrees =
      value_of(units_of("#2=(CONVERSION_BASED_UNIT('DEGREE',#5)NAMED_UNIT(#7)PLANE_ANGLE_UNIT());\n"
                        "#5=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925),#6);\n"
                        "#6=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n"));
  EXPECT_EQ(degrees.units.angle, 0.0174532925);
  EXPECT_EQ(degrees.units.length, 1);
}

TEST(StepUnits, OfUncertaintiesAreTheirOwn) {
  const std::string units =
      "#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n#9=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n";
  const auto uncertainty = [&](const std::string& value, const std::string& unit) {
    return value_of(units_of(units, "#3=UNCERTAINTY_MEASURE_WITH_UNIT(" + value + "," + unit + ",'','');\n"))
        .uncertainty;
  };
  EXPECT_DOUBLE_EQ(uncertainty("LENGTH_MEASURE(1.E-5)", "#2"), 1e-2);
  EXPECT_DOUBLE_EQ(uncertainty("LENGTH_MEASURE(1.E-5)", "#9"), 1e-5);
  EXPECT_EQ(uncertainty("LENGTH_MEASURE(0.)", "#9"), 0);
  EXPECT_EQ(uncertainty("LENGTH_MEASURE(-1.)", "#9"), 0);
  EXPECT_EQ(uncertainty("LENGTH_MEASURE(1.E-5)", "#77"), 0);
}

TEST(StepUnits, ThatAreMalformedAreErrors) {
  const auto inch = [](const std::string& value, const std::string& basis) {
    return units_of("#2=(CONVERSION_BASED_UNIT('INCH',#4)LENGTH_UNIT()NAMED_UNIT($));\n#4=LENGTH_MEASURE_WITH_UNIT(" +
                    value + "," + basis +
                    ");\n#5=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
                    "#6=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n");
  };
  const auto expect = [](const Result<StepContextUnits>& units, const std::string& words,
                         StatusCode code = StatusCode::parse_error) {
    expect_refused(units, code, Status::no_index, words);
  };
  EXPECT_TRUE(inch("25.4", "#5").ok());
  expect(inch("0.", "#5"), "#4 LENGTH_MEASURE_WITH_UNIT in line 6: its value is 0, expected a number above 0");
  expect(inch("-25.4", "#5"), "its value is -25.4");
  expect(inch("1.E400", "#5"), "a number beyond the range of double");
  expect(inch("25.4", "#77"), "#77, which is not in the file");
  expect(inch("25.4", "#6"), "#2 CONVERSION_BASED_UNIT in line 5: it is a multiple of another kind of unit");
  expect(inch("2.", "#2"), "more than 8 times, or a cycle");
}

TEST(StepUnits, BeyondTheRangeOfDoubleAreErrors) {
  std::string chain = "#2=(CONVERSION_BASED_UNIT('A',#14)LENGTH_UNIT()NAMED_UNIT($));\n";
  chain +=
      "#14=LENGTH_MEASURE_WITH_UNIT(1.E200,#15);\n#15=(CONVERSION_BASED_UNIT('B',#16)LENGTH_UNIT()NAMED_UNIT($));\n";
  chain += "#16=LENGTH_MEASURE_WITH_UNIT(1.E200,#17);\n#17=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n";
  expect_refused(units_of(chain), StatusCode::non_finite, Status::no_index, "beyond the range of double");
}

TEST(StepUnits, OfUnknownKindsAreErrorsOnlyForLengthsAndAngles) {
  expect_refused(units_of("#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.GRAM.));\n"), StatusCode::parse_error,
                 Status::no_index, "expected .METRE. or .RADIAN.");
  expect_refused(units_of("#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.HUGE.,.METRE.));\n"), StatusCode::parse_error,
                 Status::no_index, ".HUGE. is no prefix");
  expect_refused(units_of("#2=(CONTEXT_DEPENDENT_UNIT('a')LENGTH_UNIT()NAMED_UNIT($));\n"), StatusCode::parse_error,
                 Status::no_index, "a unit without a size");
  expect_refused(units_of(""), StatusCode::parse_error, Status::no_index, "#2, which is not in the file");
  EXPECT_TRUE(units_of("#2=(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.));\n").ok());
  EXPECT_TRUE(units_of("#2=DERIVED_UNIT((#77));\n").ok());
}

}}  // namespace tessera::test
