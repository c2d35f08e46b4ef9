// Swept surfaces, splines and offsets of STEP texts, and edges of all kinds: areas and volumes by formulas.

#include <gtest/gtest.h>

#include "io_step/step_builder.h"

namespace tessera::test { namespace {

using std::numbers::pi;

std::string reals(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "(" : ",") + StepBuilder::real(value);
  return out + ")";
}

/// A spline with knots of full multiplicity at its ends, and single ones between.
int spline(StepBuilder& b, int degree, const std::vector<Vec3>& poles) {
  const int spans = static_cast<int>(poles.size()) - degree;
  std::string copies = "(" + std::to_string(degree + 1);
  std::vector<double> knots{0};
  for (int k = 1; k < spans; ++k) copies += ",1", knots.push_back(k);
  knots.push_back(spans);
  return b.add("B_SPLINE_CURVE_WITH_KNOTS(''," + std::to_string(degree) + "," + b.list(b.points(poles)) +
               ",.UNSPECIFIED.,.F.,.F.," + copies + "," + std::to_string(degree + 1) + ")," + reals(knots) +
               ",.UNSPECIFIED.)");
}

int spline_surface(StepBuilder& b, int degree_u, int degree_v, const std::vector<std::vector<Vec3>>& rows) {
  std::string poles;
  for (const std::vector<Vec3>& row : rows) poles += (poles.empty() ? "(" : ",") + b.list(b.points(row));
  const auto order = [](int degree) { return std::to_string(degree + 1); };
  const auto twice = [](const std::string& word) { return "(" + word + "," + word + ")"; };
  return b.add("B_SPLINE_SURFACE_WITH_KNOTS(''," + std::to_string(degree_u) + "," + std::to_string(degree_v) + "," +
               poles + "),.UNSPECIFIED.,.F.,.F.,.F.," + twice(order(degree_u)) + "," + twice(order(degree_v)) +
               ",(0.,1.),(0.,1.),.UNSPECIFIED.)");
}

/// A prism along z: side faces of curves in the plane z = 0 that go around counter-clockwise, and ends.
class Prism {
 public:
  explicit Prism(double height) : height_(height) {}

  /// Adds a side from a to b. `curve(z)`: the curve at this height.
  template <class MakeCurve>
  void add_side(const Vec3& from, const Vec3& to, const MakeCurve& curve, bool agrees = true) {
    const Vec3 up{0, 0, height_};
    const int low = b.edge(from, to, curve(0.0), agrees), high = b.edge(from + up, to + up, curve(height_), agrees);
    const int profile = curve(0.0);
    const int swept = b.add("SURFACE_OF_LINEAR_EXTRUSION(''," + b.list({profile, b.vector({0, 0, 2})}).substr(1));
    // The normal of a surface is the curve's direction times the sweep's: to the right of the curve.
    const int rise = b.straight(to, to + up), fall = -b.straight(from, from + up);
    sides_.push_back(b.face(swept, {b.loop({low, rise, -high, fall})}, agrees));
    low_.insert(low_.begin(), -low), high_.push_back(high);
  }
  void add_wall(const Vec3& from, const Vec3& to) {
    add_side(from, to, [&](double z) { return b.line(from + Vec3{0, 0, z}, to + Vec3{0, 0, z}); });
  }
  std::string file() {
    StepBuilder::Numbers faces = sides_;
    faces.push_back(b.flat({0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {b.loop(low_)}));
    faces.push_back(b.flat({0, 0, height_}, {0, 0, 1}, {1, 0, 0}, {b.loop(high_)}));
    return b.file({b.solid(faces)});
  }

  StepBuilder b;

 private:
  double height_;
  StepBuilder::Numbers sides_, low_, high_;
};

/// The length of the parabola y = x^2 from x = -1 to 1.
const double parabola_length = std::sqrt(5.0) + 0.5 * std::asinh(2.0);

TEST(StepCurved, ParabolasAreExtruded) {
  // Between y = x^2 and y = 1, as a conic and as a spline: area 4/3.
  for (const bool is_conic : {true, false}) {
    Prism prism(3);
    const auto curve = [&](double z) {
      StepBuilder& b = prism.b;
      if (!is_conic) return spline(b, 2, {{-1, 1, z}, {0, -1, z}, {1, 1, z}});
      // Its axis is y; its parameter grows along -x, or along x where the plane is turned over.
      return b.placed("PARABOLA", b.axes({0, 0, z}, {0, 0, -1}, {0, 1, 0}), {0.25});
    };
    prism.add_side({-1, 1, 0}, {1, 1, 0}, curve);
    prism.add_wall({1, 1, 0}, {-1, 1, 0});
    expect_solid(prism.file(), 3 * (parabola_length + 2) + 8.0 / 3, 4, 1e-8);
  }
}

/// The length of the hyperbola (cosh t, sinh t) from t = -1 to 1, by Simpson's rule.
double hyperbola_length() {
  constexpr int halves = 200;
  double sum = 0;
  for (int k = 0; k <= 2 * halves; ++k) {
    const double weight = k == 0 || k == 2 * halves ? 1 : k % 2 == 1 ? 4 : 2;
    sum += weight * std::sqrt(std::cosh(2 * (k / (1.0 * halves) - 1)));
  }
  return sum / (3 * halves);
}

TEST(StepCurved, HyperbolasAreExtruded) {
  // Between x^2 - y^2 = 1 and x = cosh(1): area sinh(1) cosh(1) - 1.
  Prism prism(1);
  const double x = std::cosh(1.0), y = std::sinh(1.0);
  const auto curve = [&](double z) {
    return prism.b.placed("HYPERBOLA", prism.b.axes({0, 0, z}, {0, 0, -1}, {1, 0, 0}), {1, 1});
  };
  prism.add_side({x, y, 0}, {x, -y, 0}, curve);
  prism.add_wall({x, -y, 0}, {x, y, 0});
  expect_solid(prism.file(), hyperbola_length() + 2 * y + 2 * (x * y - 1), x * y - 1, 1e-8);
}

TEST(StepCurved, EllipsesAreEdgesBothWays) {
  // The half of an ellipse of radii 3 and 1.
  for (const bool agrees : {true, false}) {
    Prism prism(2);
    prism.add_side(
        {3, 0, 0}, {-3, 0, 0},
        [&](double z) {
          const Vec3 up{0, 0, agrees ? 1.0 : -1.0};
          return prism.b.placed("ELLIPSE", prism.b.axes({0, 0, z}, up, {1, 0, 0}), {3, 1});
        },
        agrees);
    prism.add_wall({-3, 0, 0}, {3, 0, 0});
    // The ellipse's perimeter by its arithmetic-geometric series is 13.36489322055525...
    expect_solid(prism.file(), 2 * (13.364893220555258 / 2 + 6) + 3 * pi, 3 * pi, 1e-8);
  }
}

TEST(StepCurved, EdgesAreWrappedTrimmedAndPolygonal) {
  for (const std::string how : {"TRIMMED", "BACKWARDS", "SURFACE", "SEAM", "POLYLINE", "SPLINE"}) {
    Prism prism(1);
    StepBuilder& b = prism.b;
    const auto curve = [&](double z) {
      if (how == "POLYLINE") return b.add("POLYLINE(''," + b.list(b.points({{1, 0, z}, {0, 2, z}, {-1, 0, z}})) + ")");
      if (how == "SPLINE") return spline(b, 1, {{1, 0, z}, {0, 2, z}, {-1, 0, z}});
      const std::string circle = b.ref_of(b.placed("CIRCLE", b.axes({0, 0, z}), {1}));
      if (how == "TRIMMED")
        return b.add("TRIMMED_CURVE(''," + circle + ",(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(4.)),.T.,.PARAMETER.)");
      if (how == "BACKWARDS")
        return b.add("TRIMMED_CURVE(''," + circle + ",(PARAMETER_VALUE(4.)),(PARAMETER_VALUE(0.)),.F.,.PARAMETER.)");
      return b.add(how + "_CURVE(''," + circle + ",(),.CURVE_3D.)");
    };
    prism.add_side({1, 0, 0}, {-1, 0, 0}, curve, how != "BACKWARDS");
    prism.add_wall({-1, 0, 0}, {1, 0, 0});
    const bool is_round = how != "POLYLINE" && how != "SPLINE";
    const double area = is_round ? pi / 2 : 2, way = is_round ? pi : 2 * std::sqrt(5.0);
    SCOPED_TRACE(how);
    expect_solid(prism.file(), 2 * area + way + 2, area, 1e-8);
  }
}

/// Faces of revolution about z: the profile from (r, 0, z) to (r, 0, z) turned once.
TEST(StepCurved, SplinesAreTurned) {
  // A paraboloid r = z^2 + 1, z from -1 to 1, closed by discs: volume 2 pi (1/5 + 2/3 + 1), and both discs of radius 2.
  StepBuilder b;
  const int profile = spline(b, 2, {{2, 0, -1}, {0, 0, 0}, {2, 0, 1}});
  const int axis = b.add("AXIS1_PLACEMENT(''," + b.list({b.point({0, 0, 0}), b.direction({0, 0, 1})}).substr(1));
  const int turned = b.add("SURFACE_OF_REVOLUTION(''," + b.list({profile, axis}).substr(1));
  const Vec3 a{2, 0, -1}, c{2, 0, 1};
  const int low = b.edge(a, a, b.placed("CIRCLE", b.axes({0, 0, -1}), {2}));
  const int high = b.edge(c, c, b.placed("CIRCLE", b.axes({0, 0, 1}), {2}));
  const int seam = b.edge(a, c, profile);
  for (const bool has_seam : {true, false}) {
    StepBuilder part = b;
    const StepBuilder::Numbers loops = has_seam ? StepBuilder::Numbers{part.loop({low, seam, -high, -seam})}
                                                : StepBuilder::Numbers{part.loop({low}), part.loop({-high})};
    const int side = part.face(turned, loops);
    const int bottom = part.flat({0, 0, -1}, {0, 0, -1}, {1, 0, 0}, {part.loop({-low})});
    const int top = part.flat({0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {part.loop({high})});
    // The side's area is 2 pi times the integral of (z^2 + 1) sqrt(1 + 4 z^2), by the substitution 2 z = sinh(t).
    const double t = std::asinh(2.0);
    const double squares = std::sinh(4 * t) / 32 - t / 8, plain = t / 2 + std::sinh(2 * t) / 4;
    const double side_area = 2 * pi * (2 * squares / 8 + 2 * plain / 2);
    const Model model = expect_solid(part.file({part.solid({side, bottom, top})}), 8 * pi + side_area,
                                     2 * pi * (0.2 + 2.0 / 3 + 1), 1e-8);
    EXPECT_EQ(model.surfaces.size(), 3u);
  }
}

TEST(StepCurved, TurnedCirclesCloseBothWays) {
  StepBuilder b;
  const int profile = b.placed("CIRCLE", b.axes({5, 0, 0}, {0, -1, 0}), {2});
  const int axis = b.add("AXIS1_PLACEMENT(''," + b.list({b.point({0, 0, 0}), b.direction({0, 0, 1})}).substr(1));
  const int turned = b.add("SURFACE_OF_REVOLUTION(''," + b.list({profile, axis}).substr(1));
  const Vec3 at{7, 0, 0};
  const int around = b.edge(at, at, profile), along = b.edge(at, at, b.placed("CIRCLE", b.axes({0, 0, 0}), {7}));
  const int face = b.face(turned, {b.loop({along, around, -along, -around})});
  expect_solid(b.file({b.solid({face})}), 40 * pi * pi, 40 * pi * pi, 1e-8);
}

TEST(StepCurved, SplineSurfacesMayHaveACollapsedSide) {
  // A triangle with corners (0, 0), (1, 0), (0, 1) whose side u = 0 is a point.
  StepBuilder b;
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
  const int surface = spline_surface(b, 1, 1, {{o, o}, {x, y}});
  expect_area(b.file({b.shell({b.face(surface, {b.polygon_loop({o, x, y})})}, "OPEN_SHELL")}), 0.5);
}

TEST(StepCurved, ClosedSplineEdgesMayBeginAnywhere) {
  // A closed quadratic spline through the middles of a square's sides, used from a place that is not its end.
  StepBuilder b;
  const std::vector<Vec3> poles{{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                                {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}};
  const int curve = b.add("B_SPLINE_CURVE_WITH_KNOTS('',2," + b.list(b.points(poles)) +
                          ",.UNSPECIFIED.,.T.,.F.,(3,2,2,2,3),(0.,1.,2.,3.,4.),.UNSPECIFIED.)");
  // Each quarter lies under its parabola: 1 - 1/6 of a unit square.
  const double area = 4 * (1 - 1.0 / 6);
  for (const Vec3& start : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.75, 0.75, 0}, Vec3{-1, 0, 0}})
    for (const bool agrees : {true, false}) {
      StepBuilder part = b;
      const int edge = part.edge(start, start, curve, agrees);
      const int face = part.flat({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {part.loop({agrees ? edge : -edge})});
      expect_area(part.file({part.shell({face}, "OPEN_SHELL")}), area);
    }
}

TEST(StepCurved, OffsetsLieAtTheirDistance) {
  // A cylinder of radius 2 at the distance 0.5, and a parabolic cylinder at its own distance, between straight sides.
  StepBuilder b;
  const int round = b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {2});
  const int outside = b.add("OFFSET_SURFACE(''," + b.ref_of(round) + ",0.5,.F.)");
  const auto circle = [&](double z) {
    return b.edge({2.5, 0, z}, {2.5, 0, z}, b.placed("CIRCLE", b.axes({0, 0, z}), {2.5}));
  };
  const int low = circle(0), high = circle(3);
  const StepBuilder::Numbers loops{b.loop({low}), b.loop({-high})};
  expect_area(b.file({b.shell({b.face(outside, loops)}, "OPEN_SHELL")}), 15 * pi);
}

/// An open band at a distance from a swept surface, between circles of these heights and radii about z.
std::string offset_band(StepBuilder b, int swept, const Vec3& low, const Vec3& high) {
  const int offset = b.add("OFFSET_SURFACE(''," + b.ref_of(swept) + ",0.5,.F.)");
  const auto circle = [&](const Vec3& at) { return b.edge(at, at, b.placed("CIRCLE", b.axes({0, 0, at.z}), {at.x})); };
  const StepBuilder::Numbers loops{b.loop({circle(low)}), b.loop({-circle(high)})};
  return b.file({b.shell({b.face(offset, loops)}, "OPEN_SHELL")});
}

TEST(StepCurved, OffsetsOfSweptCylindersAndConesAreExact) {
  StepBuilder b;
  const int circle = b.placed("CIRCLE", b.axes({0, 0, 1}, {0, 0, 1}, {0, 1, 0}), {2});
  const int extruded = b.add("SURFACE_OF_LINEAR_EXTRUSION(''," + b.list({circle, b.vector({0, 0, 3})}).substr(1));
  const int axis = b.add("AXIS1_PLACEMENT(''," + b.list({b.point({0, 0, 0}), b.direction({0, 0, 1})}).substr(1));
  const auto revolved = [&](int profile) {
    return b.add("SURFACE_OF_REVOLUTION(''," + b.list({profile, axis}).substr(1));
  };
  const int cylinder = revolved(b.line({0, 2, -1}, {0, 2, 5})), cone = revolved(b.line({2, 0, 0}, {5, 0, 4}));
  const int spline_cone = revolved(spline(b, 1, {{2, 0, 0}, {2.6, 0, 0.8}}));
  for (const int swept : {extruded, cylinder})
    expect_area(offset_band(b, swept, {2.5, 0, 0}, {2.5, 0, 3}), 15 * pi, 1e-14);
  // The generator (3, 4) / 5 moves by 0.5 along (4, -3) / 5.
  for (const int swept : {cone, spline_cone})
    expect_area(offset_band(b, swept, {2.4, 0, -0.3}, {3, 0, 0.5}), pi * (2.4 + 3) * 1, 1e-14);
}

TEST(StepCurved, OffsetsOfOtherSweepsAreFitted) {
  StepBuilder b;
  const int axis = b.add("AXIS1_PLACEMENT(''," + b.list({b.point({0, 0, 0}), b.direction({0, 0, 1})}).substr(1));
  // A hyperboloid of one sheet; and the circle of a cylinder whose v runs against its axis.
  const int turned = b.add("SURFACE_OF_REVOLUTION(''," + b.list({b.line({2, 0, 0}, {2, 1, 2}), axis}).substr(1));
  const int circle = b.placed("CIRCLE", b.axes({0, 0, 3}), {3});
  const int against = b.add("SURFACE_OF_LINEAR_EXTRUSION(''," + b.list({circle, b.vector({0, 0, -1})}).substr(1));
  const auto warnings = [&](int swept, const Vec3& low, const Vec3& high) {
    return value_of(read_step(offset_band(b, swept, low, high), "band")).warnings;
  };
  EXPECT_FALSE(warnings(turned, {2.5, 0, 0}, {2.7, 0, 2}).empty());
  EXPECT_FALSE(warnings(against, {2.5, 0, 0}, {2.5, 0, 3}).empty());
}

}}  // namespace tessera::test
