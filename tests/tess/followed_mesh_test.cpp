// Meshes that follow edits: the same bytes as a mesh that is written anew, nothing else written, bounds that hold for
// the edited patches, and another topology where it must be.

#include "tessera/tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <oneapi/tbb/global_control.h>

#include "support/allocations.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/followed_mesh.h"

namespace tessera::test { namespace {

/// Whether a mesh is a disc whose patches meet without cracks, by Euler's formula.
bool is_disc(const Mesh& mesh) {
  const MeshReport report = good(check(mesh));
  return 2 * report.distinct_positions == report.triangles + report.open_edges + 2;
}

/// A field whose patches are moved by rounding, so that they meet by welding alone.
std::vector<BezierPatch> torn_field(int rows, int columns) {
  Random random(5);
  std::vector<BezierPatch> patches;
  for (const BezierPatch& patch : wavy_field(rows, columns)) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = p + uniform_vector(random, -1e-5, 1e-5);
    patches.push_back(polynomial(3, 3, points));
  }
  return patches;
}

/// Options that share nothing, vertices, normals, or both; and rates.
std::vector<TessellationOptions> kinds_of_plans(double tolerance) {
  std::vector<TessellationOptions> all;
  for (const bool vertices : {false, true})
    for (const bool normals : {false, true}) {
      TessellationOptions options{.tolerance = tolerance, .joining = {.weld = 1e-4, .share_vertices = vertices}};
      if (normals) options.joining.crease_angle = 0.2;
      all.push_back(options);
    }
  all.push_back({.rates = UniformRates{5, 4}});
  return all;
}

TEST(FollowedMesh, TheSameBytesAsAMeshWrittenAnew) {
  std::size_t kept = 0, changed = 0;
  for (const Stores stores : {Stores::plain, Stores::streaming})
    for (const std::size_t threads : {1u, 3u}) {
      const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      for (const auto& patches : {wavy_field(23, 17), mixed_patches(3, 200), sphere(), torn_field(9, 7)})
        for (const TessellationOptions& options : kinds_of_plans(0.01)) {
          Animated body(patches, options);
          for (const auto& [step, by] :
               {std::pair{1u, 0.02}, {2u, 1e-5}, {7u, 1e-5}, {7u, 0.02}, {100u, 0.02}, {100u, 1e-4}}) {
            const std::uint64_t revision = body.set.revision();
            ++(body.run(swollen(body.set, step, by), {.stores = stores}).topology ? changed : kept);
            EXPECT_EQ(body.set.revision(), revision + 1);
            body.expect_as_anew();
          }
        }
    }
  EXPECT_GT(kept, 100u);
  EXPECT_GT(changed, 50u);
}

TEST(FollowedMesh, QuadsStay) {
  for (TessellationOptions options : kinds_of_plans(0.003)) {
    options.quads = true;
    options.spare = 10;
    Animated body(wavy_field(9, 9), options);
    const Mesh before = body.mesh;
    ASSERT_GT(before.quad_count(), 100u);
    EXPECT_FALSE(body.run(moved(body.set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, 0.99 * p.z}; })).topology);
    EXPECT_NE(body.mesh.positions, before.positions);
    body.expect_as_anew();
    EXPECT_EQ(body.mesh.quads, before.quads);
    EXPECT_EQ(mesh_of(body.set, body.plan).quads, before.quads);
    EXPECT_EQ(body.mesh.indices, before.indices);
  }
}

TEST(FollowedMesh, OtherRecordsAreNotTouched) {
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.003}, TessellationOptions{.rates = UniformRates{5, 4}}}) {
    Animated body(wavy_field(9, 9), options);
    const std::vector<float> before = body.mesh.positions;
    const std::vector<std::uint32_t> patches = body.mesh.patches, indices = body.mesh.indices;
    // Arrays that an update must not write do not exist.
    MeshViews views;
    views.position = View3<float>::interleaved(body.mesh.positions);
    const Edits edits = moved(body.set, 5, [](const Vec3& p) { return p + Vec3{0, 0, 0.25}; });
    ASSERT_FALSE(good(body.plan.update(body.set, edits, views)).topology);
    std::size_t same_corners = 0;
    for (std::size_t t = 0; t < patches.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t vertex = indices[3 * t + c];
        const bool same =
            std::equal(before.begin() + std::ptrdiff_t(3 * vertex), before.begin() + std::ptrdiff_t(3 * vertex + 3),
                       body.mesh.positions.begin() + std::ptrdiff_t(3 * vertex));
        EXPECT_EQ(same, patches[t] % 5 != 0);
        same_corners += same;
      }
    EXPECT_GT(same_corners, patches.size());
  }
}

TEST(FollowedMesh, WeldedNeighboursFollow) {
  Animated body(torn_field(4, 4), {.tolerance = 0.01, .joining = {.weld = 1e-4}});
  ASSERT_GT(body.plan.welded_borders(), 0u);
  body.run(moved(body.set, 3, [](const Vec3& p) { return p + Vec3{0, 0, 2e-5}; }));
  body.expect_as_anew();
  EXPECT_TRUE(is_disc(body.mesh));
}

/// The largest distance from any patch to its part of the mesh, over its bound. `apart`: a mesh of the same triangles
/// whose vertices have the parameters of their own patch.
double followed_over_bound(const Animated& body, const Mesh& apart) {
  double most = 0;
  for (std::size_t t = 0; t < body.mesh.triangle_count(); ++t) {
    MeshTriangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t k = body.mesh.indices[3 * t + c];
      const std::size_t own = apart.indices[3 * t + c];
      triangle.parameters[c] = {apart.parameters[2 * own], apart.parameters[2 * own + 1]};
      triangle.corners[c] = body.mesh.origin + Vec3{body.mesh.positions[3 * k], body.mesh.positions[3 * k + 1],
                                                    body.mesh.positions[3 * k + 2]};
    }
    const std::size_t patch = body.mesh.patches[t];
    const double low = largest_distance(body.set.patch(patch), triangle, 0.1, 100).low;
    most = std::max(most, low / double(body.plan.bounds()[patch]));
  }
  return most;
}

TEST(FollowedMesh, NewBoundsHold) {
  std::size_t changed = 0;
  for (const auto& patches : {wavy_field(5, 4), sphere(), torn_field(3, 3)}) {
    Animated body(patches, {.tolerance = 0.02, .joining = {.weld = 1e-4}});
    for (const double by : {0.001, -0.5, 0.3, 3.0}) {
      changed += body.run(moved(body.set, 2, [by](const Vec3& p) { return Vec3{p.x, p.y, p.z * (1 + by)}; })).topology;
      EXPECT_LE(followed_over_bound(body, body.mesh), 1);
      EXPECT_EQ(body.plan.bound(), double(*std::ranges::max_element(body.plan.bounds())));
      EXPECT_LE(body.plan.bound(), 0.02 * (1 + 1e-6));
    }
  }
  EXPECT_GT(changed, 3u);
}

TEST(FollowedMesh, SharedVerticesPartWithTheirBorders) {
  // One patch leaves its neighbours; vertices that it shares remain with them as long as the tolerance allows it.
  Animated body(wavy_field(3, 3), {.tolerance = 0.02, .joining = {.share_vertices = true}});
  const Mesh apart = mesh_of(body.set, good(Tessellation::make(body.set, {.tolerance = 0.02})));
  const auto lifted = [&](double by) {
    Edits edits;
    edits.patch = {4};
    for (const Vec3& p : body.set.patch(4).points()) edits.points.push_back(p + Vec3{0, 0, by});
    return edits;
  };
  EXPECT_FALSE(body.run(lifted(0)).topology);
  const double room = 0.02 - body.plan.bound();
  ASSERT_GT(room, 1e-5);
  EXPECT_FALSE(body.run(lifted(0.9 * room)).topology);
  EXPECT_GE(double(body.plan.bounds()[4]), 0.9 * room);
  EXPECT_LE(followed_over_bound(body, apart), 1);
  const std::size_t together = body.mesh.vertex_count();
  EXPECT_TRUE(body.run(lifted(0.3)).topology);
  EXPECT_GT(body.mesh.vertex_count(), together);
  EXPECT_LE(body.plan.bound(), 0.02 * (1 + 1e-6));
}

TEST(FollowedMesh, BoundsOfPatchesThatStayAreThoseOfThePlan) {
  Animated body(wavy_field(8, 8), {.tolerance = 0.004});
  const std::vector<float> planned(body.plan.bounds().begin(), body.plan.bounds().end());
  EXPECT_FALSE(body.run(moved(body.set, 1, [](const Vec3& p) { return p; })).topology);
  for (std::size_t k = 0; k < body.set.patch_count(); ++k)
    EXPECT_NEAR(body.plan.bounds()[k], planned[k], 1e-5 * planned[k]);
}

TEST(FollowedMesh, AnglesAndPixelsAreProvenAgain) {
  const View view{.eye = {8, -12, 8}, .target = {3, 3, 0}};
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.05, .angle = 0.2}, TessellationOptions{.pixels = PixelTolerance{1, view}},
        TessellationOptions{.angle = 0.3, .pixels = PixelTolerance{2, view}, .joining = {.weld = 1e-6}}}) {
    Animated body(wavy_field(6, 6), options);
    for (const double by : {1.0, 1.001, 0.5, 4.0}) {
      const MeshChange change = body.run(moved(body.set, 4, [by](const Vec3& p) { return Vec3{p.x, p.y, p.z * by}; }));
      EXPECT_TRUE(by != 1.0 || !change.topology);
      EXPECT_TRUE(by != 4.0 || change.topology);
      const Tessellation fresh = good(Tessellation::make(body.set, options));
      for (std::size_t k = 0; k < body.set.patch_count(); ++k) {
        EXPECT_TRUE(!options.angle || body.plan.angles()[k] <= *options.angle * (1 + 1e-6));
        EXPECT_TRUE(!options.pixels || body.plan.pixel_bounds()[k] <= options.pixels->pixels * (1 + 1e-6));
      }
      EXPECT_EQ(body.plan.patches_without_angle(), fresh.patches_without_angle());
      body.expect_as_anew();
    }
  }
}

TEST(FollowedMesh, ChangesOnlyWhatItMust) {
  Animated body(wavy_field(12, 12), {.tolerance = 0.003});
  const std::vector<std::uint32_t> indices = body.mesh.indices;
  // A little movement changes no rates, although others would now be the best for some.
  EXPECT_FALSE(body.run(moved(body.set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, p.z * 0.97}; })).topology);
  EXPECT_EQ(mesh_of(body.set, body.plan).indices, indices);
  EXPECT_LT(good(Tessellation::make(body.set, {.tolerance = 0.003})).capacity().triangles, indices.size() / 3);
  // One patch that bulges needs other rates, and so do its neighbours' borders with it.
  Edits one = moved(body.set, 1000, [](const Vec3& p) { return p; });
  for (const std::size_t k : {5u, 6u, 9u, 10u}) one.points[k].z += 0.5;
  const MeshChange change = body.run(one);
  EXPECT_GE(change.patches, 1u);
  EXPECT_LE(change.patches, 3u);
  EXPECT_LE(body.plan.bound(), 0.003 * (1 + 1e-6));
  EXPECT_TRUE(is_disc(body.mesh));
  body.run(swollen(body.set, 3, 0.01));
  body.expect_as_anew();
}

TEST(FollowedMesh, RatesThatCostTooMuchAreGivenUp) {
  const TessellationOptions options{.tolerance = 0.003};
  Animated body(wavy_field(6, 6), options);
  EXPECT_GT(body.run(moved(body.set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, p.z * 0.1}; })).patches, 30u);
  const std::size_t least = good(Tessellation::make(body.set, options)).capacity().triangles;
  EXPECT_LE(double(body.plan.capacity().triangles), 1.25 * double(least));
}

/// Rough at one end, smooth at the other.
Edits uneven(const PatchSet& set) {
  return moved(set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, p.z * (p.x < 2 ? 1.3 : 0.2)}; });
}

TEST(FollowedMesh, SparedRatesGiveWayWhereTrianglesRunOut) {
  TessellationOptions options{.tolerance = 0.003, .spare = 1e6};
  Animated free(wavy_field(8, 6), options);
  const std::size_t budget = options.max_triangles = free.plan.capacity().triangles;
  Animated body(wavy_field(8, 6), options);
  EXPECT_TRUE(body.run(uneven(body.set)).topology);
  EXPECT_LE(body.plan.capacity().triangles, budget);
  EXPECT_LE(body.plan.bound(), 0.003 * (1 + 1e-6));
  EXPECT_TRUE(free.run(uneven(free.set)).topology);
  EXPECT_GT(free.plan.capacity().triangles, budget);
}

TEST(FollowedMesh, CollapsedBordersAreAnotherTopology) {
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.02}, TessellationOptions{.rates = UniformRates{4, 4}, .quads = true}}) {
    Animated body(wavy_field(3, 3), options);
    const std::size_t faces = body.mesh.triangle_count() + body.mesh.quad_count();
    const Edits back = moved(body.set, 100, [](const Vec3& p) { return p; });
    Edits pole = back;
    for (std::size_t j = 1; j < 4; ++j) pole.points[j] = pole.points[0];
    EXPECT_TRUE(body.run(pole).topology);
    EXPECT_EQ(good(check(body.mesh)).degenerate_triangles, 0u);
    body.expect_as_anew();
    EXPECT_TRUE(body.run(back).topology);
    EXPECT_EQ(body.mesh.triangle_count() + body.mesh.quad_count(), faces);
    EXPECT_EQ(good(check(body.mesh)).degenerate_triangles, 0u);
  }
}

TEST(FollowedMesh, EditsByOtherMeansAreFollowed) {
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.01},
        TessellationOptions{.tolerance = 0.01, .joining = {.share_vertices = true}},
        TessellationOptions{.rates = UniformRates{4, 4}}})
    for (const bool first : {true, false}) {
      Animated body(wavy_field(4, 4), options);
      if (!first) body.run(swollen(body.set, 3, 1e-5));
      std::vector<Vec3> points(body.set.patch(5).points().begin(), body.set.patch(5).points().end());
      for (const std::size_t k : {5u, 6u, 9u, 10u}) points[k].z += 1e-4;
      ASSERT_TRUE(body.set.set_control_points(5, points).ok());
      body.run(swollen(body.set, 7, 1e-5));
      body.expect_as_anew();
      for (const std::size_t k : {5u, 6u, 9u, 10u}) points[k].z += 1;
      ASSERT_TRUE(body.set.set_control_points(5, points).ok());
      EXPECT_EQ(body.run({}).topology, options.tolerance.has_value());
      body.expect_as_anew();
      EXPECT_TRUE(!options.tolerance || body.plan.bound() <= 0.01 * (1 + 1e-6));
    }
}

TEST(FollowedMesh, NothingIsAllocatedAfterTheFirst) {
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.02, .joining = {.weld = 1e-4}, .spare = 10},
        TessellationOptions{.rates = UniformRates{}}})
    for (const auto& patches : {mixed_patches(2, 300), wavy_field(20, 20), torn_field(8, 8)}) {
      Animated body(patches, options);
      const Edits all = moved(body.set, 1, [](const Vec3&p) { return 0.995 * p; }),
                  some = moved(body.set, 9, [](const Vec3&p) { return 0.995 * p; });
      const auto update = [&](const Edits& edits) {
        const auto change = body.plan.update(body.set, edits, body.mesh.views());
        ASSERT_TRUE(change.ok() && !change->topology) << change.status().message();
      };
      for (int warm_up = 0; warm_up < 20; ++warm_up) update(all);
      const std::size_t before = allocation_count();
      EXPECT_GT(before, 0u);
      for (int k = 0; k < 5; ++k) {
        update(all);
        update(some);
      }
      EXPECT_EQ(allocation_count(), before);
    }
}

}}  // namespace tessera::test
