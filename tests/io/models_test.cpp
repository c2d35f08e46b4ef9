// The models that come with the project: those of the documents' figures have these figures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <set>

#include "support/random_patches.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"
#include "tessera/bezier_operations.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

const std::filesystem::path folder = TESSERA_SOURCE_DIR "/tools/models";

std::vector<std::filesystem::path> model_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Model model(const std::string& name) { return value_of(read_model(folder / (name + ".json"))); }
/// The first surface of a model.
ModelSurface surface(const std::string& name) { return model(name).surfaces.at(0); }

SurfaceJet jet(const ModelSurface& s, double u, double v) { return value_of(evaluate_jet(s, u, v)); }
Vec3 point(const ModelSurface& s, double u, double v) { return jet(s, u, v).position; }

/// Rounding of a formula of a few operations on numbers of order 1, and of the patches' conversion.
constexpr double rounding = 16 * double_unit;

/// How far the patches may be off; what was found by sampling may be a little more elsewhere.
double fit_error(const PatchGrid& grid) {
  const FitError& error = grid.fit_error();
  return error.certified ? error.distance : 1.05 * error.distance;
}

using Formula = std::function<Vec3(double, double)>;

/// Evaluated as they are, the surface is the formula everywhere; its patches are so within their fit error.
void expect_formula(const ModelSurface& s, const Formula& formula, double tolerance = rounding) {
  const Domain d = domain(s.surface);
  const PatchGrid grid = value_of(to_bezier(s));
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const double u = k == 0 ? d.u0 : k == 1 ? d.u1 : uniform(random, d.u0, d.u1);
    const double v = k == 0 ? d.v0 : k == 1 ? d.v1 : uniform(random, d.v0, d.v1);
    EXPECT_LE(max_abs(point(s, u, v) - formula(u, v)), tolerance) << *s.name << " at " << u << ", " << v;
    EXPECT_LE(max_abs(grid.evaluate_jet(u, v)->position - formula(u, v)), tolerance + fit_error(grid))
        << *s.name << " at " << u << ", " << v;
  }
}
/// The value at one place, of the surface and of its patches.
void expect_point(const ModelSurface& s, double u, double v, const Vec3& expected, double tolerance = rounding) {
  EXPECT_LE(max_abs(point(s, u, v) - expected), tolerance) << *s.name;
  const PatchGrid grid = value_of(to_bezier(s));
  EXPECT_LE(max_abs(grid.evaluate_jet(u, v)->position - expected), tolerance + fit_error(grid)) << *s.name;
}

double h0(double t) { return 1 - 3 * t * t + 2 * t * t * t; }
double h1(double t) { return t - 2 * t * t + t * t * t; }
double h3(double t) { return 3 * t * t - 2 * t * t * t; }

TEST(Models, EachIsReadAndSaysWhereItIsFrom) {
  const auto files = model_files();
  EXPECT_GE(files.size(), 60u);
  for (const auto& file : files) {
    const Result<Model> read = read_model(file);
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read->name, file.stem().string());
    const std::string text = content_of(file);
    EXPECT_TRUE(text.find("\"description\": \"Mathematics, section") != std::string::npos ||
                text.find("\"description\": \"Gallery: ") != std::string::npos)
        << file;
    std::set<std::string> names;
    for (const ModelSurface& s : read->surfaces) EXPECT_TRUE(!s.name->empty() && names.insert(s.name).second) << file;
  }
}

TEST(Models, EveryKindIsThere) {
  std::set<std::size_t> kinds;
  for (const auto& file : model_files())
    for (const ModelSurface& s : value_of(read_model(file)).surfaces) kinds.insert(s.surface.index());
  EXPECT_EQ(kinds.size(), std::variant_size_v<Surface>);
}

TEST(Models, PatchesAreTheSurface) {
  Random random(2);
  for (const auto& file : model_files())
    for (const ModelSurface& s : value_of(read_model(file)).surfaces) {
      const Result<PatchGrid> grid = to_bezier(s);
      ASSERT_TRUE(grid.ok()) << file << ": " << grid.status().message();
      Box3 box;
      for (const BezierPatch& patch : grid->patches()) box.extend(patch.hull_box());
      const double size = box.diagonal();
      EXPECT_LE(grid->fit_error().distance, 1.1e-6 * size) << file;
      const Domain d = grid->domain();
      for (int k = 0; k < 25; ++k) {
        const double u = uniform(random, d.u0, d.u1), v = uniform(random, d.v0, d.v1);
        const auto own = own_parameters(s.surface, u, v);
        const double gap = length(grid->evaluate_jet(u, v)->position - point(s, own[0], own[1]));
        EXPECT_LE(gap, fit_error(*grid) + 1e-13 * size) << file << " at " << u << ", " << v;
      }
    }
}

TEST(Models, Section12CoonsPatches) {
  for (std::size_t k : {0, 1}) {
    ModelSurface s = model("coons_bilinear_parabolas").surfaces.at(k);
    s.placement = {};
    expect_formula(s, [](double u, double v) { return Vec3{u + v, u * u - v * v, 1 - u + v}; });
  }
  expect_formula(surface("coons_bilinear_saddle"), [](double u, double v) { return Vec3{u, v, 2 * u * v}; });
  const ModelSurface bicubic = surface("coons_partially_bicubic");
  expect_formula(bicubic, [](double u, double v) {
    return Vec3{u, v, 2 * u * h3(v) + 2 * v * h3(u) - 2 * h3(u) * h3(v)};
  });
  expect_point(bicubic, 0.25, 0.75, {0.25, 0.75, 0.392578125});
}

TEST(Models, Section12HermitePatches) {
  const ModelSurface step = surface("ferguson_step");
  expect_formula(step, [](double u, double v) { return Vec3{u, v, h0(v) - h0(u) * h1(v)}; });
  expect_point(step, 0.25, 0.75, {0.25, 0.75, 0.11669921875});
  const Model twist = model("hermite_twist");
  ASSERT_EQ(twist.surfaces.size(), 3u);
  for (ModelSurface s : twist.surfaces) {
    s.placement = {};
    expect_formula(s, [](double u, double v) { return Vec3{u, v, 10 * h1(u) * h1(v)}; });
    expect_point(s, 0.25, 0.75, {0.25, 0.75, 0.06591796875});
  }
  expect_formula(surface("ferguson_flat"), [](double u, double v) { return Vec3{u, v, 0}; });
}

TEST(Models, Section12RuledSurfaces) {
  const ModelSurface arc = surface("ruled_arc_parabola");
  expect_formula(arc, [](double u, double v) {
    const double a = std::numbers::pi * u / 2;
    return Vec3{u, (1 - v) * std::sin(a) + v * u * u, (1 - v) * std::cos(a) - v * u / 2};
  });
  expect_point(arc, 0.25, 0.75, {0.25, 0.142545858, 0.137219883}, 0.5e-9);
  const ModelSurface sine = surface("ruled_parabola_sine");
  expect_formula(sine, [](double u, double v) {
    return Vec3{u, v, (1 - v) * 4 * u * (1 - u) + v * std::sin(2 * std::numbers::pi * u)};
  });
  expect_point(sine, 0.25, 0.75, {0.25, 0.75, 0.9375});
}

TEST(Models, Section12BicubicBezier) {
  const ModelSurface s = surface("bezier_bicubic");
  const SurfaceJet middle = jet(s, 0.5, 0.5);
  EXPECT_EQ(middle.position, (Vec3{0.5, 0.6875, 0.15625}));
  EXPECT_EQ(middle.du, (Vec3{-0.375, -0.5625, -0.375}));
  EXPECT_EQ(middle.dv, (Vec3{-0.5625, -0.375, 0.375}));
  EXPECT_EQ(middle.duv, (Vec3{-1.125, -3.375, -1.125}));
  expect_point(s, 0.25, 0.75, {0.44189453125, 0.85498046875, 0.44189453125});
}

TEST(Models, Section12UniformBSpline) {
  const ModelSurface s = surface("uniform_b_spline_16");
  EXPECT_EQ(domain(s.surface), Domain{});
  EXPECT_EQ(value_of(to_bezier(s)).patches().size(), 1u);
  expect_point(s, 0.3, 0.6, {3184649.0 / 4500000, 296411.0 / 375000, 149747.0 / 4500000});
  expect_point(s, 0, 0, {7.0 / 9, 5.0 / 6, -7.0 / 18});
}

TEST(Models, Section12Nurbs) {
  const Model nets = model("nurbs_5x5");
  for (const ModelSurface& s : nets.surfaces) {
    const PatchGrid grid = value_of(to_bezier(s));
    EXPECT_EQ(grid.patches().size(), 4u);
    for (const BezierPatch& patch : grid.patches()) {
      EXPECT_EQ(patch.degree_u(), 3);
      EXPECT_EQ(patch.degree_v(), 3);
    }
  }
  EXPECT_TRUE(std::get<BSplineSurface>(nets.surfaces[0].surface).is_rational());
  for (const double u : {0.0, 0.3, 0.5, 1.0})
    for (const double v : {0.0, 0.5, 0.8, 1.0})
      EXPECT_EQ(value_of(evaluate_jet(nets.surfaces[1].surface, u, v)).position,
                value_of(evaluate_jet(nets.surfaces[2].surface, u, v)).position);
}

TEST(Models, Section12Octants) {
  const ModelSurface octant = surface("rational_octant");
  expect_point(octant, 0.5, 0.5, {0.5, 0.5, std::sqrt(2.0) / 2});
  Random random(3);
  const Model sphere = model("sphere_of_octants");
  EXPECT_EQ(sphere.surfaces.size(), 8u);
  std::set<int> octants;
  for (const ModelSurface& s : sphere.surfaces) {
    const Vec3 m = point(s, 0.5, 0.5);
    octants.insert((m.x > 0) + 2 * (m.y > 0) + 4 * (m.z > 0));
    const PatchGrid grid = value_of(to_bezier(s));
    for (int k = 0; k < 100; ++k) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
      EXPECT_NEAR(length(point(s, u, v)), 1, 4 * double_unit);
      EXPECT_NEAR(length(grid.evaluate_jet(u, v)->position), 1, 4 * double_unit);
    }
  }
  EXPECT_EQ(octants.size(), 8u);
}

TEST(Models, Section12SPiece) {
  const ModelSurface s = surface("s_piece");
  EXPECT_EQ(point(s, 0.5, 0.25).z, 0);
  double largest = 0;
  for (int k = 0; k <= 6000; ++k) largest = std::max(largest, std::abs(point(s, k / 6000.0, 0.5).z));
  EXPECT_NEAR(largest, std::sqrt(3.0) / 6, 1e-7);
}

TEST(Models, Section12Joins) {
  const auto report = [](const std::string& name) {
    const Model two = model(name);
    const PatchGrid p = value_of(to_bezier(two.surfaces.at(0))), q = value_of(to_bezier(two.surfaces.at(1)));
    return value_of(measure_join({p.patch(0, 0), Side::u1}, {q.patch(0, 0), Side::u0}));
  };
  EXPECT_EQ(report("join_c1").continuity, Continuity::c1);
  const JoinReport g1 = report("join_g1");
  EXPECT_EQ(g1.continuity, Continuity::g1);
  EXPECT_NEAR(g1.ratio.value(), 0.5, 1e-15);
  const ModelSurface cylinder = surface("join_g1");
  expect_formula(cylinder, [](double u, double v) { return Vec3{u, v, (1 - u) * (1 - u)}; });
}

TEST(Models, Section9Functions) {
  expect_formula(surface("plane"), [](double u, double v) { return Vec3{u, 1 - u, v}; });
  expect_formula(surface("cylinder"), [](double u, double v) { return Vec3{std::cos(u), std::sin(u), v}; });
  expect_formula(surface("paraboloid"), [](double u, double v) { return Vec3{2 * u, 2 * v, u * u + v * v}; });
  for (const char* name : {"hemisphere", "hemisphere_stereographic"}) {
    const ModelSurface s = surface(name);
    const PatchGrid grid = value_of(to_bezier(s));
    Random random(4);
    for (int k = 0; k < 200; ++k) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 2 * std::numbers::pi);
      const Vec3 p = point(s, u, v);
      EXPECT_NEAR(length(p), 1, 1e-15) << name;
      EXPECT_GE(p.z, 0);
      EXPECT_NEAR(length(grid.evaluate_jet(u, v)->position), 1, fit_error(grid) + rounding) << name;
    }
  }
}

TEST(Models, QuadricsAreWhatTheirFilesSay) {
  std::set<QuadricKind> kinds;
  for (const auto& file : model_files()) {
    const std::string stem = file.stem().string();
    if (stem.rfind("quadric_", 0) != 0) continue;
    const Model quadric = value_of(read_model(file));
    for (const ModelSurface& s : quadric.surfaces) {
      const QuadricKind kind = std::get<QuadricPiece>(s.surface).quadric().kind();
      kinds.insert(kind);
      std::string words = stem.substr(8);
      std::string found(name(kind));
      for (std::string* text : {&words, &found})
        for (char& c : *text)
          if (c == '_' || c == '-') c = ' ';
      EXPECT_EQ(words, found) << file;
    }
  }
  EXPECT_EQ(kinds.size(), 11u);
}

}}  // namespace tessera::test
