// Free-form surfaces of OBJ files are read back as they were written, in every type, and every way to write it.

#include <clocale>
#include <cmath>

#include "io/obj_samples.h"
#include "support/scratch_folder.h"
#include "tessera/convert.h"

namespace tessera { namespace {

using namespace test;

constexpr double freeform_rounding = 0x1p-52;

TEST(ObjFreeform, BSplineSurfacesComeBackNumberByNumber) {
  Random random(1);
  for (int k = 0; k < 60; ++k) {
    const KnotStyle style_u{static_cast<int>(random() % 4), random() % 2 == 0, random() % 2 == 0};
    const KnotStyle style_v{static_cast<int>(random() % 4), random() % 2 == 0, random() % 2 == 0};
    const int degree_u = 1 + static_cast<int>(random() % 5), degree_v = 1 + static_cast<int>(random() % 5);
    const BSplineSurface written = random_surface(random, degree_u, degree_v, style_u, style_v, k % 2 == 0);
    const Surface surface = surface_of(surface_text(written));
    ASSERT_TRUE(std::holds_alternative<BSplineSurface>(surface));
    const auto& read = std::get<BSplineSurface>(surface);
    EXPECT_TRUE(std::ranges::equal(read.points(), written.points()));
    EXPECT_TRUE(std::ranges::equal(read.weights(), written.weights()));
    EXPECT_TRUE(std::ranges::equal(read.knots_u(), written.knots_u()));
    EXPECT_TRUE(std::ranges::equal(read.knots_v(), written.knots_v()));
    EXPECT_EQ(read.domain(), written.domain());
  }
}

TEST(ObjFreeform, ABezierPatchComesBackNumberByNumber) {
  Random random(2);
  for (const auto& [m, n] : {std::pair{1, 1}, {3, 3}, {2, 5}, {15, 1}}) {
    const std::size_t count_u = std::size_t(m) + 1, count_v = std::size_t(n) + 1;
    const std::vector<Vec3> points = random_cloud(random, count_u * count_v);
    const std::vector<double> weights = random_positive(random, points.size()), unit{0, 1};
    const std::string degrees = "bezier\ndeg " + std::to_string(m) + " " + std::to_string(n);
    const std::string vertices =
        vertices_text(u_first(std::span(points), count_u, count_v), u_first(std::span(weights), count_u, count_v));
    for (const bool rational : {false, true}) {
      const Surface surface = surface_of(
          vertices + surface_text((rational ? "cstype rat " : "cstype ") + degrees, {}, points.size(), unit, unit));
      const auto& read = std::get<BezierPatch>(surface);
      EXPECT_TRUE(std::ranges::equal(read.points(), points));
      EXPECT_EQ(read.is_rational(), rational);  // weights of a surface that is not rational are ignored
      if (rational) {
        EXPECT_TRUE(std::ranges::equal(read.weights(), weights));
      }
    }
  }
}

/// Compares a net of pieces: its text's surface, and `piece(i, j, s, t)`, the point of piece i, j at local parameters.
template <class Piece>
void expect_pieces(const Surface& surface, std::span<const double> parm_u, std::span<const double> parm_v,
                   Piece&& piece) {
  Random random(3);
  for (std::size_t i = 0; i + 1 < parm_u.size(); ++i)
    for (std::size_t j = 0; j + 1 < parm_v.size(); ++j)
      for (int k = 0; k < 8; ++k) {
        const double s = uniform(random, 0.01, 0.99), t = uniform(random, 0.01, 0.99);
        const double u = parm_u[i] + s * (parm_u[i + 1] - parm_u[i]), v = parm_v[j] + t * (parm_v[j + 1] - parm_v[j]);
        EXPECT_LE(max_abs(position(surface, u, v) - piece(i, j, s, t)), 64 * freeform_rounding * 4);
      }
}

TEST(ObjFreeform, BezierMeshesAreTheirPatches) {
  Random random(4);
  const std::vector<double> parm_u{-1, 0.5, 2, 2.25}, parm_v{3, 4, 7};
  constexpr int m = 2, n = 3;
  constexpr std::size_t count_u = 3 * m + 1, count_v = 2 * n + 1;
  const std::vector<Vec3> points = random_cloud(random, count_u * count_v);  // u first
  const std::vector<double> weights = random_positive(random, points.size());
  const Surface surface =
      surface_of(vertices_text(points, weights) +
                 surface_text("cstype rat bezier\ndeg 2 3", {-1, 2.25, 3, 7}, points.size(), parm_u, parm_v));
  EXPECT_EQ(domain(surface), (Domain{-1, 2.25, 3, 7}));
  expect_pieces(surface, parm_u, parm_v, [&](std::size_t i, std::size_t j, double s, double t) {
    std::vector<Vec3> net;
    std::vector<double> net_weights;
    for (std::size_t a = 0; a <= m; ++a)
      for (std::size_t b = 0; b <= n; ++b) {
        net.push_back(points[(j * n + b) * count_u + i * m + a]);
        net_weights.push_back(weights[(j * n + b) * count_u + i * m + a]);
      }
    return de_casteljau(rational(m, n, net, net_weights), s, t);
  });
}

/// The blending functions of a cubic or other piece at t, times weights if there are any.
template <class Blend>
Vec3 blended(const std::vector<Vec3>& points, const std::vector<double>& weights, std::size_t count_u, std::size_t i0,
             std::size_t j0, int m, int n, Blend&& blend, double s, double t) {
  RealVec3 sum{};
  Real total = 0;
  for (int a = 0; a <= m; ++a)
    for (int b = 0; b <= n; ++b) {
      const std::size_t k = (j0 + std::size_t(b)) * count_u + i0 + std::size_t(a);
      const Real weight = weights.empty() ? 1 : Real(weights[k]), f = blend(0, a, s) * blend(1, b, t) * weight;
      sum = sum + f * RealVec3{points[k].x, points[k].y, points[k].z};
      total += f;
    }
  if (!weights.empty()) sum = (1 / total) * sum;
  return {double(sum.x), double(sum.y), double(sum.z)};
}

Real catmull_rom(int, int i, Real t) {
  const Real t2 = t * t, t3 = t2 * t;
  const Real f[] = {-t3 + 2 * t2 - t, 3 * t3 - 5 * t2 + 2, -3 * t3 + 4 * t2 + t, t3 - t2};
  return f[i] / 2;
}

TEST(ObjFreeform, CardinalSurfacesAreCatmullRomSplines) {
  Random random(5);
  const std::vector<double> parm_u{0, 1, 3, 3.5}, parm_v{-2, -1};
  constexpr std::size_t count_u = 6, count_v = 4;
  const std::vector<Vec3> points = random_cloud(random, count_u * count_v);
  const std::vector<double> weights = random_positive(random, points.size(), 0.8, 1.25);
  for (const std::vector<double>& used : {std::vector<double>{}, weights}) {
    const std::string type = used.empty() ? "cstype cardinal\ndeg 7 7" : "cstype rat cardinal";  // deg does not count
    const Surface surface =
        surface_of(vertices_text(points, used) + surface_text(type, {0, 3.5, -2, -1}, points.size(), parm_u, parm_v));
    expect_pieces(surface, parm_u, parm_v, [&](std::size_t i, std::size_t j, double s, double t) {
      return blended(points, used, count_u, i, j, 3, 3, catmull_rom, s, t);
    });
    for (std::size_t i = 0; i < parm_u.size(); ++i)  // all points but those of the border
      EXPECT_LE(max_abs(position(surface, parm_u[i], -2) - points[count_u + i + 1]), 8 * freeform_rounding);
  }
}

TEST(ObjFreeform, TaylorPiecesAreTheirPolynomials) {
  Random random(6);
  const std::vector<double> parm_u{0, 2}, parm_v{1, 1.5, 4};
  constexpr int m = 3, n = 1;
  constexpr std::size_t count_u = m + 1, count_v = 2 * (n + 1);
  const std::vector<Vec3> points = random_cloud(random, count_u * count_v);
  const std::vector<double> weights(points.size(), 1.0);
  const auto power = [](int, int i, Real t) { return std::pow(t, Real(i)); };
  for (const bool rational : {false, true}) {
    const Model model = model_of("g wave\n" + vertices_text(points, weights) +
                                 surface_text(rational ? "cstype rat taylor\ndeg 3 1" : "cstype taylor\ndeg 3 1",
                                              {0, 2, 1, 4}, points.size(), parm_u, parm_v));
    ASSERT_EQ(model.surfaces.size(), 2u);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_EQ(model.surfaces[j].name, "wave[" + std::to_string(j) + "]");
      const std::vector<double> own{parm_v[j], parm_v[j + 1]};
      expect_pieces(model.surfaces[j].surface, parm_u, own, [&](std::size_t, std::size_t, double s, double t) {
        // Weights are coefficients too: all of them 1 means division by (1 + s + s^2 + s^3)(1 + t).
        return blended(points, rational ? weights : std::vector<double>{}, count_u, 0, 2 * j, m, n, power, s, t);
      });
    }
  }
}

/// Row i: the coefficients of the function of control point i, ascending.
const std::vector<double> bezier_matrix{1, -3, 3, -1, 0, 3, -6, 3, 0, 0, 3, -3, 0, 0, 0, 1};
const std::vector<double> uniform_matrix{1. / 6, -0.5, 0.5, -1. / 6, 2. / 3, 0, -1, 0.5,
                                         1. / 6, 0.5,  0.5, -0.5,    0,      0, 0,  1. / 6};

TEST(ObjFreeform, BasisMatricesBlendAsTheirRowsSay) {
  Random random(7);
  // A mesh of 2 Bezier pieces in u by 3 of a uniform B-spline in v: the specification's third example.
  const std::vector<double> parm_u{0, 1, 2}, parm_v{0, 0.5, 2, 3};
  constexpr std::size_t count_u = 7, count_v = 6;
  const std::vector<Vec3> points = random_cloud(random, count_u * count_v);
  const std::string attributes = "cstype bmatrix\ndeg 3 3\nstep 3 1\nbmat u" + numbers_text(bezier_matrix) +
                                 "\nbmat v" + numbers_text(uniform_matrix);
  const auto blend = [](int direction, int i, Real t) {
    const std::vector<double>& b = direction == 0 ? bezier_matrix : uniform_matrix;
    Real sum = 0;
    for (int j = 3; j >= 0; --j) sum = sum * t + b[std::size_t(4 * i + j)];
    return sum;
  };
  const Model model =
      model_of(vertices_text(points) + surface_text(attributes, {0, 2, 0, 3}, points.size(), parm_u, parm_v));
  ASSERT_EQ(model.surfaces.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t i = k / 3, j = k % 3;
    EXPECT_TRUE(std::holds_alternative<TensorPatch>(model.surfaces[k].surface));
    expect_pieces(model.surfaces[k].surface, std::span(parm_u).subspan(i, 2), std::span(parm_v).subspan(j, 2),
                  [&](std::size_t, std::size_t, double s, double t) {
                    return blended(points, {}, count_u, 3 * i, j, 3, 3, blend, s, t);
                  });
  }
}

TEST(ObjFreeform, APartOfTheParametersIsTheSameSurfaceThere) {
  Random random(8);
  const std::vector<double> parm{0, 1, 2};
  const Domain part{0.25, 0.75, 1.25, 2}, whole{0, 2, 0, 2};
  const std::string matrix = numbers_text(bezier_matrix);
  for (const std::string& type : std::vector<std::string>{
           "cstype bezier\ndeg 3 3", "cstype cardinal", "cstype taylor\ndeg 2 2", "cstype rat bezier\ndeg 3 3",
           "cstype bmatrix\ndeg 3 3\nstep 3 3\nbmat u" + matrix + "\nbmat v" + matrix}) {
    const std::size_t count = type == "cstype cardinal" ? 25 : type.find("taylor") != std::string::npos ? 36 : 49;
    const std::vector<Vec3> points = random_cloud(random, count);
    const std::string vertices = vertices_text(points, random_positive(random, count));
    const Model all = model_of(vertices + surface_text(type, whole, count, parm, parm));
    const Model some = model_of(vertices + surface_text(type, part, count, parm, parm));
    ASSERT_EQ(some.surfaces.size(), 1u) << type;  // within the piece [0][1], which comes second
    EXPECT_EQ(domain(some.surfaces[0].surface), part);
    const Surface& same = all.surfaces[all.surfaces.size() == 1 ? 0 : 1].surface;
    for (int k = 0; k < 20; ++k) {
      const double u = uniform(random, part.u0, part.u1), v = uniform(random, part.v0, part.v1);
      EXPECT_LE(max_abs(position(some.surfaces[0].surface, u, v) - position(same, u, v)), 256 * freeform_rounding)
          << type;
    }
    EXPECT_TRUE(make_patch_set(some).ok());
  }
}

TEST(ObjFreeform, ThePatchesOfRelease211AreRead) {
  Random random(9);
  const std::vector<Vec3> points = random_cloud(random, 16);
  const std::string vertices = vertices_text(points);
  const std::vector<double> unit{0, 1}, uniform_knots{-3, -2, -1, 0, 1, 2, 3, 4};
  for (const auto& [word, type] : {std::pair{"bzp", "bezier"}, {"cdp", "cardinal"}, {"bsp", "bspline"}}) {
    const auto& parm = type == std::string("bspline") ? uniform_knots : unit;
    const Surface now = surface_of(vertices + surface_text(std::string("deg 3 3\ncstype ") + type, {}, 16, parm, parm));
    const Surface old = surface_of(vertices + word + range_text(16) + "\n");
    EXPECT_EQ(now.index(), old.index());
    for (const double t : {0.0, 0.3, 1.0}) EXPECT_EQ(position(now, t, 1 - t / 2), position(old, t, 1 - t / 2));
  }
}

TEST(ObjFreeform, AttributesHoldUntilTheyAreStatedAnewAndParametersDoNot) {
  const std::string body = "surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n";
  const Model model =
      model_of(four_vertices + "cstype bezier\ndeg 1 1\n" + body + "o a\n" + body + "deg 1 1\ng b  c\n" + body +
               "cstype bspline\nparm u 0 0 1 1\nparm v 0 0 1 1\nsurf 0 1 0 1 -4 -3 -2 -1\nend\n");
  ASSERT_EQ(model.surfaces.size(), 4u);
  EXPECT_EQ(model.surfaces[0].name, "");
  EXPECT_EQ(model.surfaces[1].name, "a");
  EXPECT_EQ(model.surfaces[2].name, "a/b  c");
  EXPECT_TRUE(std::holds_alternative<BSplineSurface>(model.surfaces[3].surface));
  EXPECT_TRUE(model.warnings.empty());
  const Result<Model> without = parse_obj_freeform(four_vertices + bilinear + "surf 0 1 0 1 1 2 3 4\nend\n", "m.obj");
  EXPECT_EQ(without.status().message(), "m.obj:11: surface 1: parm u is missing");
}

TEST(ObjFreeform, EveryWayToReferIsTheSame) {
  const Vec3 middle = position(surface_of(four_vertices + bilinear), 0.5, 0.5);
  for (const char* indices : {"-4 -3 -2 -1", "1/1 2/-1 3/1 4/2", "1//1 2//1 -2//-1 4//1", "1/2/1 2/2/1 3/1/1 4/1/1"}) {
    std::string text = four_vertices + "vt 0\nvt 1 1\nvn 0 0 1\n" + bilinear;
    text.replace(text.find("1 2 3 4"), 7, indices);
    EXPECT_EQ(position(surface_of(text), 0.5, 0.5), middle) << indices;
  }
  // Negative ones count from where they stand.
  EXPECT_EQ(
      position(surface_of("v 9 9 9\n" + four_vertices +
                          "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 -4 -3 -2 -1\nv 7 7 7\nparm u 0 1\nparm v 0 1\nend\n"),
               0.5, 0.5),
      middle);
}

TEST(ObjFreeform, LayoutDoesNotMatter) {
  for (const std::string& text : small_models()) {
    const Model plain = model_of(text);
    std::string windows = "\xEF\xBB\xBF# C:\\made\\elsewhere\\\r\n", tabs, continued, without_end = text;
    char last = 0;
    for (const char c : text) {
      // Only the end of the line may follow a continuation.
      windows += c != '\n' ? std::string(1, c) : last == '\\' ? "\r\n" : " # x \\\r\n\r\n";
      tabs += c == ' ' ? std::string("\t \t") : std::string(1, c);
      continued += c == ' ' ? std::string(" \\ \r\n") : std::string(1, c);
      last = c;
    }
    without_end.pop_back();
    for (const std::string& other : {windows, tabs, continued, without_end}) {
      const Model model = model_of(other);
      ASSERT_EQ(model.surfaces.size(), plain.surfaces.size()) << other;
      for (std::size_t k = 0; k < plain.surfaces.size(); ++k) {
        EXPECT_EQ(model.surfaces[k].trims->size(), plain.surfaces[k].trims->size());
        EXPECT_EQ(model.surfaces[k].name, plain.surfaces[k].name);
        const Domain d = domain(plain.surfaces[k].surface);
        for (const double t : {0.0, 0.4, 1.0})
          EXPECT_EQ(position(model.surfaces[k].surface, d.u_at(t), d.v_at(t)),
                    position(plain.surfaces[k].surface, d.u_at(t), d.v_at(t)));
      }
    }
  }
}

TEST(ObjFreeform, NumbersKnowNoLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (!std::setlocale(LC_ALL, "de_DE.UTF-8") && !std::setlocale(LC_ALL, "fr_FR.UTF-8"))
    GTEST_SKIP() << "no locale with a decimal comma here";
  std::string text = four_vertices + bilinear;
  text.replace(text.find("v 1 1 1"), 7, "v 1 1 2.5");
  EXPECT_EQ(position(surface_of(text), 1, 1), (Vec3{1, 1, 2.5}));
  std::setlocale(LC_ALL, before.c_str());
}

TEST(ObjFreeform, WeightsAndColoursAreToldApart) {
  const std::string tail = "cstype rat bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n";
  const Surface weighted = surface_of("v 0 0 0 3\nv 1 0 0\nv 0 1 0 0.5 1 1 1\nv 1 1 1 0.2 0.4 0.6\n" + tail);
  const std::vector<double> v_first{3, 0.5, 1, 1};
  EXPECT_TRUE(std::ranges::equal(std::get<BezierPatch>(weighted).weights(), v_first));
}

TEST(ObjFreeform, NamesKeepTheirBytes) {
  const Model model = model_of(four_vertices + "o T\xC3\xA9i\xC3\xA8re \xE8\x8C\xB6/1\ng lid#2 # a comment\n" +
                               bilinear + "o\ng\n" + bilinear + "g " + std::string(199, 'x') + "\xC3\xA9\n" + bilinear);
  EXPECT_EQ(model.surfaces.at(0).name, "T\xC3\xA9i\xC3\xA8re \xE8\x8C\xB6/1/lid#2");
  EXPECT_EQ(model.surfaces.at(1).name, "");
  EXPECT_EQ(model.surfaces.at(2).name, std::string(199, 'x'));  // cut at 200 bytes, between characters
}

TEST(ObjFreeform, TrimmingCurvesOfEveryTypeAreTheirFormulas) {
  Random random(10);
  const std::vector<double> parm{0, 1, 3};
  const std::string matrix = numbers_text(bezier_matrix);
  const auto at = [](const TrimLoop& loop, double t) {
    for (const Curve& curve : loop.curves)
      if (t <= curve.domain().to) return evaluate_jet(curve, t).position;
    return Vec3{};
  };
  for (const std::string type : {"cardinal", "taylor", "bmatrix"}) {
    const std::size_t count = type == "cardinal" ? 5 : type == "taylor" ? 8 : 7;
    std::vector<Vec3> points = random_cloud(random, count);
    std::string text = four_vertices;
    for (Vec3& p : points) {
      p.z = 0;
      text += "vp" + numbers_text(std::vector{p.x, p.y}) + "\n";
    }
    text += "cstype " + type + "\ndeg 3\nstep 3\nbmat u" + matrix + "\ncurv2" + range_text(count) +
            "\nparm u 0 1 3\nend\n" + bilinear.substr(0, bilinear.size() - 4) + "trim 0 3 1\nend\n";
    const Model model = model_of(text);
    ASSERT_EQ(model.surfaces.at(0).trims->size(), 1u) << type;
    const TrimLoop& loop = model.surfaces[0].trims->at(0);
    const auto blend = [&](int direction, int i, Real t) -> Real {
      if (direction == 1) return 1;
      if (type == "cardinal") return catmull_rom(0, i, t);
      if (type == "taylor") return std::pow(t, Real(i));
      return Real(std::vector<double>{1, 3, 3, 1}[std::size_t(i)]) * std::pow(t, Real(i)) *
             std::pow(1 - t, Real(3 - i));
    };
    const std::size_t step = type == "cardinal" ? 1 : type == "taylor" ? 4 : 3;
    for (std::size_t piece = 0; piece < 2; ++piece)
      for (const double s : {0.1, 0.5, 0.9}) {
        const Vec3 wanted = blended(points, {}, count, piece * step, 0, 3, 0, blend, s, 0);
        EXPECT_LE(max_abs(at(loop, parm[piece] + s * (parm[piece + 1] - parm[piece])) - wanted), 64 * freeform_rounding)
            << type;
      }
  }
}

TEST(ObjFreeform, WhatIsNotKeptIsCountedInOneWarning) {
  const Model model =
      model_of("mtllib a.mtl\n" + four_vertices + "vt 0 0\nf 1 2 3\nf 1/1 2/1 \\\n3/1\nusemtl red\n" +
               "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nsp 1\nend\ncon 1 0 1 1 2 0 1 2\n" + bilinear);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0],
            "m.obj:1: 8 statements are not kept, the first here: 1 mtllib, 1 vt, 2 f, 1 usemtl, 1 sp, 1 curv, 1 con");
  std::string strange;
  for (char c = 'a'; c <= 'z'; ++c) strange.append(30, c).append(" 1\n");
  const std::string warning = model_of(strange + four_vertices + bilinear).warnings.at(0);
  EXPECT_NE(warning.find("26 statements are not kept"), std::string::npos);
  EXPECT_NE(warning.find(", 10 others"), std::string::npos);
}

TEST(ObjFreeform, FilesAreReadByTheirExtension) {
  const ScratchFolder folder;
  const Result<Model> model = read_model(folder.file("Bowl.OBJ", four_vertices + bilinear));
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(model->name, "Bowl");
  const std::string mesh = folder.file("mesh.obj", four_vertices + "f 1 2 3\n");
  EXPECT_EQ(read_model(mesh).status().message(),
            mesh + ": no free-form surface in it; polygon meshes are read by `check`");
  EXPECT_EQ(read_model(mesh).status().code(), StatusCode::unsupported);
  EXPECT_EQ(read_mesh(mesh)->triangle_count(), 1u);
}

}}  // namespace tessera
