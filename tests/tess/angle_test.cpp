// The angle between the normals of a surface within a triangle and the mesh's shading there never exceeds the bound.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tess/bounds/normal_net.h"
#include "tess/bounds/turning_bound.h"
#include "tess/certificate_sets.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

constexpr double degree = std::numbers::pi / 180;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// The largest angle found, over the patch's bound, at random points of random triangles of patches that have one.
double found_over_bound(const PatchSet& set, const Tessellation& plan, const Mesh& mesh, Random& random) {
  double most = 0;
  const std::size_t step = std::max<std::size_t>(mesh.triangle_count() / 2000, 1);
  for (std::size_t t = random() % step; t < mesh.triangle_count(); t += step) {
    const double bound = plan.angles()[mesh.patches[t]];
    if (std::isinf(bound)) continue;
    const std::uint32_t* k = &mesh.indices[3 * t];
    for (int sample = 0; sample < 12; ++sample) {
      double share[3] = {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
      if (sample < 3) share[sample] = 0;
      if (sample % 4 == 3) share[0] = share[1] = 1e-6;  // near a corner
      const double sum = share[0] + share[1] + share[2];
      Vec3 shading, corner[3];
      double u = 0, v = 0;
      for (int c = 0; c < 3; ++c) {
        const float* n = &mesh.normals[3 * k[c]];
        corner[c] = {n[0], n[1], n[2]};
        shading += share[c] / sum * corner[c];
        u += share[c] / sum * double(mesh.parameters[2 * k[c]]);
        v += share[c] / sum * double(mesh.parameters[2 * k[c] + 1]);
      }
      const SurfaceJet jet = evaluate_jet(set.patch(mesh.patches[t]), u, v);
      const Vec3 normal = cross(jet.du, jet.dv);
      if (!(length(normal) > 1e-7 * length(jet.du) * length(jet.dv))) continue;  // rounding decides
      for (const Vec3& other : {shading, corner[0], corner[1], corner[2]})
        most = std::max(most, (angle_between(normal, other) - 1e-6) / bound);
    }
  }
  return most;
}

TEST(Angle, IsNeverExceeded) {
  Random random(1);
  std::size_t bounded = 0;
  for (const CertificateSet& chosen : certificate_sets()) {
    const PatchSet set = set_of(chosen.patches);
    for (const double angle : {30 * degree, 8 * degree}) {
      const auto plan = Tessellation::make(set, {.angle = angle, .angle_rate = 8});
      ASSERT_TRUE(plan.ok()) << chosen.name << ": " << plan.status().message();
      EXPECT_LE(plan->angle(), angle * (1 + 1e-6));
      if (plan->capacity().triangles > 500'000) continue;
      const double found = found_over_bound(set, *plan, mesh_of(set, *plan), random);
      EXPECT_LE(found, 1) << chosen.name;
      if (chosen.name == "waves") {
        EXPECT_GE(found, 0.4);
        EXPECT_EQ(plan->patches_without_angle(), 0u);
      }
      bounded += chosen.patches.size() - plan->patches_without_angle();
    }
  }
  EXPECT_GT(bounded, 200u);
}

TEST(Angle, ASphereTakesWhatItMust) {
  const PatchSet set = set_of(sphere());
  for (const double angle : {20 * degree, 5 * degree, 1 * degree}) {
    const Tessellation plan = good(Tessellation::make(set, {.angle = angle}));
    EXPECT_EQ(plan.patches_without_angle(), 0u);  // poles have limits
    const Mesh mesh = mesh_of(set, plan);
    const MeshReport report = good(check(mesh));
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.degenerate_triangles, 0u);
    Random random(3);
    EXPECT_LE(found_over_bound(set, plan, mesh, random), 1);
    // A cell h x k turns by at most h pi / 2 + k pi / 2, if evenly parametrised: 8 octants of (pi / angle)^2 cells.
    const double fewest = 8 * 2 * std::pow(std::numbers::pi / angle, 2);
    EXPECT_LE(static_cast<double>(mesh.triangle_count()), 3.5 * fewest + 200) << angle / degree;
  }
}

/// A bicubic patch that bends only near (1, 1), beside another way round.
std::vector<BezierPatch> bent_in_corners() {
  const auto height = [](int i, int j) { return i == 3 && j == 3 ? 1.0 : 0.0; };
  std::vector<Vec3> one, other;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      one.push_back({i / 3.0, j / 3.0, height(i, j)});
      other.push_back({2 - j / 3.0, i / 3.0, height(i, 3 - j) * (i == 3 && j == 0)});
    }
  for (int i = 0; i < 4; ++i) other[static_cast<std::size_t>(4 * i + 3)] = one[static_cast<std::size_t>(12 + i)];
  return {polynomial(3, 3, one), polynomial(3, 3, other)};
}

TEST(Angle, SegmentsLieWherePatchesBend) {
  const PatchSet set = set_of(bent_in_corners());
  Random random(7);
  for (const double angle : {10 * degree, 3 * degree}) {
    const Tessellation plan = good(Tessellation::make(set, {.angle = angle}));
    double cells = 0, if_uniform = 0;
    for (const PatchSegments segments : proven_mesh_of(plan).plan().patches().segments) {
      const auto finest = [](Segments along) {
        double rate = 0;
        for (int e = 0; e < Segments::parts; ++e) rate = std::max(rate, along.rate_in(e).value());
        return rate;
      };
      cells += segments.cells();
      if_uniform += finest(segments.u) * finest(segments.v);
    }
    EXPECT_LE(cells, 0.6 * if_uniform);
    const Mesh mesh = mesh_of(set, plan);
    EXPECT_LE(found_over_bound(set, plan, mesh, random), 1);
    const MeshReport report = good(check(mesh));
    EXPECT_EQ(report.t_junctions, 0u);
    EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);  // a disc: no crack
  }
}

TEST(Angle, CombinesWithADistance) {
  const PatchSet set = set_of(closed_body());
  const auto count = [&](const TessellationOptions& options) {
    const Tessellation plan = good(Tessellation::make(set, options));
    EXPECT_TRUE(good(check(mesh_of(set, plan))).closed());
    EXPECT_LE(plan.bound(), options.tolerance.value_or(1e9) * (1 + 1e-6));
    EXPECT_LE(plan.angle(), options.angle.value_or(0) * (1 + 1e-6));
    return static_cast<double>(plan.capacity().triangles);
  };
  const double distance = count({.tolerance = 0.01}), angle = count({.angle = 10 * degree});
  const double both = count({.tolerance = 0.01, .angle = 10 * degree});
  EXPECT_GE(both, std::max(distance, angle));
  EXPECT_LE(both, 2 * std::max(distance, angle));
  EXPECT_NEAR(count({.tolerance = 0.01, .angle = 90 * degree}), distance, 0.1 * distance);
  const Tessellation budget = good(Tessellation::make(set, {.angle = 10 * degree, .budget = 5000}));
  EXPECT_LE(budget.angle(), 10 * degree * (1 + 1e-6));
  EXPECT_LE(budget.capacity().triangles, 5000u);
}

/// A patch whose tangents along u vanish in the middle: the normal turns over there.
TEST(Angle, CuspsHaveNoBoundAndAreCounted) {
  const std::vector<Vec3> cusp{{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {0, 0, 1}, {0, 1, 1}, {1, 0, 0}, {1, 1, 0}};
  const PatchSet set = set_of({polynomial(3, 1, cusp), wavy_field(1, 1)[0]});
  const Tessellation plan = good(Tessellation::make(set, {.angle = 10 * degree, .angle_rate = 10}));
  EXPECT_EQ(plan.patches_without_angle(), 1u);
  EXPECT_TRUE(std::isinf(plan.angles()[0]));
  EXPECT_LE(plan.angles()[1], 10.001 * degree);
  EXPECT_LE(plan.angle(), 10.001 * degree);
  const Mesh mesh = mesh_of(set, plan);
  EXPECT_EQ(std::count(mesh.patches.begin(), mesh.patches.end(), 0u), 2 * 10 * 10);
}

TEST(Angle, WrongOnesAreRefused) {
  const PatchSet set = set_of(closed_body());
  for (const double angle : {0.0, -1.0, std::nan(""), 1.6, std::numeric_limits<double>::infinity()}) {
    const auto plan = Tessellation::make(set, {.angle = angle});
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.status().message().find("it must be above 0 and at most pi / 2"), std::string::npos);
  }
  for (const int rate : {0, -3, 5000}) EXPECT_FALSE(Tessellation::make(set, {.angle = 0.1, .angle_rate = rate}).ok());
  EXPECT_FALSE(Tessellation::make(set, {}).ok());
  const auto refusal = [&](double angle) { return Tessellation::make(set, {.angle = angle}).status().message(); };
  const auto triangles = [&](double angle) {
    const std::string said = refusal(angle), before = "segments along a parameter of patch 0, and about ";
    EXPECT_NE(said.find(before), std::string::npos) << said;
    return std::stod(said.substr(said.find(before) + before.size()));
  };
  EXPECT_NEAR(triangles(1e-4) / triangles(1.5e-4), 2.25, 0.1);
  EXPECT_NE(refusal(4e-7).find("of patch 0, and more than "), std::string::npos) << refusal(4e-7);
  // A flat patch does not turn.
  const PatchSet flat = set_of({polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}})});
  EXPECT_EQ(good(Tessellation::make(flat, {.angle = 0.01})).capacity().triangles, 2u);
}

/// Compares the net with the cross product of the derivatives, and its division at poles with limits.
TEST(NormalNet, PointsAlongTheNormal) {
  Random random(5);
  const auto value = [](const VectorNet& net, double u, double v) {
    Vec3 sum;
    for (int i = 0; i <= net.degree_u; ++i)
      for (int j = 0; j <= net.degree_v; ++j) {
        double weight = 1;
        const auto bernstein = [](int n, int k, double t) {
          double b = std::pow(t, k) * std::pow(1 - t, n - k);
          for (int l = 0; l < k; ++l) b = b * (n - l) / (l + 1);
          return b;
        };
        weight = bernstein(net.degree_u, i, u) * bernstein(net.degree_v, j, v);
        sum += weight * net(i, j);
      }
    return sum;
  };
  for (int kind = 0; kind < 60; ++kind) {
    const int m = 1 + static_cast<int>(random() % 5), n = 1 + static_cast<int>(random() % 5);
    const BezierPatch patch = kind % 2 ? random_rational(random, m, n, 0.3, 3) : random_polynomial(random, m, n);
    const NormalNet net = normal_net(patch);
    for (int sample = 0; sample < 10; ++sample) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
      const SurfaceJet jet = evaluate_jet(patch, u, v);
      EXPECT_LE(angle_between(cross(jet.du, jet.dv), value(net.net, u, v)), 1e-8) << kind;
    }
  }
  for (const BezierPatch& patch : sphere()) {
    const NormalNet net = normal_net(patch);
    for (const double u : {0.0, 0.5, 1.0}) {
      const Vec3 p = de_casteljau(patch, u, 0.3), n = value(net.net, u, 0.3);
      EXPECT_GT(length(n), 100 * net.rounding);
      EXPECT_GE(std::abs(dot(p, normalized(n))), 1 - 1e-12) << u;
    }
  }
}

}}  // namespace tessera::test
