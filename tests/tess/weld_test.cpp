// Welding: borders that differ by rounding, or by a known length, meet without a crack, and the bounds include it.

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/synthetic_sets.h"
#include "support/triangle_distance.h"
#include "tess/edges/side_curve.h"
#include "tess/shaken.h"
#include "tess/tessellate_support.h"
#include "tessera/bezier_operations.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

Mesh welded_mesh(const PatchSet& set, double tolerance, double weld) {
  return mesh_of(set, good(Tessellation::make(set, {.tolerance = tolerance, .joining = {.weld = weld}})));
}

/// Each patch raised to a degree of its own.
std::vector<BezierPatch> elevated(const std::vector<BezierPatch>& patches, std::uint64_t seed) {
  Random random(seed);
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches)
    out.push_back(good(elevate_degree(patch, patch.degree_u() + static_cast<int>(random() % 3),
                                      patch.degree_v() + static_cast<int>(random() % 3))));
  return out;
}

TEST(Weld, ClosesWhatRoundingOpened) {
  for (const auto& body : {closed_body(), sphere()})
    for (const double by : {1e-15, 1e-9, 1e-5, 1e-3}) {
      const PatchSet set = set_of(shaken(body, by, 7));
      const bool seen_in_float = by > 1e-8;
      for (const double tolerance : {0.5, 0.1, 0.02, 0.005}) {
        const MeshReport cracked = good(check(welded_mesh(set, tolerance, 0)));
        EXPECT_TRUE(!seen_in_float || cracked.open_edges > 0);
        const MeshReport report = good(check(welded_mesh(set, tolerance, 4 * by)));
        EXPECT_EQ(report.open_edges, 0u) << by << " " << tolerance;
        EXPECT_EQ(report.non_manifold_edges, 0u) << by << " " << tolerance;
        EXPECT_EQ(report.degenerate_triangles, 0u) << by << " " << tolerance;
        EXPECT_EQ(report.non_finite_vertices, 0u);
        EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4) << by << " " << tolerance;
      }
    }
}

TEST(Weld, DegreesMayDiffer) {
  for (const auto& body : {closed_body(), sphere()})
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const PatchSet set = set_of(shaken(elevated(body, seed), 1e-9, seed));
      const MeshReport report = good(check(welded_mesh(set, 0.01, 1e-7)));
      EXPECT_TRUE(report.closed()) << seed << ": " << report.open_edges << " open";
      EXPECT_EQ(report.degenerate_triangles, 0u);
      EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4);
    }
}

TEST(Weld, DoesNothingWhereBitsMeet) {
  for (const auto& body : {closed_body(), sphere()}) {
    const PatchSet set = set_of(body);
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.01, .joining = {.weld = 1e-6}}));
    EXPECT_EQ(plan.welded_borders(), 0u);
    const Mesh exact = welded_mesh(set, 0.01, 0), welded = mesh_of(set, plan);
    EXPECT_EQ(exact.positions, welded.positions);
    EXPECT_EQ(exact.normals, welded.normals);
    EXPECT_EQ(exact.indices, welded.indices);
  }
}

/// Points of the patches over each triangle stay within the bound, though borders are moved by a third of it.
TEST(Weld, TheBoundsKnowHowFarVerticesAreMoved) {
  Random random(3);
  for (const auto& body : {closed_body(), sphere()}) {
    const double by = 3e-3;
    const PatchSet set = set_of(shaken(body, by, 5));
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.03, .joining = {.weld = 4 * by}}));
    const Tessellation apart = good(Tessellation::make(set, {.tolerance = 0.03}));
    const Mesh mesh = mesh_of(set, plan);
    double most = 0, share = 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::uint32_t* k = &mesh.indices[3 * t];
      const auto vertex = [&](int c) {
        return mesh.origin + Vec3{mesh.positions[3 * k[c]], mesh.positions[3 * k[c] + 1], mesh.positions[3 * k[c] + 2]};
      };
      const BezierPatch& patch = set.patch(mesh.patches[t]);
      double nearest = 1e300;
      for (int c = 0; c < 3; ++c) {
        const Vec3 own = de_casteljau(patch, mesh.parameters[2 * k[c]], mesh.parameters[2 * k[c] + 1]);
        most = std::max(most, length(own - vertex(c)));
        nearest = std::min(nearest, length(own - vertex(c)));
      }
      for (int sample = 0; sample < 6; ++sample) {
        double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const auto mixed = [&](std::size_t c) {
          return (1 - a - b) * double(mesh.parameters[2 * k[0] + c]) + a * double(mesh.parameters[2 * k[1] + c]) +
                 b * double(mesh.parameters[2 * k[2] + c]);
        };
        const double distance =
            distance_to_triangle(de_casteljau(patch, mixed(0), mixed(1)), vertex(0), vertex(1), vertex(2));
        share = std::max(share, distance / double(plan.bounds()[mesh.patches[t]]));
      }
    }
    EXPECT_LE(share, 1);
    EXPECT_GE(share, 0.2);
    EXPECT_GE(most, by);  // vertices are moved
    EXPECT_LE(most, 4 * by);
    EXPECT_GE(*std::min_element(plan.bounds().begin(), plan.bounds().end()), by);
    EXPECT_GT(plan.welded_borders(), 0u);
    EXPECT_EQ(apart.welded_borders(), 0u);
  }
}

TEST(Weld, PolesThatAreNearlyPointsCountAsPoints) {
  std::vector<BezierPatch> patches;
  Random random(9);
  for (const BezierPatch& patch : sphere()) {  // the poles alone are spread
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (std::size_t j = 6; j < 9; ++j) points[j] = points[j] + 1e-7 * uniform_vector(random, -1, 1);
    patches.push_back(good(patch.with_points(points)));
  }
  const PatchSet set = set_of(patches);
  ASSERT_FALSE(set.patch(0).collapsed_sides().any());
  const Mesh apart = welded_mesh(set, 0.01, 0), mesh = welded_mesh(set, 0.01, 1e-6);
  EXPECT_GT(apart.triangle_count(), mesh.triangle_count());
  EXPECT_EQ(good(check(mesh)).degenerate_triangles, 0u);
  EXPECT_TRUE(good(check(mesh)).closed());
  EXPECT_EQ(2 * good(check(mesh)).distinct_positions, mesh.triangle_count() + 4);
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const Vec3 p{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
    const Vec3 n{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
    EXPECT_GE(std::abs(dot(n, mesh.origin + p)), 1 - 1e-5) << k;  // of the unit sphere: at its poles too
  }
}

TEST(Weld, FartherBordersAreLeftApart) {
  const std::vector<BezierPatch> field = wavy_field(2, 2);
  std::vector<BezierPatch> patches;
  for (std::size_t k = 0; k < field.size(); ++k)
    patches.push_back(placed({field[k]}, 1, {0, 0, k == 3 ? 0.01 : 0.0})[0]);
  const PatchSet set = set_of(patches);
  EXPECT_EQ(good(Tessellation::make(set, {.tolerance = 0.1, .joining = {.weld = 0.0099}})).welded_borders(), 0u);
  EXPECT_EQ(good(Tessellation::make(set, {.tolerance = 0.1, .joining = {.weld = 0.0101}})).welded_borders(), 2u);
  const MeshReport report = good(check(welded_mesh(set, 0.05, 0.0101)));
  EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);  // a disc
}

/// A polynomial arc of degree 3 as a rational one of degree 4 with weights that are all 1/3: the same curve.
TEST(Weld, PolynomialAndRationalBordersOfOneCurveMeet) {
  const std::vector<BezierPatch> field = wavy_field(1, 2);
  const BezierPatch raised = good(elevate_degree(field[1], 4, 3));
  std::vector<double> weights(raised.points().size(), 1.0 / 3);
  for (std::size_t k = 3; k < weights.size(); k += 4) weights[k] = 0.5;  // of the far border
  const PatchSet set = set_of({field[0], rational(4, 3, {raised.points().begin(), raised.points().end()}, weights)});
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 1e-3, .joining = {.weld = 1e-9}}));
  EXPECT_EQ(plan.welded_borders(), 1u);
  const MeshReport report = good(check(mesh_of(set, plan)));
  EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);
}

TEST(Weld, RunsAgainAfterAnEdit) {
  PatchSet set = set_of(shaken(closed_body(), 1e-6, 2));
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.02, .joining = {.weld = 1e-5}}));
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    std::vector<Vec3> points(set.patch(k).points().begin(), set.patch(k).points().end());
    for (Vec3& p : points) p.x *= 1.25;
    ASSERT_TRUE(set.set_control_points(k, points).ok());
  }
  EXPECT_TRUE(good(check(mesh_of(set, plan))).closed());
}

TEST(Weld, WrongLengthsAreRefused) {
  const PatchSet set = set_of(closed_body());
  for (const double weld : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto plan = Tessellation::make(set, {.tolerance = 0.1, .joining = {.weld = weld}});
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.status().message().find("it must be finite and at least 0"), std::string::npos);
  }
  // Moved further than the tolerance permits.
  const PatchSet apart = set_of(shaken(closed_body(), 0.01, 1));
  const auto plan = Tessellation::make(apart, {.tolerance = 0.005, .joining = {.weld = 0.04}});
  ASSERT_FALSE(plan.ok());
  EXPECT_NE(plan.status().message().find("the displacement of welded float vertices"), std::string::npos)
      << plan.status().message();
  for (const double weld : {0.5, 1e300}) {
    const auto plan_of_all = Tessellation::make(apart, {.tolerance = 0.05, .joining = {.weld = weld}});
    ASSERT_FALSE(plan_of_all.ok());
    EXPECT_NE(plan_of_all.status().message().find("a twentieth of the model's size"), std::string::npos);
  }
  for (const double weld : {1e-300, 5e-324})
    EXPECT_TRUE(Tessellation::make(apart, {.tolerance = 0.05, .joining = {.weld = weld}}).ok());
}

TEST(SideCurve, TheDistanceBoundIsNotExceeded) {
  Random random(4);
  double tightest = 0;
  for (int kind = 0; kind < 300; ++kind) {
    const int m = 1 + static_cast<int>(random() % 5);
    const BezierPatch patch = kind % 2 ? random_rational(random, m, 2, 0.3, 3) : random_polynomial(random, m, 2);
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    std::vector<double> weights(points.size(), 1);
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = points[k] + 0.1 * uniform_vector(random, -1, 1);
      weights[k] = 7 * patch.weight(static_cast<int>(k) / 3, static_cast<int>(k) % 3) *
                   (kind % 4 == 3 ? uniform(random, 0.9, 1.1) : 1);
    }
    const BezierPatch raised =
        good(elevate_degree(kind % 2 ? rational(m, 2, points, weights) : polynomial(m, 2, points), m + kind % 3, 2));
    const bool reversed = kind % 5 == 0;
    const BezierPatch other = reversed ? good(reverse_u(raised)) : raised;
    const double bound = distance_bound(SideCurve(patch, Side::v0), SideCurve(other, Side::v0), reversed);
    double most = 0;
    for (int k = 0; k <= 50; ++k)
      most = std::max(
          most, length(de_casteljau(patch, k / 50.0, 0) - de_casteljau(other, (reversed ? 50 - k : k) / 50.0, 0)));
    EXPECT_LE(most, bound * (1 + 1e-12)) << kind;
    tightest = std::max(tightest, most / bound);
  }
  EXPECT_GE(tightest, 0.9);
}

}}  // namespace tessera::test
