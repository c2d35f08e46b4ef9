// Quadrics of RIB files against the formulas of the specification (RenderMan Interface 3.2, section 5.2), and archives.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "io/reader_checks.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// A quadric's text, and its formula: the point at an angle theta and at v of the specification.
struct Case {
  std::string text;
  double thetamax;  ///< degrees
  std::function<Vec3(double theta, double v)> point;
};

Vec3 turned(const Vec3& p, double theta) {
  return {p.x * std::cos(theta) - p.y * std::sin(theta), p.x * std::sin(theta) + p.y * std::cos(theta), p.z};
}
Vec3 between(const Vec3& a, const Vec3& b, double v) { return (1 - v) * a + v * b; }

std::string words(std::initializer_list<double> numbers) {
  std::string text;
  for (const double x : numbers) text += " " + std::to_string(x);
  return text;
}

Case sphere(double r, double zmin, double zmax, double theta) {
  const double from = zmin > -r ? std::asin(zmin / r) : -std::numbers::pi / 2,
               to = zmax < r ? std::asin(zmax / r) : std::numbers::pi / 2;
  return {"Sphere" + words({r, zmin, zmax, theta}), theta, [=](double t, double v) {
            const double phi = from + v * (to - from);
            return Vec3{r * std::cos(t) * std::cos(phi), r * std::sin(t) * std::cos(phi), r * std::sin(phi)};
          }};
}
Case cylinder(double r, double zmin, double zmax, double theta) {
  return {"Cylinder" + words({r, zmin, zmax, theta}), theta, [=](double t, double v) {
            return turned({r, 0, zmin + v * (zmax - zmin)}, t);
          }};
}
Case cone(double height, double r, double theta) {
  return {"Cone" + words({height, r, theta}), theta, [=](double t, double v) {
            return turned({r * (1 - v), 0, v * height}, t);
          }};
}
Case paraboloid(double rmax, double zmin, double zmax, double theta) {
  return {"Paraboloid" + words({rmax, zmin, zmax, theta}), theta, [=](double t, double v) {
            const double z = zmin + v * (zmax - zmin);
            return turned({rmax * std::sqrt(z / zmax), 0, z}, t);
          }};
}
Case hyperboloid(const Vec3& a, const Vec3& b, double theta) {
  return {"Hyperboloid" + words({a.x, a.y, a.z, b.x, b.y, b.z, theta}), theta,
          [=](double t, double v) { return turned(between(a, b, v), t); }};
}
Case disk(double height, double r, double theta) {
  return {"Disk" + words({height, r, theta}), theta, [=](double t, double v) {
            return turned({r * (1 - v), 0, height}, t);
          }};
}
Case torus(double major, double minor, double phimin, double phimax, double theta) {
  return {"Torus" + words({major, minor, phimin, phimax, theta}), theta, [=](double t, double v) {
            const double phi = radians(phimin + v * (phimax - phimin));
            return turned({major + minor * std::cos(phi), 0, minor * std::sin(phi)}, t);
          }};
}

std::vector<Case> cases() {
  return {sphere(2, -2, 2, 360),
          sphere(3, -1.5, 2, 200),
          sphere(3, 2, -1.5, 200),
          sphere(0.001, -5, 5, -90),
          cylinder(0.5, -1, 3, 360),
          cylinder(0.5, 3, -1, 123),
          cylinder(1000, 0, 1, -300),
          cone(2, 0.5, 360),
          cone(-2, 0.5, 271),
          cone(2, 0.5, -10),
          paraboloid(2, 0, 3, 360),
          paraboloid(2, 1, 3, 250),
          paraboloid(2, 3, 1, 250),
          paraboloid(2, -1, -3, -250),
          hyperboloid({2, 0, 0}, {1, 1.5, 2}, 360),
          hyperboloid({2, 0, 0}, {1, 1.5, 2}, -100),
          hyperboloid({1, 0, 0}, {1, 0, 2}, 90),
          disk(0.25, 2, 360),
          disk(-1, 2, 77),
          disk(-1, 2, -77),
          torus(3, 1, 0, 360, 360),
          torus(3, 1, 30, 200, 100),
          torus(3, 1, 200, 30, 100),
          torus(3, 1, -180, 180, -360)};
}

/// The angle at a parameter of a circle of four rational arcs over [0, 1].
double arc_angle(double u) {
  const double arc = std::min(3.0, std::floor(4 * u)), s = 2 * (4 * u - arc) - 1;
  return (arc + 0.5) * (std::numbers::pi / 2) + 2 * std::atan(std::tan(std::numbers::pi / 8) * s);
}

/// The angle theta and the specification's v at parameters of a surface that was read.
std::array<double, 2> specified(const Case& c, const Surface& surface, double u, double v) {
  const Domain d = domain(surface);
  double share = (v - d.v0) / (d.v1 - d.v0);
  if (std::holds_alternative<QuadricPiece>(surface)) {
    if (c.text.starts_with("Paraboloid")) share = (v * v - d.v0 * d.v0) / (d.v1 * d.v1 - d.v0 * d.v0);
    return {std::copysign(u, c.thetamax), share};
  }
  if (c.text.starts_with("Torus")) share = arc_angle(v) / arc_angle(d.v1);
  return {std::copysign(arc_angle(u), c.thetamax), share};
}

TEST(RibQuadrics, PointsAreThoseOfTheSpecification) {
  const Affine map{.columns = {Vec3{0, 2, 0}, Vec3{1, 0, 0}, Vec3{0, 0.5, 3}}, .translation = {10, -20, 30}};
  const std::string transform = "ConcatTransform [0 2 0 0  1 0 0 0  0 0.5 3 0  10 -20 30 1]\n";
  for (const Case& c : cases()) {
    const Result<Model> model = parse_rib("WorldBegin\n" + transform + c.text + " \"Cs\" [1 0 0]\nWorldEnd\n", "m");
    ASSERT_TRUE(model.ok()) << model.status().message();
    ASSERT_EQ(model->surfaces.size(), 1u);
    EXPECT_TRUE(model->warnings.empty()) << c.text;
    const ModelSurface& surface = model->surfaces[0];
    const Domain d = domain(surface.surface);
    EXPECT_NEAR(specified(c, surface.surface, d.u1, d.v0)[0], radians(c.thetamax), 1e-13);
    const double size = length(c.point(0, 0)) + length(c.point(0, 1)) + 50;
    for (const double s : {0.0, 0.1, 0.37, 0.5, 0.8, 1.0})
      for (const double t : {0.0, 0.2, 0.5, 0.93, 1.0}) {
        const SurfaceJet jet = value_of(evaluate_jet(surface, d.u_at(s), d.v_at(t)));
        const auto [theta, v] = specified(c, surface.surface, d.u_at(s), d.v_at(t));
        EXPECT_LE(length(jet.position - map.point(c.point(theta, v))), 1e-14 * size) << c.text << s << ' ' << t;
        if (t == 0 || t == 1 || s == 1) continue;  // a pole, or the end of the formula
        const double h = 1e-6, turn = std::copysign(h, c.thetamax);
        const Vec3 du = map.vector(c.point(theta + turn, v) - c.point(theta - turn, v)),
                   dv = map.vector(c.point(theta, v + h) - c.point(theta, v - h));
        EXPECT_GT(dot(normalized(cross(jet.du, jet.dv)), normalized(cross(du, dv))), 1 - 1e-6) << c.text;
      }
  }
}

TEST(RibQuadrics, SpheresConesAndParaboloidsAreQuadrics) {
  for (const char* const text : {"Sphere 1 -1 1 360", "Cylinder 1 0 1 360", "Cone 1 1 360", "Paraboloid 1 0 1 360",
                                 "Sphere [1 -1 1 360]", "Sphere 1e-150 -1 1 360", "Cone 1e200 1e-100 360"}) {
    const Result<Model> model = parse_rib(text, "m");
    ASSERT_TRUE(model.ok()) << model.status().message();
    EXPECT_TRUE(std::holds_alternative<QuadricPiece>(model->surfaces[0].surface)) << text;
  }
}

TEST(RibQuadrics, NumbersThatMakeNoSurfaceAreRefused) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"Sphere 1 -1 1", "m:1: expected 4 finite numbers for radius, zmin, zmax, thetamax, found the end of the file"},
      {"\nSphere 1 -1 1 0", "m:2: Sphere: expected a thetamax of -360 to 360 other than 0, found 0"},
      {"Sphere 1 -1 1 361", "m:1: Sphere: expected a thetamax of -360 to 360 other than 0, found 361"},
      {"Sphere 0 -1 1 360", "m:1: Sphere: its radius is 0"},
      {"Sphere 1 0.5 0.5 360", "m:1: Sphere: "},
      {"Cylinder 1 2 2 360", "m:1: Cylinder: "},
      {"Cone 0 1 360", "m:1: Cone: its height or its radius is 0"},
      {"Paraboloid 1 -1 1 360", "m:1: Paraboloid: zmin and zmax have different signs"},
      {"Paraboloid 1 -1 0 360", "m:1: Paraboloid: its radius or zmax is 0"},
      {"Hyperboloid 1 0 0 1 0 0 360", "m:1: Hyperboloid: its profile is a point"},
      {"Disk 1 0 360", "m:1: Disk: its radius is 0"},
      {"Torus 2 1 0 400 360", "m:1: Torus: its ranges must be above 0 and at most a full turn"},
      {"Torus 2 0 0 360 360", "m:1: Torus: "},
      {"Disk 1 1 nan", "m:1: expected 3 finite numbers"}};
  for (const auto& [text, message] : refused) {
    const Result<Model> model = parse_rib(text, "m");
    ASSERT_FALSE(model.ok()) << text;
    EXPECT_EQ(model.status().code(), StatusCode::parse_error) << text;
    EXPECT_EQ(model.status().message().substr(0, message.size()), message);
  }
}

// Archives.

class RibArchiveFiles : public testing::Test {
 protected:
  RibArchiveFiles() { std::filesystem::create_directory(folder_ / "sub"); }
  Result<Model> read(const std::string& text) { return read_model(folder_.file("m.rib", text)); }
  void expect_refused(const std::string& text, StatusCode code, const std::string& words) {
    const Status status = read(text).status();
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_TRUE(status.message().starts_with(folder_ / words)) << status.message();
  }
  ScratchFolder folder_;
};

TEST_F(RibArchiveFiles, TheirRequestsAreReadInPlace) {
  folder_.file("a.rib", "Translate 0 2 0\nSphere 1 -1 1 360\nReadArchive \"sub/b.rib\"\n");
  folder_.file("sub/b.rib", "Cylinder 1 0 1 360 ReadArchive \"c.rib\" ReadArchive \"d.rib\"\n");
  folder_.file("sub/c.rib", "Disk 0 1 360\n");         // beside the file that names it
  folder_.file("d.rib", "Disk 1 1 360\nScale 2 2 2");  // beside the first file
  const Result<Model> model = read(
      "WorldBegin\nAttribute \"identifier\" \"name\" [\"part\"]\nTranslate 1 0 0\nReadArchive \"a.rib\"\n"
      "Cone 1 1 360\nWorldEnd\n");
  ASSERT_TRUE(model.ok()) << model.status().message();
  ASSERT_EQ(model->surfaces.size(), 5u);
  EXPECT_TRUE(model->warnings.empty());
  for (const ModelSurface& surface : model->surfaces) EXPECT_EQ(*surface.name, "part");
  EXPECT_EQ(model->surfaces[0].placement->translation, (Vec3{1, 2, 0}));
  EXPECT_EQ(model->surfaces[1].placement->translation, (Vec3{1, 2, 0}));
  EXPECT_EQ(model->surfaces[4].placement->translation, (Vec3{1, 2, 2}));  // the scale lasts; the cone's top is at 1
}

TEST_F(RibArchiveFiles, ErrorsAndWarningsNameTheirFile) {
  folder_.file("a.rib", "Sphere 1 -1 1 360\nSphere 0 -1 1 360\n");
  expect_refused("\nReadArchive \"a.rib\"\n", StatusCode::parse_error, "a.rib:2: Sphere: its radius is 0");
  folder_.file("b.rib", "Sphere 1 -1 1 360\nPolygon \"P\" [0 0 0 1 0 0 0 1 0]\n");
  const Result<Model> model = read("ReadArchive \"b.rib\"\nReadArchive \"missing.rib\"\n");
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(model->warnings,
            (std::vector<std::string>{(folder_ / "b.rib:2: shapes that are not read: Polygon 1, ReadArchive 1")}));
}

TEST_F(RibArchiveFiles, OtherFoldersCyclesAndDepthAreRefused) {
  folder_.file("self.rib", "Sphere 1 -1 1 360\nReadArchive \"./self.rib\"\n");
  expect_refused("ReadArchive \"self.rib\"", StatusCode::parse_error, "self.rib:2: ReadArchive: the file ");
  expect_refused("\n\nReadArchive \"m.rib\"", StatusCode::parse_error, "m.rib:3: ReadArchive: the file ");
  for (const char* const outside : {"../a.rib", "/etc/passwd", "sub/../../a.rib", "http://host/a.rib"})
    expect_refused("\nReadArchive \"" + std::string(outside) + "\"", StatusCode::unsupported,
                   "m.rib:2: ReadArchive: \"" + std::string(outside) + "\" is not read: the path must be relative");
  expect_refused("ReadArchive \"sub\"", StatusCode::io_error, "m.rib:1: ReadArchive: ");
  const test::ScratchFolder elsewhere;
  std::filesystem::create_symlink(elsewhere.file("a.rib", "Sphere 1 -1 1 360\n"), folder_ / "link.rib");
  std::filesystem::create_directory_symlink(elsewhere.path(), folder_ / "folder");
  for (const char* const link : {"link.rib", "folder/a.rib"})
    expect_refused("ReadArchive \"" + std::string(link) + "\"", StatusCode::unsupported,
                   "m.rib:1: ReadArchive: \"" + (folder_ / link) + "\" is not read: it is a link to ");
  std::filesystem::create_symlink(folder_.file("sub/ball.rib", "Sphere 1 -1 1 360\n"), folder_ / "within.rib");
  EXPECT_TRUE(read("ReadArchive \"within.rib\"").ok());
  expect_refused("ReadArchive 3", StatusCode::parse_error, "m.rib:1: expected the name of a file, found \"3\"");
  for (int k = 0; k < 40; ++k)
    folder_.file(std::to_string(k) + ".rib", "ReadArchive \"" + std::to_string(k + 1) + ".rib\"\n");
  expect_refused("ReadArchive \"0.rib\"", StatusCode::unsupported,
                 "31.rib:1: ReadArchive: archives are nested deeper than 32 files");
}

TEST_F(RibArchiveFiles, CopiesAreLimited) {
  // Each file reads the next one ten times: 10^7 spheres from a few hundred bytes.
  for (int k = 0; k < 7; ++k) {
    std::string text;
    for (int copy = 0; copy < 10; ++copy) text += "ReadArchive \"" + std::to_string(k + 1) + ".rib\"\n";
    folder_.file(std::to_string(k) + ".rib", text);
  }
  folder_.file("7.rib", "Sphere 1 -1 1 360\n");
  expect_refused("ReadArchive \"0.rib\"", StatusCode::unsupported, "6.rib:");
  const Result<Model> model = read("ReadArchive \"4.rib\"");
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(model->surfaces.size(), 1000u);
}

}}  // namespace tessera::test
