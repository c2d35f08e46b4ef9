// Placements, curves and surfaces of STEP texts beside the formulas of ISO 10303-42.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "io/step/step_geometry.h"
#include "io_step/step_text_file.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;
constexpr int samples = 60;
using CurveFormula = std::function<Vec3(double)>;
using SurfaceFormula = std::function<Vec3(double, double)>;

/// The frame of #20: z = (2, 1, 2) / 3, x = (5, -2, -4) / sqrt(45), as (1, 0, 0) - z * 2/3 = (5, -2, -4) / 9.
Frame tilted_frame() {
  const double s = std::sqrt(45.0);
  const Vec3 z{2.0 / 3, 1.0 / 3, 2.0 / 3}, x{5 / s, -2 / s, -4 / s};
  return {{3, -1, 2}, x, cross(z, x), z};
}

void expect_curve(const Result<StepCurve>& made, const Interval& range, const CurveFormula& formula, double size = 10) {
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_NEAR(made->curve.domain().from, range.from, 1e-14 * size);
  EXPECT_NEAR(made->curve.domain().to, range.to, 1e-14 * size);
  for (int k = 0; k <= samples; ++k) {
    const double t = range.from + (range.to - range.from) * k / samples;
    const Vec3 ours = position(made->curve, made->arcs ? made->arcs->parameter(t) : t);
    EXPECT_LT(length(ours - formula(t)), 1e-14 * size) << "at " << t;
  }
}

void expect_surface(const Result<FaceSurface>& made, const Domain& box, const SurfaceFormula& formula,
                    double size = 10) {
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_NEAR(made->surface.domain().u0, box.u0, 1e-14 * size);
  EXPECT_NEAR(made->surface.domain().v1, box.v1, 1e-14 * size);
  for (int k = 0; k <= samples; ++k) {
    const double u = box.u_at(static_cast<double>(k) / samples), v = box.v_at(k * 7 % samples * (1.0 / samples));
    const std::array<double, 2> uv = made->parameters(u, v);
    EXPECT_LT(length(evaluate_jet(made->surface, uv[0], uv[1]).position - formula(u, v)), 1e-14 * size)
        << "at " << u << ", " << v;
  }
}

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT(length(a - b), 1e-15 * (1 + length(b))); }

/// The basis functions of Cox and de Boor.
double basis(const std::vector<double>& knots, std::size_t i, int p, double t) {
  if (p == 0) return knots[i] <= t && t < knots[i + 1] ? 1 : 0;
  const auto q = static_cast<std::size_t>(p);
  const auto share = [](double a, double b) { return b > 0 ? a / b : 0; };
  return share(t - knots[i], knots[i + q] - knots[i]) * basis(knots, i, p - 1, t) +
         share(knots[i + q + 1] - t, knots[i + q + 1] - knots[i + 1]) * basis(knots, i + 1, p - 1, t);
}

/// Points of a curve or, with one index after the other, of a surface.
Vec3 pole(std::size_t k) {
  const auto x = static_cast<double>(k);
  return {x, std::fmod(x * x, 7), std::fmod(3 * x, 5)};
}
double pole_weight(std::size_t k) { return 1 + 0.25 * static_cast<double>(k % 3); }

/// Instances #100 ... of the poles, and their list.
std::string poles(std::size_t count) {
  std::string out;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 p = pole(k);
    out += "#" + std::to_string(100 + k) + "=CARTESIAN_POINT('',(" + std::to_string(p.x) + "," + std::to_string(p.y) +
           "," + std::to_string(p.z) + "));\n";
  }
  return out;
}

CurveFormula spline_formula(const std::vector<double>& knots, int degree, bool is_rational = false) {
  return [=](double t) {
    const std::size_t count = knots.size() - static_cast<std::size_t>(degree) - 1;
    const double end = knots[count], inside = t < end ? t : std::nextafter(end, -1e9);
    Vec3 sum;
    double weights = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double n = basis(knots, i, degree, inside) * (is_rational ? pole_weight(i) : 1);
      sum += n * pole(i), weights += n;
    }
    return (1 / weights) * sum;
  };
}

TEST(StepPlacement, HasTheDirectionsOfTheFile) {
  const StepTextFile file(step_axes + "#30=AXIS2_PLACEMENT_3D('',#1,$,$);\n#31=AXIS2_PLACEMENT_3D('',#1,#3,$);\n" +
                          "#32=AXIS2_PLACEMENT_3D('',#1,#2,#33);\n#33=DIRECTION('',(-4.,-2.,-4.));\n" +
                          "#34=AXIS2_PLACEMENT_3D('',#1,#35,$);\n#35=DIRECTION('',(-7.,0.,0.));\n");
  const StepGeometry geometry(file.index);
  const auto expect_frame = [&](std::uint64_t number, const Frame& wanted) {
    const Frame found = value_of(geometry.placement(number));
    expect_near(found.origin, wanted.origin);
    expect_near(found.x, wanted.x);
    expect_near(found.y, wanted.y);
    expect_near(found.z, wanted.z);
  };
  const Vec3 at{3, -1, 2};
  expect_frame(20, tilted_frame());
  expect_frame(21, tilted_frame());  // x is nearest to (1, 0, 0)
  expect_frame(30, {at, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  expect_frame(31, {at, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}});    // z is (1, 0, 0)
  expect_frame(32, tilted_frame());                           // parallel
  expect_frame(34, {at, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}});  // z is (-1, 0, 0)
  expect_near(value_of(geometry.direction(2)), {2.0 / 3, 1.0 / 3, 2.0 / 3});
}

TEST(StepCurve, ConicsAndLinesFollowTheirFormulas) {
  const StepTextFile file(step_axes + "#30=CIRCLE('',#20,1.5);\n#31=ELLIPSE('',#20,3.,0.5);\n" +
                          "#32=PARABOLA('',#20,0.75);\n#33=SURFACE_CURVE('',#30,(),.CURVE_3D.);\n" +
                          "#34=(BOUNDED_CURVE()CURVE()SURFACE_CURVE(#30,(),.CURVE_3D.));\n");
  const StepGeometry geometry(file.index);
  const Frame f = tilted_frame();
  const auto ellipse = [f](double a, double b) {
    return [=](double t) { return f.at({a * std::cos(t), b * std::sin(t), 0}); };
  };
  for (const Interval& range : {Interval{0, 2 * pi}, Interval{-1, 0.5}, Interval{2, 2 + 1.9 * pi}}) {
    expect_curve(geometry.curve(31, range), range, ellipse(3, 0.5));
    for (const std::uint64_t round : {30, 33, 34}) expect_curve(geometry.curve(round, range), range, ellipse(1.5, 1.5));
    expect_curve(geometry.curve(24, range), range, [](double t) { return Vec3{3, -1 + 0.6 * t, 2 + 0.8 * t}; });
    expect_curve(
        geometry.curve(32, range), range,
        [f](double t) {
          return f.at({t * t / 3, t, 0});
        },
        20);
  }
  expect_curve(geometry.curve(30), {0, 2 * pi}, ellipse(1.5, 1.5));
  EXPECT_EQ(geometry.curve(30)->curve.points().size(), 9u);  // arcs of 90 degrees
}

TEST(StepCurve, SplinesFollowTheirBasis) {
  const std::string flags = ",.UNSPECIFIED.,.F.,.F.", list5 = "(#100,#101,#102,#103,#104)";
  const StepTextFile file(poles(5) + "#30=B_SPLINE_CURVE_WITH_KNOTS('',2," + list5 + flags +
                          ",(3,1,1,3),(0.,.5,2.,3.),.UNSPECIFIED.);\n#31=BEZIER_CURVE('',2," + list5 + flags +
                          ");\n#32=QUASI_UNIFORM_CURVE('',2," + list5 + flags + ");\n#33=UNIFORM_CURVE('',2," + list5 +
                          flags + ");\n#34=POLYLINE(''," + list5 + ");\n#35=(BOUNDED_CURVE()B_SPLINE_CURVE(2," + list5 +
                          flags + ")B_SPLINE_CURVE_WITH_KNOTS((3,1,1,3),(0.,.5,2.,3.),.UNSPECIFIED.)CURVE()" +
                          "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE((1.,1.25,1.5,1.,1.25))" +
                          "REPRESENTATION_ITEM(''));\n#36=(BEZIER_CURVE()BOUNDED_CURVE()B_SPLINE_CURVE(4," + list5 +
                          flags + ")CURVE()RATIONAL_B_SPLINE_CURVE((1.,1.25,1.5,1.,1.25)));\n");
  const StepGeometry geometry(file.index);
  const std::vector<double> knots{0, 0, 0, 0.5, 2, 3, 3, 3};
  expect_curve(geometry.curve(30), {0, 3}, spline_formula(knots, 2));
  expect_curve(geometry.curve(30, Interval{0.25, 2.5}), {0.25, 2.5}, spline_formula(knots, 2));
  expect_curve(geometry.curve(30, Interval{-1, 2.5}), {0, 2.5}, spline_formula(knots, 2));
  expect_curve(geometry.curve(31), {0, 2}, spline_formula({0, 0, 0, 1, 1, 2, 2, 2}, 2));
  expect_curve(geometry.curve(32), {0, 3}, spline_formula({0, 0, 0, 1, 2, 3, 3, 3}, 2));
  expect_curve(geometry.curve(33), {0, 3}, spline_formula({-2, -1, 0, 1, 2, 3, 4, 5}, 2));
  expect_curve(geometry.curve(34), {0, 4}, spline_formula({0, 0, 1, 2, 3, 4, 4}, 1));
  expect_curve(geometry.curve(35), {0, 3}, spline_formula(knots, 2, true));
  expect_curve(geometry.curve(36), {0, 1}, spline_formula({0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, 4, true));
}

TEST(StepCurve, TrimsAreParametersOrPoints) {
  const StepTextFile file(
      step_axes +
      "#4=CARTESIAN_POINT('',(3.,-1.6,1.2));\n#5=CARTESIAN_POINT('',(3.,2.,6.));\n#30=CIRCLE('',#20,1.5);\n"
      "#31=TRIMMED_CURVE('',#30,(PARAMETER_VALUE(90.)),(PARAMETER_VALUE(30.)),.T.,.PARAMETER.);\n"
      "#32=TRIMMED_CURVE('',#30,(PARAMETER_VALUE(90.)),(PARAMETER_VALUE(30.)),.F.,.PARAMETER.);\n"
      "#33=TRIMMED_CURVE('',#24,(#4),(PARAMETER_VALUE(7.),#5),.T.,.CARTESIAN.);\n"
      "#34=TRIMMED_CURVE('',#24,(PARAMETER_VALUE(-1.),#5),(PARAMETER_VALUE(2.),#4),.T.,.PARAMETER.);\n"
      "#35=TRIMMED_CURVE('',#31,(PARAMETER_VALUE(100.)),(PARAMETER_VALUE(120.)),.T.,.PARAMETER.);\n"
      "#36=PARABOLA('',#20,0.75);\n"
      "#37=TRIMMED_CURVE('',#36,(PARAMETER_VALUE(-1.)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);\n");
  const StepGeometry geometry(file.index, {1, pi / 180});
  const Frame f = tilted_frame();
  const auto circle = [f](double t) { return f.at({1.5 * std::cos(t), 1.5 * std::sin(t), 0}); };
  const auto line = [](double t) { return Vec3{3, -1 + 0.6 * t, 2 + 0.8 * t}; };
  expect_curve(geometry.curve(31), {pi / 2, pi / 6 + 2 * pi}, circle);
  expect_curve(geometry.curve(32), {-pi / 2, -pi / 6}, [&](double t) { return circle(-t); });
  expect_curve(geometry.curve(32, Interval{-1, 1}), {-1, 1}, [&](double t) { return circle(-t); });
  expect_curve(geometry.curve(33), {-1, 5}, line);
  expect_curve(geometry.curve(34), {-2.5, 5}, line);  // 2.5 is the length of the line's vector
  expect_curve(geometry.curve(35), {100 * pi / 180, 120 * pi / 180}, circle);
  expect_curve(geometry.curve(37), {-1.5, 3}, [&](double t) { return f.at({t * t / 3, t, 0}); });  // t = 2 focal u
}

TEST(StepSurface, QuadricsAndToriFollowTheirFormulas) {
  const StepTextFile file(step_axes + "#30=PLANE('',#20);\n#31=CYLINDRICAL_SURFACE('',#20,1.5);\n" +
                          "#32=CONICAL_SURFACE('',#20,0.5,0.4);\n#33=SPHERICAL_SURFACE('',#20,2.);\n" +
                          "#34=TOROIDAL_SURFACE('',#20,3.,1.);\n#35=DEGENERATE_TOROIDAL_SURFACE('',#20,1.,2.,.T.);\n" +
                          "#36=DEGENERATE_TOROIDAL_SURFACE('',#20,1.,2.,.F.);\n");
  const StepGeometry geometry(file.index);
  const Frame f = tilted_frame();
  const auto round = [f](double u, double radius, double z) {
    return f.at({radius * std::cos(u), radius * std::sin(u), z});
  };
  const auto torus = [=](double major, double minor) {
    return [=](double u, double v) { return round(u, major + minor * std::cos(v), minor * std::sin(v)); };
  };
  for (const Domain& box : {Domain{0, 2 * pi, -1, 1}, Domain{-1, 1, 0.2, 3}, Domain{4, 9, 0, 1.5}}) {
    expect_surface(
        geometry.surface(30, box), box,
        [&](double u, double v) {
          return f.at({u, v, 0});
        },
        20);
    expect_surface(geometry.surface(31, box), box, [&](double u, double v) { return round(u, 1.5, v); });
    expect_surface(geometry.surface(32, box), box,
                   [&](double u, double v) { return round(u, 0.5 + v * std::sin(0.4), v * std::cos(0.4)); });
    expect_surface(geometry.surface(33, box), box, torus(0, 2));
    expect_surface(geometry.surface(34, box), box, torus(3, 1));
  }
  expect_surface(geometry.surface(33), {0, 2 * pi, -pi / 2, pi / 2}, torus(0, 2));
  expect_surface(geometry.surface(34), {0, 2 * pi, 0, 2 * pi}, torus(3, 1));
  expect_surface(geometry.surface(35), {0, 2 * pi, -2 * pi / 3, 2 * pi / 3}, torus(1, 2));
  expect_surface(geometry.surface(36), {0, 2 * pi, 2 * pi / 3, 4 * pi / 3}, torus(1, 2));
}

TEST(StepSurface, SweptAndTrimmedOnesFollowTheirFormulas) {
  const StepTextFile file(
      step_axes + "#30=CIRCLE('',#20,1.5);\n#31=SURFACE_OF_LINEAR_EXTRUSION('',#30,#23);\n" +
      "#32=SURFACE_OF_REVOLUTION('',#24,#21);\n" + "#33=RECTANGULAR_TRIMMED_SURFACE('',#31,0.,1.5,-1.,2.,.T.,.T.);\n" +
      "#34=CONICAL_SURFACE('',#20,0.5,0.4);\n" + "#35=RECTANGULAR_TRIMMED_SURFACE('',#34,6.,1.,0.,2.,.T.,.T.);\n");
  const StepGeometry geometry(file.index);
  const Frame f = tilted_frame();
  const auto extrusion = [&](double u, double v) {
    return f.at({1.5 * std::cos(u), 1.5 * std::sin(u), 0}) + v * Vec3{0, 0.6, 0.8};
  };
  const auto revolution = [&](double u, double v) {
    const Vec3 p = f.local({3, -1 + 0.6 * v, 2 + 0.8 * v});
    return f.at({std::cos(u) * p.x - std::sin(u) * p.y, std::sin(u) * p.x + std::cos(u) * p.y, p.z});
  };
  const Domain box{-1, 4, -2, 3};
  expect_surface(geometry.surface(31, box), box, extrusion);
  expect_surface(geometry.surface(32, box), box, revolution);
  expect_surface(geometry.surface(33), {0, 1.5, -2.5, 5}, extrusion);
  const double along = 2 / std::cos(0.4);  // a height of 2
  expect_surface(geometry.surface(35), {6, 1 + 2 * pi, 0, along}, [&](double u, double v) {
    const double radius = 0.5 + v * std::sin(0.4);
    return f.at({radius * std::cos(u), radius * std::sin(u), v * std::cos(0.4)});
  });
}

TEST(StepSurface, SplinesFollowTheirBasis) {
  const std::string head = "2,1,((#100,#101),(#102,#103),(#104,#105),(#106,#107)),.UNSPECIFIED.,.F.,.F.,.F.",
                    knots = "(3,1,3),(2,2),(0.,1.,3.),(-1.,1.),.UNSPECIFIED.";
  const StepTextFile file(poles(8) + "#30=B_SPLINE_SURFACE_WITH_KNOTS(''," + head + "," + knots +
                          ");\n#31=(BOUNDED_SURFACE()B_SPLINE_SURFACE(" + head + ")B_SPLINE_SURFACE_WITH_KNOTS(" +
                          knots +
                          ")GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,1.25),(1.5,1.),(1.25,1.5)," +
                          "(1.,1.25)))REPRESENTATION_ITEM('')SURFACE());\n#32=QUASI_UNIFORM_SURFACE(''," + head +
                          ");\n#33=BEZIER_SURFACE('',3,1,((#100,#101),(#102,#103),(#104,#105),(#106,#107)),.U.,.F.,.F.,"
                          ".F.);\n");
  const StepGeometry geometry(file.index);
  const auto formula = [](int p, const std::vector<double>& knots_u, double from_v, double to_v, bool is_rational) {
    return [=](double u, double v) {
      const double inside = u < knots_u.back() ? u : std::nextafter(knots_u.back(), 0);
      const double share = (v - from_v) / (to_v - from_v);
      Vec3 sum;
      double weights = 0;
      for (std::size_t k = 0; k < 8; ++k) {
        const double n =
            basis(knots_u, k / 2, p, inside) * (k % 2 == 0 ? 1 - share : share) * (is_rational ? pole_weight(k) : 1);
        sum += n * pole(k), weights += n;
      }
      return (1 / weights) * sum;
    };
  };
  const std::vector<double> knots_u{0, 0, 0, 1, 3, 3, 3};
  expect_surface(geometry.surface(30), {0, 3, -1, 1}, formula(2, knots_u, -1, 1, false));
  expect_surface(geometry.surface(31), {0, 3, -1, 1}, formula(2, knots_u, -1, 1, true));
  const Domain part{0.5, 2, -0.5, 1};
  expect_surface(geometry.surface(31, part), part, formula(2, knots_u, -1, 1, true));
  expect_surface(geometry.surface(32), {0, 2, 0, 1}, formula(2, {0, 0, 0, 1, 2, 2, 2}, 0, 1, false));
  expect_surface(geometry.surface(33), {0, 1, 0, 1}, formula(3, {0, 0, 0, 0, 1, 1, 1, 1}, 0, 1, false));
}

TEST(StepUnits, ScaleLengthsAndAngles) {
  const StepTextFile file(step_axes + "#30=CONICAL_SURFACE('',#20,2.,30.);\n#31=CIRCLE('',#20,2.);\n");
  const StepGeometry geometry(file.index, {25.4, pi / 180});
  expect_near(value_of(geometry.point(1)), {76.2, -25.4, 50.8});
  Frame f = tilted_frame();
  f.origin = 25.4 * f.origin;
  expect_curve(
      geometry.curve(31), {0, 2 * pi},
      [&](double t) {
        return f.at({50.8 * std::cos(t), 50.8 * std::sin(t), 0});
      },
      100);
  const Domain box{0, 3, 0, 20};
  expect_surface(
      geometry.surface(30, box), box,
      [&](double u, double v) {
        const double radius = 50.8 + v * 0.5;
        return f.at({radius * std::cos(u), radius * std::sin(u), v * std::sqrt(0.75)});
      },
      100);
}

TEST(StepUnits, CurvesOfParametersHaveTwoCoordinates) {
  const StepTextFile file(
      "#1=CARTESIAN_POINT('',(3.,-1.));\n#2=DIRECTION('',(0.,2.));\n#3=VECTOR('',#2,1.);\n"
      "#4=LINE('',#1,#3);\n#5=AXIS2_PLACEMENT_2D('',#1,#2);\n#6=CIRCLE('',#5,2.);\n");
  const StepGeometry geometry(file.index, {.dimension = 2});
  expect_curve(geometry.curve(4, Interval{0, 2}), {0, 2}, [](double t) { return Vec3{3, -1 + t, 0}; });
  expect_curve(geometry.curve(6), {0, 2 * pi}, [](double t) {
    return Vec3{3 - 2 * std::sin(t), -1 + 2 * std::cos(t), 0};
  });
  EXPECT_FALSE(StepGeometry(file.index).curve(6).ok());
}

}}  // namespace tessera::test
