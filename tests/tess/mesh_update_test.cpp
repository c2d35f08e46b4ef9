// Updates of certified meshes: the same bytes as a mesh of the edited set with the same rates, nothing else written,
// and bounds that hold for the edited patches.

#include "tessera/tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <oneapi/tbb/global_control.h>

#include "support/allocations.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/tessellate_support.h"

namespace tessera::test {
namespace {

/// New points for some patches.
struct Edits {
  std::vector<std::uint32_t> patch;
  std::vector<Vec3> points;

  operator PatchEdits() const { return {patch, points}; }
};

/// Edits of every step-th patch: `move` moves each point.
template <class Move>
Edits moved(const PatchSet& set, std::size_t step, Move move) {
  Edits edits;
  for (std::size_t k = 0; k < set.patch_count(); k += step) {
    edits.patch.push_back(static_cast<std::uint32_t>(k));
    for (const Vec3& p : set.patch(k).points()) edits.points.push_back(move(p));
  }
  return edits;
}
Edits swollen(const PatchSet& set, std::size_t step, double by) {
  return moved(set, step, [by](const Vec3& p) { return Vec3{p.x + by * std::sin(p.y), p.y, p.z * (1 + by)}; });
}

struct Animated {
  PatchSet set;
  MeshUpdate update;
  Mesh mesh;

  Animated(const std::vector<BezierPatch>& patches, const CertifiedOptions& options)
      : set(set_of(patches)), update(good(MeshUpdate::make(set, good(CertifiedTessellation::make(set, options))))) {
    mesh = mesh_of(set, update.plan());
  }
  void run(const Edits& edits, const Execution& execution = {}) {
    const Status status = update.run(set, edits, mesh.views(), execution);
    ASSERT_TRUE(status.ok()) << status.message();
  }
  void expect_as_anew() {
    const Mesh anew = mesh_of(set, update.plan());
    EXPECT_EQ(mesh.positions, anew.positions);
    EXPECT_EQ(mesh.normals, anew.normals);
    EXPECT_EQ(mesh.indices, anew.indices);
    EXPECT_EQ(mesh.parameters, anew.parameters);
  }
};

enum class Shared { nothing, vertices, normals, both };

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

TEST(MeshUpdate, TheSameBytesAsAMeshWrittenAnew) {
  for (const Stores stores : {Stores::plain, Stores::streaming})
    for (const std::size_t threads : {1u, 3u}) {
      const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      for (const auto& patches : {wavy_field(23, 17), mixed_patches(3, 200), sphere(), torn_field(9, 7)})
        for (const Shared shared : {Shared::nothing, Shared::vertices, Shared::normals, Shared::both}) {
          CertifiedOptions options{.tolerance = 0.01, .weld = 1e-4};
          options.share_vertices = shared == Shared::vertices || shared == Shared::both;
          if (shared == Shared::normals || shared == Shared::both) options.crease_angle = 0.2;
          Animated body(patches, options);
          for (const std::size_t step : {1u, 2u, 7u, 100u}) {
            const std::uint64_t revision = body.set.revision();
            body.run(swollen(body.set, step, 0.02), {.stores = stores});
            EXPECT_EQ(body.set.revision(), revision + 1);
            body.expect_as_anew();
          }
        }
    }
}

TEST(MeshUpdate, QuadsStay) {
  for (const bool share : {false, true}) {
    Animated body(wavy_field(9, 9), {.tolerance = 0.003, .share_vertices = share});
    const auto written = [&] {
      Mesh mesh = good(body.update.plan().allocate_quads());
      EXPECT_TRUE(body.update.plan().run(body.set, mesh.views()).ok());
      return mesh;
    };
    body.mesh = written();
    const Mesh before = body.mesh;
    ASSERT_GT(before.quad_count(), 100u);
    body.run(swollen(body.set, 3, 0.05));
    const Mesh anew = written();
    EXPECT_NE(body.mesh.positions, before.positions);
    EXPECT_EQ(body.mesh.positions, anew.positions);
    EXPECT_EQ(body.mesh.normals, anew.normals);
    EXPECT_EQ(body.mesh.quads, before.quads);
    EXPECT_EQ(anew.quads, before.quads);
    EXPECT_EQ(body.mesh.indices, before.indices);
  }
}

TEST(MeshUpdate, OtherRecordsAreNotTouched) {
  Animated body(wavy_field(9, 9), {.tolerance = 0.003});
  const std::vector<float> before = body.mesh.positions;
  const Edits edits = swollen(body.set, 5, 0.1);
  const std::vector<std::uint32_t> patches = body.mesh.patches, indices = body.mesh.indices;
  // Arrays that an update must not write do not exist.
  MeshViews views;
  views.position = View3<float>::interleaved(body.mesh.positions);
  ASSERT_TRUE(body.update.run(body.set, edits, views).ok());
  for (std::size_t t = 0; t < patches.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t vertex = indices[3 * t + c];
      const bool same =
          std::equal(before.begin() + std::ptrdiff_t(3 * vertex), before.begin() + std::ptrdiff_t(3 * vertex + 3),
                     body.mesh.positions.begin() + std::ptrdiff_t(3 * vertex));
      EXPECT_TRUE(same || patches[t] % 5 == 0);
    }
}

TEST(MeshUpdate, WeldedNeighboursFollow) {
  Animated body(torn_field(4, 4), {.tolerance = 0.01, .weld = 1e-4});
  ASSERT_GT(body.update.plan().welded_borders(), 0u);
  body.run(moved(body.set, 3, [](const Vec3& p) { return p + Vec3{0, 0, 2e-5}; }));
  body.expect_as_anew();
  const MeshReport report = good(check(body.mesh));
  EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);  // a disc still
}

/// The largest distance from any patch to its part of the mesh, over its bound. `apart`: a mesh of the same triangles
/// whose vertices have the parameters of their own patch.
double found_over_bound(const Animated& body, const Mesh& apart) {
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
    most = std::max(most, low / double(body.update.bounds()[patch]));
  }
  return most;
}

double found_over_bound(const Animated& body) { return found_over_bound(body, body.mesh); }

TEST(MeshUpdate, RestatedBoundsHold) {
  for (const auto& patches : {wavy_field(5, 4), sphere(), torn_field(3, 3)}) {
    Animated body(patches, {.tolerance = 0.02, .weld = 1e-4});
    const std::vector<float> planned(body.update.bounds().begin(), body.update.bounds().end());
    EXPECT_TRUE(std::ranges::equal(planned, body.update.plan().bounds()));
    for (const double by : {-0.5, 0.3, 3.0}) {
      body.run(moved(body.set, 2, [by](const Vec3& p) { return Vec3{p.x, p.y, p.z * (1 + by)}; }));
      ASSERT_TRUE(body.update.restate(body.set).ok());
      EXPECT_LE(found_over_bound(body), 1);
      EXPECT_EQ(body.update.bound(), *std::ranges::max_element(body.update.bounds()));
      const auto above =
          std::ranges::count_if(body.update.bounds(), [](float bound) { return bound > 0.02f * 1.0001f; });
      EXPECT_EQ(body.update.unproven(), std::size_t(above));
    }
    EXPECT_GT(body.update.unproven(), 0u);
  }
}

TEST(MeshUpdate, BoundsHoldWhereSharedBordersPart) {
  // One patch leaves its neighbours; vertices that it shares remain with them.
  Animated body(wavy_field(3, 3), {.tolerance = 0.02, .share_vertices = true});
  const Mesh apart = mesh_of(body.set, good(CertifiedTessellation::make(body.set, {.tolerance = 0.02})));
  const auto lifted = [&](double by) {
    Edits edits;
    edits.patch = {4};
    for (const Vec3& p : body.set.patch(4).points()) edits.points.push_back(p + Vec3{0, 0, by});
    return edits;
  };
  body.run(lifted(0));
  ASSERT_TRUE(body.update.restate(body.set).ok());
  EXPECT_EQ(body.update.unproven(), 0u);
  body.run(lifted(0.3));
  ASSERT_TRUE(body.update.restate(body.set).ok());
  EXPECT_GE(body.update.unproven(), 1u);
  EXPECT_GE(body.update.bounds()[4], 0.3f);
  EXPECT_LE(found_over_bound(body, apart), 1);
}

TEST(MeshUpdate, BoundsOfPatchesThatStayAreThoseOfThePlan) {
  Animated body(wavy_field(8, 8), {.tolerance = 0.004});
  body.run(moved(body.set, 1, [](const Vec3& p) { return p + Vec3{0, 0, 0}; }));
  ASSERT_TRUE(body.update.restate(body.set).ok());
  for (std::size_t k = 0; k < body.set.patch_count(); ++k)
    EXPECT_NEAR(body.update.bounds()[k], body.update.plan().bounds()[k], 1e-5 * body.update.plan().bounds()[k]);
  EXPECT_EQ(body.update.unproven(), 0u);
}

TEST(MeshUpdate, AnglesAndPixelsAreNotKnownUntilRetessellated) {
  Animated body(wavy_field(4, 4), {.tolerance = 0.05, .angle = 0.2});
  body.run(moved(body.set, 4, [](const Vec3& p) { return p; }));
  ASSERT_TRUE(body.update.restate(body.set).ok());
  EXPECT_EQ(body.update.unproven(), 4u);
  EXPECT_EQ(good(body.update.retessellate(body.set)), 0u);
  EXPECT_EQ(body.update.unproven(), 0u);
}

TEST(MeshUpdate, RetessellatingChangesOnlyWhatItMust) {
  Animated body(wavy_field(12, 12), {.tolerance = 0.003});
  const std::vector<std::uint32_t> indices = body.mesh.indices;
  // A little movement changes no rates, although others would now be the best for some.
  body.run(moved(body.set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, p.z * 0.97}; }));
  EXPECT_EQ(good(body.update.retessellate(body.set)), 0u);
  EXPECT_EQ(mesh_of(body.set, body.update.plan()).indices, indices);
  EXPECT_GT(good(CertifiedTessellation::make(body.set, {.tolerance = 0.003})).divided_otherwise(body.update.plan()),
            0u);
  // One patch that bulges needs other rates, and so do its neighbours' borders with it.
  Edits one = moved(body.set, 1000, [](const Vec3& p) { return p; });
  for (const std::size_t k : {5u, 6u, 9u, 10u}) one.points[k].z += 0.5;
  body.run(one);
  ASSERT_TRUE(body.update.restate(body.set).ok());
  EXPECT_EQ(body.update.unproven(), 1u);
  const std::size_t changed = good(body.update.retessellate(body.set));
  EXPECT_GE(changed, 1u);
  EXPECT_LE(changed, 3u);
  EXPECT_LE(body.update.bound(), 0.003 * (1 + 1e-6));
  body.mesh = mesh_of(body.set, body.update.plan());
  const MeshReport report = good(check(body.mesh));
  EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);
  body.run(swollen(body.set, 3, 0.01));
  body.expect_as_anew();
}

TEST(MeshUpdate, RatesThatCostTooMuchAreGivenUp) {
  const CertifiedOptions options{.tolerance = 0.003};
  Animated body(wavy_field(6, 6), options);
  body.run(moved(body.set, 1, [](const Vec3& p) { return Vec3{p.x, p.y, p.z * 0.1}; }));
  EXPECT_GT(good(body.update.retessellate(body.set)), 30u);
  const std::size_t least = good(CertifiedTessellation::make(body.set, options)).capacity().triangles;
  EXPECT_LE(double(body.update.plan().capacity().triangles), 1.25 * double(least));
}

TEST(MeshUpdate, SparedRatesGiveWayWhereTrianglesRunOut) {
  const PatchSet set = set_of(wavy_field(8, 6));
  CertifiedOptions options{.tolerance = 0.003};
  const std::size_t budget = options.max_triangles =
      good(CertifiedTessellation::make(set, options)).capacity().triangles;
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
  std::vector<BezierPatch> patches = wavy_field(8, 6);
  for (BezierPatch& patch : patches) {  // rough at one end, smooth at the other
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p.z *= p.x < 2 ? 1.3 : 0.2;
    patch = polynomial(3, 3, points);
  }
  const CertifiedTessellation next = good(plan.retessellate(set_of(patches), 1e6));
  EXPECT_LE(next.capacity().triangles, budget);
  EXPECT_LE(next.bound(), 0.003 * (1 + 1e-6));
  options.max_triangles = 1u << 30;
  EXPECT_GT(
      good(good(CertifiedTessellation::make(set, options)).retessellate(set_of(patches), 1e6)).capacity().triangles,
      budget);
}

TEST(MeshUpdate, BadEditsAreRefusedBeforeAnythingIsWritten) {
  Animated body(mixed_patches(7, 40), {.tolerance = 0.05});
  const Mesh before = body.mesh;
  const auto refused = [&](const Edits& edits, StatusCode code, std::ptrdiff_t index) {
    const Status status = body.update.run(body.set, edits, body.mesh.views());
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.index(), index);
    EXPECT_EQ(body.mesh.positions, before.positions);
    EXPECT_EQ(body.set.revision(), 0u);
  };
  const Edits fine = swollen(body.set, 3, 0.1);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    Edits edits = fine;
    edits.points.back().y = bad;
    refused(edits, StatusCode::non_finite, std::ptrdiff_t(edits.patch.size()) - 1);
  }
  Edits edits = fine;
  edits.patch[3] = 40;
  refused(edits, StatusCode::invalid_argument, 3);
  edits.patch[3] = edits.patch[1];
  refused(edits, StatusCode::invalid_argument, 3);
  edits = fine;
  edits.points.pop_back();
  refused(edits, StatusCode::count_mismatch, -1);
  edits = moved(body.set, 1, [](const Vec3&) { return Vec3{1, 2, 3}; });  // all become points
  refused(edits, StatusCode::stale, 0);
  MeshViews views = body.mesh.views();
  views.position.size -= 1;
  EXPECT_EQ(body.update.run(body.set, fine, views).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(body.update.run(body.set, fine, {}).code(), StatusCode::invalid_argument);
  PatchSet other = set_of(wavy_field(2, 2));
  EXPECT_EQ(body.update.run(other, {}, body.mesh.views()).code(), StatusCode::stale);
  body.run(fine);
  body.run({});
  EXPECT_EQ(body.set.revision(), 1u);
}

TEST(MeshUpdate, EditsByOtherMeansAreNoticed) {
  Animated body(wavy_field(3, 3), {.tolerance = 0.01});
  const std::vector<Vec3> points(body.set.patch(4).points().begin(), body.set.patch(4).points().end());
  ASSERT_TRUE(body.set.set_control_points(4, points).ok());
  EXPECT_EQ(body.update.run(body.set, swollen(body.set, 2, 0.1), body.mesh.views()).code(), StatusCode::stale);
  EXPECT_EQ(body.update.restate(body.set).code(), StatusCode::stale);
  EXPECT_EQ(MeshUpdate::make(body.set, good(body.update.plan().retessellate(set_of(wavy_field(3, 3))))).status().code(),
            StatusCode::stale);
  EXPECT_EQ(good(body.update.retessellate(body.set)), 9u);
  body.run(swollen(body.set, 2, 0.1));
  EXPECT_EQ(body.update.retessellate(set_of(wavy_field(2, 3))).status().code(), StatusCode::stale);
  EXPECT_EQ(body.update.retessellate(body.set, std::nan("")).status().code(), StatusCode::invalid_argument);
}

TEST(MeshUpdate, NothingIsAllocatedAfterTheFirst) {
  for (const auto& patches : {mixed_patches(2, 300), wavy_field(20, 20), torn_field(8, 8)}) {
    Animated body(patches, {.tolerance = 0.02, .weld = 1e-4});
    const Edits all = swollen(body.set, 1, 0.01), some = swollen(body.set, 9, 0.02);
    const MeshViews views = body.mesh.views();
    for (int warm_up = 0; warm_up < 20; ++warm_up) {
      body.run(all);
      ASSERT_TRUE(body.update.restate(body.set).ok());
    }
    const std::size_t before = allocation_count();
    EXPECT_GT(before, 0u);
    for (int k = 0; k < 5; ++k) {
      ASSERT_TRUE(body.update.run(body.set, all, views).ok());
      ASSERT_TRUE(body.update.run(body.set, some, views).ok());
      ASSERT_TRUE(body.update.restate(body.set).ok());
    }
    EXPECT_EQ(allocation_count(), before);
  }
}

}  // namespace
}  // namespace tessera::test
