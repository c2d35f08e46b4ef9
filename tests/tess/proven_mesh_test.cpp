// Meshes that keep a tolerance: no crack, no point further away than the bound, the same bytes for any number of
// threads.

#include "tessera/tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <oneapi/tbb/global_control.h>

#include "support/synthetic_sets.h"
#include "support/triangle_distance.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

Tessellation proven_mesh_plan_of(const PatchSet& set, double tolerance) {
  return good(Tessellation::make(set, {.tolerance = tolerance}));
}

Vec3 proven_mesh_vertex(const Mesh& mesh, std::size_t k) {
  return mesh.origin + Vec3{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
}

/// The largest distance found, over the patch's bound: of `samples` points of the patch over each triangle.
double proven_over_bound(const PatchSet& set, const Tessellation& plan, const Mesh& mesh, int samples) {
  Random random(11);
  double most = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* k = &mesh.indices[3 * t];
    const BezierPatch& patch = set.patch(mesh.patches[t]);
    const auto parameter = [&](int corner, std::size_t c) { return double(mesh.parameters[2 * k[corner] + c]); };
    for (int sample = 0; sample < samples; ++sample) {
      double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      if (sample == 0) a = b = 1.0 / 3;
      if (sample == 1) a = b = 0.5;
      const auto mixed = [&](std::size_t c) {
        return parameter(0, c) + a * (parameter(1, c) - parameter(0, c)) + b * (parameter(2, c) - parameter(0, c));
      };
      const Vec3 p = de_casteljau(patch, mixed(0), mixed(1));
      const double distance = distance_to_triangle(p, proven_mesh_vertex(mesh, k[0]), proven_mesh_vertex(mesh, k[1]),
                                                   proven_mesh_vertex(mesh, k[2]));
      most = std::max(most, distance / double(plan.bounds()[mesh.patches[t]]));
    }
  }
  return most;
}

std::vector<BezierPatch> proven_mesh_turned(std::vector<BezierPatch> patches, std::uint64_t seed) {
  Random random(seed);
  for (BezierPatch& patch : patches) patch = reoriented(patch, static_cast<int>(random() % 8));
  return patches;
}

TEST(ProvenMesh, ClosedBodiesStayClosedAtEveryTolerance) {
  for (const auto& body :
       {closed_body(), sphere(), placed(closed_body(), 1e-6, {}), placed(sphere(), 1e5, {3e5, -1e5, 7e4})})
    for (int seed = 0; seed < 3; ++seed) {
      const PatchSet set = set_of(proven_mesh_turned(body, static_cast<std::uint64_t>(seed)));
      double largest = 0;
      for (const double relative : {0.5, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5}) {
        const double tolerance = relative * set.box().diagonal();
        const Tessellation plan = proven_mesh_plan_of(set, tolerance);
        EXPECT_LE(plan.bound(), tolerance * (1 + 1e-6));
        EXPECT_EQ(plan.bound(), *std::max_element(plan.bounds().begin(), plan.bounds().end()));
        const Mesh mesh = mesh_of(set, plan);
        const MeshReport report = good(check(mesh));
        EXPECT_EQ(report.open_edges, 0u) << relative;
        EXPECT_EQ(report.non_manifold_edges, 0u) << relative;
        EXPECT_EQ(report.degenerate_triangles, 0u) << relative;
        EXPECT_EQ(report.non_finite_vertices, 0u);
        EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4);
        if (relative >= 1e-3) largest = std::max(largest, proven_over_bound(set, plan, mesh, 8));
      }
      EXPECT_LE(largest, 1);
      EXPECT_GE(largest, 0.2);
    }
}

TEST(ProvenMesh, RatesThatDifferMeetWithoutACrack) {
  // Waves that grow along u: each column has rates of its own.
  std::vector<BezierPatch> patches;
  for (const BezierPatch& patch : wavy_field(8, 6)) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p.z *= std::exp(p.x - 5);
    patches.push_back(polynomial(3, 3, points));
  }
  const PatchSet set = set_of(proven_mesh_turned(patches, 3));
  for (const double tolerance : {0.3, 0.05, 0.01, 1e-3, 1e-4}) {
    const Tessellation plan = proven_mesh_plan_of(set, tolerance);
    const Mesh mesh = mesh_of(set, plan);
    const MeshReport report = good(check(mesh));
    EXPECT_EQ(report.degenerate_triangles, 0u);
    EXPECT_EQ(report.inconsistent_edges > 0, true);  // the patches are turned
    // A disc: vertices - edges + triangles = 1, and 3 triangles = 2 edges - open edges.
    EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2) << tolerance;
    EXPECT_LE(proven_over_bound(set, plan, mesh, 6), 1);
  }
}

TEST(ProvenMesh, RandomSetsKeepTheirBounds) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const PatchSet set = set_of(mixed_patches(seed, 30));
    for (const double tolerance : {0.3, 0.03}) {
      const Tessellation plan = proven_mesh_plan_of(set, tolerance);
      const Mesh mesh = mesh_of(set, plan);
      EXPECT_EQ(good(check(mesh)).degenerate_triangles, 0u);
      EXPECT_LE(proven_over_bound(set, plan, mesh, 5), 1);
    }
  }
}

TEST(ProvenMesh, TheSameBytesForAnyNumberOfThreads) {
  const PatchSet set = set_of(mixed_patches(4, 300));
  const Tessellation plan = proven_mesh_plan_of(set, 0.05);
  Mesh first;
  for (const std::size_t threads : {1u, 2u, 8u}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    const Mesh mesh = mesh_of(set, proven_mesh_plan_of(set, 0.05));
    if (threads == 1) first = mesh;
    EXPECT_EQ(mesh.positions, first.positions);
    EXPECT_EQ(mesh.normals, first.normals);
    EXPECT_EQ(mesh.indices, first.indices);
  }
}

TEST(ProvenMesh, ABudgetGivesTheSmallestTolerance) {
  const PatchSet set = set_of(wavy_field(6, 6));
  for (const std::uint64_t budget : {72u, 100u, 1000u, 50000u}) {
    const Tessellation plan = good(Tessellation::make(set, {.budget = budget}));
    EXPECT_LE(plan.capacity().triangles, budget);
    const auto finer = Tessellation::make(set, {.tolerance = plan.bound() / 1.05, .max_triangles = budget});
    EXPECT_TRUE(budget <= 100 || !finer.ok()) << budget;
  }
  const auto few = Tessellation::make(set, {.budget = 71});
  ASSERT_FALSE(few.ok());
  EXPECT_NE(few.status().message().find("the budget is 71 triangles, and the mesh takes at least 72"),
            std::string::npos)
      << few.status().message();
}

TEST(ProvenMesh, ARelativeToleranceIsOfTheSize) {
  const PatchSet small = set_of(closed_body()), large = set_of(placed(closed_body(), 0x1p20, {}));
  for (const double relative : {0.1, 1e-3}) {
    const Mesh a = mesh_of(small, good(Tessellation::make(small, {.tolerance = relative, .relative = true})));
    const Mesh b = mesh_of(large, good(Tessellation::make(large, {.tolerance = relative, .relative = true})));
    EXPECT_EQ(a.indices, b.indices);
  }
}

TEST(ProvenMesh, RunsAgainAfterAnEdit) {
  PatchSet set = set_of(closed_body());
  const Tessellation plan = proven_mesh_plan_of(set, 0.01);
  const Mesh before = mesh_of(set, plan);
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    std::vector<Vec3> points(set.patch(k).points().begin(), set.patch(k).points().end());
    for (Vec3& p : points) p.x *= 1.25;
    ASSERT_TRUE(set.set_control_points(k, points).ok());
  }
  const Mesh after = mesh_of(set, plan);
  EXPECT_EQ(after.indices, before.indices);
  EXPECT_NE(after.positions, before.positions);
  EXPECT_TRUE(good(check(after)).closed());
}

struct Refusal {
  double tolerance;
  const char* message;
};

TEST(ProvenMesh, RefusesWhatItCannotKeep) {
  const PatchSet set = set_of(closed_body());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double tolerance : {0.0, -1.0, std::nan(""), infinity}) {
    const auto plan = Tessellation::make(set, {.tolerance = tolerance});
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument);
    EXPECT_NE(plan.status().message().find("it must be finite and above 0"), std::string::npos);
  }
  const auto rough = Tessellation::make(set, {.tolerance = 1e-9});
  ASSERT_FALSE(rough.ok());
  EXPECT_EQ(rough.status().index(), 0);
  EXPECT_NE(rough.status().message().find(", the rounding of float vertices of patch 0"), std::string::npos)
      << rough.status().message();
  const auto many = Tessellation::make(set, {.tolerance = 1e-4, .max_triangles = 1000});
  ASSERT_FALSE(many.ok());
  EXPECT_NE(many.status().message().find("the limits are 1000 and 4294967296"), std::string::npos)
      << many.status().message();
  const auto fitted = PatchSet::make(closed_body(), PatchSetOptions{.fit_error = {0.01, true}});
  EXPECT_FALSE(Tessellation::make(*fitted, {.tolerance = 0.01}).ok());
  EXPECT_GT(good(Tessellation::make(*fitted, {.tolerance = 0.011})).bound(), 0.01);
}

TEST(ProvenMesh, WritesNothingIntoShortViews) {
  const PatchSet set = set_of(closed_body());
  const Tessellation plan = proven_mesh_plan_of(set, 0.05);
  Mesh mesh = good(plan.allocate());
  MeshViews views = mesh.views();
  views.indices = views.indices.first(views.indices.size() - 1);
  EXPECT_EQ(plan.run(set, views).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(plan.run(set_of(sphere()), mesh.views()).code(), StatusCode::stale);
  EXPECT_TRUE(std::all_of(mesh.positions.begin(), mesh.positions.end(), [](float x) { return x == 0; }));
}

}}  // namespace tessera::test
