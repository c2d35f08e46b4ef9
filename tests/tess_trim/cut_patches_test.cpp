// A generator of cut patches of every bad kind, under a limit of triangles that few of them come near.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tess_trim/trimmed_face.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

BSplineSurface bezier_surface(int degree_u, int degree_v, const std::vector<Vec3>& points) {
  const auto knots = [](int degree) {
    std::vector<double> all(2 * static_cast<std::size_t>(degree) + 2, 0.0);
    std::fill(all.begin() + degree + 1, all.end(), 1.0);
    return all;
  };
  return value_of(BSplineSurface::polynomial(degree_u, knots(degree_u), degree_v, knots(degree_v), points));
}

/// A triangle-like patch, whose side v = 1 is as long as `top`: a pole if that is 0.
BSplineSurface fan(double top) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 3; ++i)
    for (const double v : {0.0, 1.0}) {
      const double x = (i / 3.0 - 0.5) * (v > 0 ? top : 10);
      points.push_back({x, 10 * v, i == 1 || i == 2 ? 0.3 : 0.0});
    }
  return bezier_surface(3, 1, points);
}
/// An arch, straight along u or v, 20 long.
BSplineSurface arch(bool straight_along_u) {
  std::vector<Vec3> points(8);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t end = 0; end < 2; ++end)
      points[straight_along_u ? 4 * end + k : 2 * k + end] = {double(k), 20.0 * double(end),
                                                              k == 1 || k == 2 ? 2.0 : 0};
  return straight_along_u ? bezier_surface(1, 3, points) : bezier_surface(3, 1, points);
}
BSplineSurface twist() { return bezier_surface(1, 1, {{0, 0, 0}, {0, 4, 1}, {4, 0, 1}, {4, 4, 0}}); }

const std::vector<std::pair<const char*, std::function<BSplineSurface()>>> surfaces{
    {"near pole", [] { return fan(1e-3); }}, {"pole", [] { return fan(0); }},   {"along u", [] { return arch(true); }},
    {"along v", [] { return arch(false); }}, {"twist", [] { return twist(); }}, {"wavy", [] { return wavy(); }},
    {"cylinder", [] { return cylinder(); }},
};

/// Facts of a mesh: its triangles, the parts of its area that are turned by more than 60 degrees from the mean
/// of their corners' normals, and all of it.
struct Made {
  bool ok = false;
  std::size_t triangles = 0;
  double turned = 0, area = 0;
};
Made make(const BSplineSurface& surface, const std::vector<TrimLoop>& loops, double tolerance) {
  Face face(surface, loops);
  const Result<Tessellation> plan = Tessellation::make(face.set, {.tolerance = tolerance, .max_triangles = 300000});
  Made made;
  if (!plan) {
    EXPECT_EQ(plan.status().message().find("the limit"), std::string::npos) << plan.status().message();
    return made;
  }
  made.ok = true;
  Mesh mesh = value_of(plan->allocate());
  EXPECT_TRUE(plan->run(face.set, mesh.views()).ok());
  made.triangles = mesh.triangle_count();
  const auto vector = [](const std::vector<float>& of, std::uint32_t k) {
    return Vec3{of[3 * std::size_t{k}], of[3 * std::size_t{k} + 1], of[3 * std::size_t{k} + 2]};
  };
  for (std::size_t t = 0; t < made.triangles; ++t) {
    const std::uint32_t* c = &mesh.indices[3 * t];
    const Vec3 p = vector(mesh.positions, c[0]);
    const Vec3 twice = cross(vector(mesh.positions, c[1]) - p, vector(mesh.positions, c[2]) - p);
    const Vec3 normal = vector(mesh.normals, c[0]) + vector(mesh.normals, c[1]) + vector(mesh.normals, c[2]);
    made.area += length(twice) / 2;
    if (dot(twice, normal) < 0.5 * length(twice) * length(normal)) made.turned += length(twice) / 2;
  }
  return made;
}

constexpr double max_turned = 1e-4;  // of a face's area

/// Moves a point of [0, 1]^2 to a domain.
using Place = std::function<ParameterPoint(double u, double v)>;
/// The loops that are made with the places of a surface's domain.
std::vector<TrimLoop> on_domain(const BSplineSurface& surface,
                                const std::function<std::vector<TrimLoop>(const Place&)>& loops) {
  const Domain d = surface.domain();
  return loops([d](double u, double v) { return ParameterPoint{d.u0 + u * (d.u1 - d.u0), d.v0 + v * (d.v1 - d.v0)}; });
}

TEST(CutPatches, OfLoopsThatCrossThemselvesStayCoarse) {
  for (const auto& [name, surface] : surfaces) {
    const BSplineSurface s = surface();
    const auto loops = [&](bool crossing) {
      return on_domain(s, [&](const Place& at) {
        std::vector<ParameterPoint> ring;
        for (int k = 0; k < 8; ++k) {
          const double angle = 2 * std::numbers::pi * k / 8, r = crossing && k % 2 ? 0.45 : 0.4;
          ring.push_back(at(0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle)));
        }
        if (crossing) std::swap(ring[2], ring[3]);
        return std::vector<TrimLoop>{polygon(ring)};
      });
    };
    for (const double tolerance : {1e-2, 1e-3}) {
      const Made simple = make(s, loops(false), tolerance), crossed = make(s, loops(true), tolerance);
      ASSERT_TRUE(simple.ok && crossed.ok);
      EXPECT_LE(crossed.triangles, 4 * simple.triangles + 100) << name;
      for (const Made& made : {simple, crossed}) EXPECT_LE(made.turned, max_turned * made.area) << name;
    }
  }
}

/// Up to three rings of random corners, with holes: many corners lie on the domain's borders, some rings are needles.
std::vector<TrimLoop> random_rings(std::mt19937& random, const Place& at) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<TrimLoop> all;
  const std::size_t count = 1 + random() % 3;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<ParameterPoint> ring;
    const std::size_t corners = 3 + random() % 20;
    const double u = uniform(random), v = uniform(random), ru = std::pow(uniform(random), 3), rv = uniform(random);
    for (std::size_t c = 0; c < corners; ++c) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(c) / static_cast<double>(corners),
                   r = 0.3 + 0.7 * uniform(random);
      ring.push_back(
          at(std::clamp(u + ru * r * std::cos(angle), 0.0, 1.0), std::clamp(v + rv * r * std::sin(angle), 0.0, 1.0)));
    }
    all.push_back(polygon(ring, k > 0));
  }
  return all;
}

// Few faces have a part that no flip can turn: a loop's tip that is thinner than its chords are bent.
TEST(CutPatches, OfRandomLoopsEndAndFaceTheirSurface) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int rounds = 140;
  int turned = 0, made_faces = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto& [name, surface] = surfaces[static_cast<std::size_t>(round) % surfaces.size()];
    const BSplineSurface s = surface();
    const double tolerance = std::pow(10.0, -1 - 2.5 * uniform(random));
    const Made made = make(s, on_domain(s, [&](const Place& at) { return random_rings(random, at); }), tolerance);
    made_faces += made.ok;
    turned += made.turned > max_turned * made.area;
    EXPECT_LE(made.turned, 0.01 * made.area) << name << ", round " << round;
  }
  EXPECT_EQ(made_faces, rounds);
  EXPECT_LE(turned, rounds / 20);
}

// A limit on triangles is looked at within a patch, and the message names it.
TEST(CutPatches, StopAtTheLimitOfTriangles) {
  Face face(wavy(), {circle({2, 1.5}, 1)});
  const Result<Tessellation> plan = Tessellation::make(face.set, {.tolerance = 1e-4, .max_triangles = 100});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument);
}

}}  // namespace tessera::test
