// The surfaces of RIB files: patches, meshes and their bases against the definition, NuPatches, height fields.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "io/reader_checks.h"
#include "tessera/trim_region.h"

namespace tessera::test { namespace {

using Matrix = std::array<double, 16>;

/// Bases as the Interface's specification prints them, rows from t^3 down.
struct NamedBasis {
  std::string text;  // after the word Basis
  Matrix matrix;
  int step;
};

std::string matrix_text(const Matrix& matrix, int step) {
  std::ostringstream text;
  text.precision(17);
  for (const double entry : matrix) text << (text.tellp() == 0 ? "[" : " ") << entry;
  return text.str() + "] " + std::to_string(step);
}

std::vector<NamedBasis> bases() {
  const double s = 1.0 / 6, h = 0.5;
  const Matrix bezier{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0},
      spline{-s, h, -h, s, h, -1, h, 0, -h, 0, h, 0, s, 4 * s, s, 0},
      catmull{-h, 3 * h, -3 * h, h, 1, -5 * h, 2, -h, -h, 0, h, 0, 0, 1, 0, 0},
      hermite{2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0},
      power{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  // A cardinal spline of tension 0.3, and an arbitrary matrix with a step of its own.
  const Matrix cardinal{-0.3, 1.7, -1.7, 0.3, 0.6, -2.7, 2.4, -0.3, -0.3, 0, 0.3, 0, 0, 1, 0, 0},
      strange{1, 2, -3, 0.5, 0, 1, 1, -1, 2, 0, -1, 1, 0.5, 0.25, 0.125, 1};
  return {{"\"bezier\" 3", bezier, 3},
          {"\"b-spline\" 1", spline, 1},
          {"\"catmull-rom\" 1", catmull, 1},
          {"\"hermite\" 2", hermite, 2},
          {"\"power\" 4", power, 4},
          {"[-0.16667 0.5 -0.5 0.16667 0.5 -1 0.5 0 -0.5 0 0.5 0 0.16667 0.66667 0.16667 0] 1", spline, 1},
          {matrix_text(cardinal, 1), cardinal, 1},
          {matrix_text(strange, 2), strange, 2},
          {"\"bezier\" 1", bezier, 1}};
}

/// Control points in the file's order, u first, with weights.
struct Mesh4 {
  std::size_t nu, nv;
  bool rational;
  std::vector<std::array<double, 4>> points;

  std::string text() const {
    std::ostringstream text;
    text.precision(17);
    text << (rational ? "\"vertex hpoint Pw\" [" : "\"P\" [");
    for (const auto& p : points) {
      for (int c = 0; c < (rational ? 4 : 3); ++c) text << p[static_cast<std::size_t>(c)] << ' ';
    }
    return text.str() + "]";
  }
};

Mesh4 random_mesh(std::mt19937& random, std::size_t nu, std::size_t nv, bool rational) {
  std::uniform_real_distribution<double> coordinate(-1, 1), weight(0.9, 1.1);
  Mesh4 mesh{nu, nv, rational, {}};
  for (std::size_t k = 0; k < nu * nv; ++k) {
    mesh.points.push_back({coordinate(random), coordinate(random), coordinate(random), rational ? weight(random) : 0});
  }
  return mesh;
}

/// [t^3 t^2 t 1] M, the four weights of a patch's control points.
std::array<double, 4> blend(const Matrix& m, double t) {
  std::array<double, 4> b{};
  for (std::size_t i = 0; i < 4; ++i) b[i] = ((m[i] * t + m[4 + i]) * t + m[8 + i]) * t + m[12 + i];
  return b;
}

/// The definition: patch (a, b) of the mesh at (s, t) in it.
Vec3 defined(const Mesh4& mesh, const NamedBasis& u, const NamedBasis& v, std::size_t a, std::size_t b, double s,
             double t) {
  const auto f = blend(u.matrix, s), g = blend(v.matrix, t);
  std::array<double, 4> sum{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const std::size_t column = (a * static_cast<std::size_t>(u.step) + i) % mesh.nu,
                        row = (b * static_cast<std::size_t>(v.step) + j) % mesh.nv;
      for (std::size_t c = 0; c < 4; ++c) sum[c] += f[i] * g[j] * mesh.points[row * mesh.nu + column][c];
    }
  }
  const double w = mesh.rational ? sum[3] : 1;
  return {sum[0] / w, sum[1] / w, sum[2] / w};
}

/// The point at the mesh's own (u,v), from whichever surface holds it.
Vec3 point_of(const Model& model, double u, double v) {
  for (const ModelSurface& surface : model.surfaces) {
    if (domain(surface.surface).contains(u, v)) return evaluate_jet(surface, u, v)->position;
  }
  ADD_FAILURE() << "no surface at " << u << ' ' << v;
  return {};
}

void expect_defined(const Model& model, const Mesh4& mesh, const NamedBasis& u, const NamedBasis& v, std::size_t nu,
                    std::size_t nv, const std::string& what) {
  for (std::size_t a = 0; a < nu; ++a) {
    for (std::size_t b = 0; b < nv; ++b) {
      for (const auto& [s, t] : {std::pair(0.1, 0.9), {0.5, 0.25}, {0.75, 0.6}}) {
        const Vec3 p = point_of(model, (static_cast<double>(a) + s) / static_cast<double>(nu),
                                (static_cast<double>(b) + t) / static_cast<double>(nv));
        // Matrices printed with five digits are recognised.
        EXPECT_LE(length(p - defined(mesh, u, v, a, b, s, t)), 2e-13)
            << what.substr(0, 300) << ", patch " << a << ' ' << b;
      }
    }
  }
}

TEST(Rib, PatchesFollowTheirBases) {
  std::mt19937 random(1);
  for (const NamedBasis& u : bases()) {
    for (const NamedBasis& v : bases()) {
      const Mesh4 mesh = random_mesh(random, 4, 4, false);
      const std::string text = "Basis " + u.text + " " + v.text + " Patch \"bicubic\" " + mesh.text();
      const Model model = model_of(parse_rib, text);
      ASSERT_EQ(model.surfaces.size(), 1u);
      expect_defined(model, mesh, u, v, 1, 1, text);
    }
  }
}

TEST(Rib, MeshesFollowTheirBasesStepsAndWraps) {
  std::mt19937 random(2);
  for (const NamedBasis& u : bases()) {
    for (const NamedBasis& v : bases()) {
      for (const bool wraps : {false, true}) {
        const std::size_t nu = 3, nv = 4;  // patches
        const std::size_t points_u = static_cast<std::size_t>(u.step) * (nu - !wraps) + (wraps ? 0 : 4),
                          points_v = static_cast<std::size_t>(v.step) * (nv - 1) + 4;
        const Mesh4 mesh = random_mesh(random, points_u, points_v, false);
        const std::string text = "Basis " + u.text + " " + v.text + " PatchMesh \"bicubic\" " +
                                 std::to_string(points_u) + (wraps ? " \"periodic\" " : " \"nonperiodic\" ") +
                                 std::to_string(points_v) + " \"nonperiodic\" " + mesh.text();
        expect_defined(model_of(parse_rib, text), mesh, u, v, nu, nv, text);
      }
    }
  }
}

TEST(Rib, MeshesWrapAlongVAndMayBeRational) {
  std::mt19937 random(3);
  const auto all = bases();
  for (const std::size_t k : {0, 1, 2, 6}) {  // bases that blend only points
    const NamedBasis &u = all[k], &v = all[1];
    const Mesh4 mesh = random_mesh(random, 4 + static_cast<std::size_t>(u.step), 5, true);
    const std::string text = "Basis " + u.text + " " + v.text + " PatchMesh \"bicubic\" " + std::to_string(mesh.nu) +
                             " \"nonperiodic\" 5 \"periodic\" " + mesh.text();
    const Model model = model_of(parse_rib, text);
    expect_defined(model, mesh, u, v, 2, 5, text);
    EXPECT_EQ(model.surfaces.size(), k == 6 ? 10u : 1u);
  }
}

TEST(Rib, MeshesAreAsSmoothAsTheirBases) {
  std::mt19937 random(4);
  const std::vector<std::pair<std::string, std::size_t>> inner_knots{
      {"\"bezier\" 3 ", 3}, {"\"b-spline\" 1 ", 1}, {"\"catmull-rom\" 1 ", 2}, {"\"hermite\" 2 ", 2}};
  for (const auto& [basis, times] : inner_knots) {
    const std::size_t step = basis.find('3') != std::string::npos ? 3 : basis.find('2') != std::string::npos ? 2 : 1;
    const Mesh4 mesh = random_mesh(random, 4 + step, 4, false);
    const Model model =
        model_of(parse_rib, "Basis " + basis + basis + "PatchMesh \"bicubic\" " + std::to_string(mesh.nu) +
                                " \"nonperiodic\" 4 \"nonperiodic\" " + mesh.text());
    const auto& surface = std::get<BSplineSurface>(model.surfaces.at(0).surface);
    const auto knots = surface.knots_u();
    EXPECT_EQ(static_cast<std::size_t>(std::count(knots.begin(), knots.end(), 0.5)), times) << basis;
    EXPECT_EQ(surface.domain(), (Domain{0, 1, 0, 1}));
  }
}

TEST(Rib, BilinearPatchesAndMeshesRunAlongUFirst) {
  const Model patch = model_of(parse_rib, "Patch \"bilinear\" \"P\" [0 0 0  1 0 0  0 2 0  1 2 5]");
  EXPECT_EQ(evaluate_jet(patch.surfaces.at(0), 1, 0)->position, (Vec3{1, 0, 0}));
  EXPECT_EQ(evaluate_jet(patch.surfaces.at(0), 0, 1)->position, (Vec3{0, 2, 0}));
  EXPECT_EQ(evaluate_jet(patch.surfaces.at(0), 1, 1)->position, (Vec3{1, 2, 5}));
  EXPECT_EQ(kind_name(patch.surfaces[0].surface), "Bezier patch");
  // A closed ring of three quads; parameters are uniform from 0 to 1.
  const Model ring = model_of(parse_rib,
                              "PatchMesh \"bilinear\" 3 \"periodic\" 2 \"nonperiodic\" \"P\" "
                              "[1 0 0  0 1 0  -1 -1 0  1 0 1  0 1 1  -1 -1 1]");
  EXPECT_EQ(evaluate_jet(ring.surfaces.at(0), 1.0 / 3, 1)->position, (Vec3{0, 1, 1}));
  EXPECT_EQ(evaluate_jet(ring.surfaces.at(0), 1, 0)->position, (Vec3{1, 0, 0}));
  EXPECT_LE(length(evaluate_jet(ring.surfaces.at(0), 5.0 / 6, 0)->position - Vec3{0, -0.5, 0}), 1e-15);
}

TEST(Rib, BezierPatchesKeepTheirPointsBitForBit) {
  std::mt19937 random(5);
  const Mesh4 mesh = random_mesh(random, 4, 4, false);
  const Model model = model_of(parse_rib, "Patch \"bicubic\" " + mesh.text());
  const auto& patch = std::get<BezierPatch>(model.surfaces.at(0).surface);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const auto& p = mesh.points[j * 4 + i];
      EXPECT_EQ(patch.point(static_cast<int>(i), static_cast<int>(j)), (Vec3{p[0], p[1], p[2]}));
    }
  }
}

TEST(Rib, HeightFieldsStandOverTheirParameters) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> height(-1, 1);
  const auto field = [&](const std::string& request, int points) {
    std::string text = request + " \"Pz\" [";
    for (int k = 0; k < points; ++k) text += std::to_string(height(random)) + " ";
    return model_of(parse_rib, text + "]");
  };
  const std::vector<Model> fields{
      field("Patch \"bilinear\"", 4), field("Patch \"bicubic\"", 16),
      field("Basis \"b-spline\" 1 \"catmull-rom\" 1 PatchMesh \"bicubic\" 6 \"nonperiodic\" 5 \"nonperiodic\"", 30),
      field("NuPatch 5 4 [0 0 0 0 1 3 3 3 3] 0 3 3 3 [-1 -1 0 2 4 5] 0 2", 15)};
  for (const Model& model : fields) {
    const Domain d = domain(model.surfaces.at(0).surface);
    for (double s = 0; s <= 1; s += 0.125) {
      const Vec3 p = evaluate_jet(model.surfaces[0], d.u_at(s), d.v_at(1 - s))->position;
      EXPECT_NEAR(p.x, d.u_at(s), 1e-15);
      EXPECT_NEAR(p.y, d.v_at(1 - s), 1e-15);
    }
  }
  EXPECT_EQ(error_of(parse_rib,
                     "Basis \"hermite\" 2 \"bezier\" 3\nPatch \"bicubic\" \"Pz\" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]"),
            "m:2: Patch: a height field needs a basis of points (bezier, b-spline, catmull-rom)");
}

TEST(Rib, NuPatchesHaveTheirKnotsAndRanges) {
  std::mt19937 random(7);
  const std::vector<double> knots_u{-1, -1, -1, 0, 2, 2, 2}, knots_v{0, 1, 2, 3, 4};
  for (const bool rational : {false, true}) {
    const Mesh4 mesh = random_mesh(random, 4, 3, rational);
    const Model model =
        model_of(parse_rib, "NuPatch 4 3 [-1 -1 -1 0 2 2 2] -0.5 2 3 2 [0 1 2 3 4] 1 2.5 \"st\" [1 2 3] " +
                                mesh.text() + " \"Ks\" 5");
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const auto& p = mesh.points[j * 4 + i];
        const double w = rational ? p[3] : 1;
        points.push_back({p[0] / w, p[1] / w, p[2] / w});
        weights.push_back(w);
      }
    }
    const Domain range{-0.5, 2, 1, 2.5};
    const auto wanted = rational ? BSplineSurface::rational(2, knots_u, 1, knots_v, points, weights, range)
                                 : BSplineSurface::polynomial(2, knots_u, 1, knots_v, points, range);
    ASSERT_TRUE(wanted.ok()) << wanted.status().message();
    const auto& surface = std::get<BSplineSurface>(model.surfaces.at(0).surface);
    EXPECT_EQ(surface.domain(), range);
    for (const auto& [u, v] : {std::pair(-0.5, 1.0), {0.3, 1.7}, {2.0, 2.5}}) {
      EXPECT_EQ(evaluate_jet(surface, u, v).position, evaluate_jet(*wanted, u, v).position);
    }
  }
}

TEST(Rib, TrimCurvesAreKept) {
  const std::string trims =
      "TrimCurve [1 2] [2 3 2] [0 0 1 1 0 0 0 1 1 1 0 0 1 1] [0 0 0] [1 1 1] [2 3 2] "
      "[0 1  1 0.70710678118654752 0  0 1] [0 0  0 0.70710678118654752 1  1 0] [1 1  1 0.70710678118654752 1  1 1]";
  const std::string patch = " NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0] ";
  const Model model = model_of(parse_rib, "AttributeBegin " + trims + patch + patch + "AttributeEnd" + patch);
  ASSERT_EQ(model.surfaces.size(), 3u);
  EXPECT_TRUE(model.surfaces[2].trims->empty());
  EXPECT_TRUE(model.warnings.empty());
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& loops = *model.surfaces[k].trims;
    ASSERT_EQ(loops.size(), 2u);
    EXPECT_EQ(loops[0].curves.size(), 1u);
    ASSERT_EQ(loops[1].curves.size(), 2u);
    EXPECT_EQ(evaluate_jet(loops[0].curves[0], 0.25).position, (Vec3{0.25, 0, 0}));
    const Vec3 arc = evaluate_jet(loops[1].curves[0], 0.5).position;  // of the unit circle
    EXPECT_NEAR(std::hypot(arc.x, arc.y), 1, 1e-15);
    EXPECT_EQ(evaluate_jet(loops[1].curves[1], 1).position, (Vec3{1, 0, 0}));
  }
}

/// The specification's odd winding rule, on a ring and a triangle; points are homogeneous.
TEST(Rib, TrimCurvesKeepWhatTheyEnclose) {
  std::string u, v, w;
  constexpr int x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  for (const double radius : {0.375, 0.125})
    for (int k = 0; k < 9; ++k) {
      const double weight = k % 2 == 0 ? 1 : std::sqrt(0.5);
      char numbers[3][32];
      std::snprintf(numbers[0], 32, "%.17g ", weight * (0.5 + radius * x[k]));
      std::snprintf(numbers[1], 32, "%.17g ", weight * (0.5 + radius * y[k]));
      std::snprintf(numbers[2], 32, "%.17g ", weight);
      u += numbers[0], v += numbers[1], w += numbers[2];
    }
  const std::string circle = "0 0 0 1 1 2 2 3 3 4 4 4 ";
  const std::string trims = "TrimCurve [1 1 1] [3 3 2] [" + circle + circle + "0 0 1 2 3 3] [0 0 0] [4 4 3] [9 9 4] [" +
                            u + "0 0.1 0 0] [" + v + "0 0 0.1 0] [" + w + "1 1 1 1] ";
  const std::string patch = "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]";
  const Model model = model_of(parse_rib, trims + patch);
  ASSERT_EQ(model.surfaces.size(), 1u);
  const Result<TrimRegion> region = TrimRegion::make(*model.surfaces[0].trims, domain(model.surfaces[0].surface));
  ASSERT_TRUE(region.ok());
  EXPECT_TRUE(region->remarks().empty());
  for (int i = 0; i < 200; ++i)
    for (int k = 0; k < 200; ++k) {
      const double s = (i + 0.3) / 200, t = (k + 0.4) / 200, r = std::hypot(s - 0.5, t - 0.5);
      const bool kept = (r < 0.375 && r > 0.125) || s + t < 0.1;
      ASSERT_EQ(region->locate(s, t), kept ? TrimSide::inside : TrimSide::outside) << s << ' ' << t;
    }
}

}}  // namespace tessera::test
