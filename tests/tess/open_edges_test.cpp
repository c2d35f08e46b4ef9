// The weld that plans have by default, and the edges that stay open.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/synthetic_sets.h"
#include "tess/shaken.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// A flat rectangle.
BezierPatch rectangle(const Vec3& corner, const Vec3& along_u, const Vec3& along_v) {
  return polynomial(1, 1, {corner, corner + along_v, corner + along_u, corner + along_u + along_v});
}

MeshReport open_edges_report_of(const PatchSet& set, const TessellationOptions& options) {
  const Tessellation plan = good(Tessellation::make(set, options));
  const MeshReport report = good(check(mesh_of(set, plan)));
  EXPECT_EQ(plan.open_edges(), report.open_edges);
  EXPECT_LE(plan.bound(), plan.tolerance());
  return report;
}

TEST(OpenEdges, AreThoseOfTheMesh) {
  for (const double tolerance : {0.3, 0.03, 0.003}) {
    EXPECT_GT(open_edges_report_of(set_of(wavy_field(3, 5)), {.tolerance = tolerance}).open_edges, 0u);
    EXPECT_EQ(open_edges_report_of(set_of(sphere()), {.tolerance = tolerance}).open_edges, 0u);
    EXPECT_EQ(open_edges_report_of(set_of(closed_body()), {.tolerance = tolerance}).open_edges, 0u);
    open_edges_report_of(set_of(mixed_patches(9, 40)), {.tolerance = tolerance});
    open_edges_report_of(set_of(wavy_field(3, 5)), {.tolerance = tolerance, .fewest = true});
    open_edges_report_of(set_of(wavy_field(3, 5)),
                         {.tolerance = tolerance, .angle = 0.2, .joining = {.share_vertices = true}});
    const PatchSet torn = set_of(shaken(wavy_field(4, 4), 1e-3, 3));
    EXPECT_GT(open_edges_report_of(torn, {.tolerance = tolerance, .joining = {.weld = 0}}).open_edges,
              open_edges_report_of(torn, {.tolerance = tolerance, .joining = {.weld = 0.01}}).open_edges);
  }
}

TEST(OpenEdges, AreClosedByDefaultWhereBordersLieNearerThanAnEighthOfTheTolerance) {
  for (const auto& body : {closed_body(), sphere()})
    for (const double by : {1e-15, 1e-9, 1e-5, 1e-3}) {
      const PatchSet set = set_of(shaken(body, by, 7));
      for (const double tolerance : {0.5, 0.1, 0.04}) {
        const MeshReport report = open_edges_report_of(set, {.tolerance = tolerance});
        // The sphere's poles are points only up to the rounding of six digits.
        if (body.size() != sphere().size() || by < 1e-8) {
          EXPECT_EQ(report.open_edges, 0u) << by << ' ' << tolerance;
        }
        EXPECT_EQ(report.degenerate_triangles, 0u);
      }
    }
  const auto gap = [](double width) {
    return set_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), rectangle({1 + width, 0, 0}, {1, 0, 0.3}, {0, 1, 0})});
  };
  EXPECT_EQ(open_edges_report_of(gap(0.0124), {.tolerance = 0.1}).open_edges, 6u);
  EXPECT_EQ(open_edges_report_of(gap(0.0126), {.tolerance = 0.1}).open_edges, 8u);
  EXPECT_EQ(open_edges_report_of(gap(1e-7), {.tolerance = 0.1, .joining = {.weld = 0}}).open_edges, 8u);
  EXPECT_EQ(open_edges_report_of(gap(1e-7), {.angle = 0.1}).open_edges, 6u);
}

/// Small parts are joined only where they lie near for their own size, whatever the tolerance.
TEST(OpenEdges, OfPartsSmallerThanTheWeldStay) {
  std::vector<BezierPatch> patches = closed_body();
  const double size = 0.01;
  for (const double x : {3.0, 3.0 + 1.5 * size}) patches.push_back(rectangle({x, 0, 0}, {size, 0, 0}, {0, size, 0}));
  const MeshReport report = open_edges_report_of(set_of(patches), {.tolerance = 0.2});
  EXPECT_EQ(report.open_edges, 8u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
}

TEST(OpenEdges, OfThreeBordersThatNearlyCoincideAreJoinedToOne) {
  const double d = 1e-5;
  const PatchSet set = set_of({rectangle({0, 0, 0}, {-1, 0, 0}, {0, 1, 0}), rectangle({d, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                               rectangle({0, 0, d}, {0, 0, 1}, {0, 1, 0})});
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.01}));
  EXPECT_EQ(plan.welded_borders(), 2u);
  const MeshReport report = good(check(mesh_of(set, plan)));
  EXPECT_EQ(report.open_edges, 9u);
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_EQ(plan.open_edges(), 9u);
}

TEST(OpenEdges, OfAStripThinnerThanTheWeldStayItsOwn) {
  const double width = 1e-3;
  const BezierPatch strip = rectangle({0, 0, 0}, {1, 0, 0}, {0, width, 0});
  EXPECT_EQ(open_edges_report_of(set_of({strip}), {.tolerance = 0.1}).open_edges, 4u);
  // Between neighbours whose borders lie nearer than the strip is wide.
  const PatchSet set = set_of(
      {strip, rectangle({0, -1e-6, 0}, {1, 0, 0}, {0, -1, 0}), rectangle({0, width + 1e-6, 0}, {1, 0, 0}, {0, 1, 0})});
  const MeshReport report = open_edges_report_of(set, {.tolerance = 0.1});
  EXPECT_EQ(report.open_edges, 8u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  // At the rim of a larger patch.
  const PatchSet rim = set_of({rectangle({0, 0, 0}, {1, 0, 0}, {0, -1, 0}), strip});
  EXPECT_EQ(open_edges_report_of(rim, {.tolerance = 0.1}).open_edges, 6u);
  EXPECT_EQ(open_edges_report_of(rim, {.tolerance = 0.1, .joining = {.weld = 2 * width}}).degenerate_triangles, 0u);
}

/// The vertices of each patch are the same bytes whatever the order of the patches and whatever else the set has.
TEST(Weld, DependsOnTheBordersAlone) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<BezierPatch> patches = shaken(wavy_field(4, 3), 1e-4, 11 + static_cast<std::uint64_t>(trial));
    std::vector<std::size_t> order(patches.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<BezierPatch> others{rectangle({50, 0, 0}, {1, 0, 0}, {0, 1, 0})};
    for (const std::size_t k : order) others.push_back(patches[k]);
    const auto vertices = [](const std::vector<BezierPatch>& all) {
      const PatchSet set = good(PatchSet::make(all, {.origin = Vec3{}}));
      const Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.02})));
      std::vector<std::vector<std::array<float, 3>>> of_patch(all.size());
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
          const float* p = &mesh.positions[3 * mesh.indices[3 * t + c]];
          of_patch[mesh.patches[t]].push_back({p[0], p[1], p[2]});
        }
      return of_patch;
    };
    const auto ours = vertices(patches), theirs = vertices(others);
    for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(ours[order[k]], theirs[k + 1]) << trial;
  }
}

}}  // namespace tessera::test
