// No patch of an area vanishes: where opposite borders are points, or welding makes them points, triangles remain, or
// those of a neighbour lie where the patch is.

#include <algorithm>
#include <cmath>

#include "support/sampled_distance.h"
#include "support/synthetic_sets.h"
#include "tess/followed_mesh.h"

namespace tessera::test { namespace {

/// Expects that each surface lies within its bound of the mesh.
void expect_within_bounds(const PatchSet& set, const Tessellation& plan, const Mesh& mesh, const std::string& what) {
  const SampledMesh sampled(mesh, set.patch_count(), false);
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j) {
        const double bound = double(plan.bounds()[k]) * (1 + 1e-6);
        ASSERT_LE(sampled.distance(de_casteljau(set.patch(k), i / 8.0, j / 8.0), k, bound), bound)
            << what << ": patch " << k << " at " << i << ", " << j;
      }
}
Mesh checked_mesh(const std::vector<BezierPatch>& patches, const TessellationOptions& options,
                  const std::string& what) {
  const PatchSet set = set_of(patches);
  const Tessellation plan = good(Tessellation::make(set, options));
  const Mesh mesh = mesh_of(set, plan);
  expect_within_bounds(set, plan, mesh, what);
  return mesh;
}

/// A flat strip from x = 0 to 1, `width` wide.
BezierPatch strip(double width, double z = 0) {
  return polynomial(1, 1, {{0, 0, z}, {0, width, z}, {1, 0, z}, {1, width, z}});
}
/// A patch between two points that bulges by `height` to both sides.
BezierPatch lens(double height) {
  return polynomial(2, 2,
                    {{0, 0, 0},
                     {0, 0, 0},
                     {0, 0, 0},
                     {1, -height, 0},
                     {1, 0, height},
                     {1, height, 0},
                     {2, 0, 0},
                     {2, 0, 0},
                     {2, 0, 0}});
}

TEST(VanishingPatch, NeedlesKeepTheirShortBorders) {
  for (const double width : {3e-6, 1e-7, 3e-3}) {
    const TessellationOptions options{.tolerance = 1e-3,
                                      .joining = {.weld = width > 1e-3 ? std::optional(0.01) : std::nullopt}};
    if (width < 1e-3) {
      EXPECT_EQ(checked_mesh({strip(width)}, options, "alone").triangle_count(), 2u);
      EXPECT_EQ(checked_mesh({strip(width), strip(1, 5)}, options, "beside another").triangle_count(), 4u);
    }
    // End to end: neither neighbour has triangles along the other's long borders.
    std::vector<BezierPatch> row;
    for (int k = 0; k < 4; ++k) row.push_back(placed({strip(width)}, 1, {double(k), 0, 0})[0]);
    const TessellationOptions loose{.tolerance = 0.1, .joining = {.weld = options.joining.weld}};
    EXPECT_EQ(checked_mesh(row, loose, "a row").triangle_count(), 8u) << width;
  }
}

TEST(VanishingPatch, SpotsKeepTheirBorders) {
  const std::vector<BezierPatch> spot = placed({strip(1)}, 1e-3, {3, 3, 3});
  EXPECT_EQ(
      checked_mesh({spot[0], strip(1)}, {.tolerance = 0.02, .joining = {.weld = 0.01}}, "a spot").triangle_count(), 4u);
}

/// A needle between two patches is the edge that they have in common.
TEST(VanishingPatch, NeedlesBetweenOthersClose) {
  const double width = 1e-7;
  const BezierPatch below = polynomial(1, 1, {{0, -1, 0}, {0, 0, 0}, {1, -1, 0}, {1, 0, 0}}),
                    above = polynomial(1, 1, {{0, width, 0}, {0, 1, 0}, {1, width, 0}, {1, 1, 0}});
  const Mesh mesh = checked_mesh({below, strip(width), above}, {.tolerance = 1e-3}, "between");
  EXPECT_EQ(mesh.triangle_count(), 4u);
  const MeshReport report = good(check(mesh));
  EXPECT_EQ(report.open_edges, 6u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
}

TEST(VanishingPatch, PatchesBetweenTwoPointsHaveTriangles) {
  for (const double height : {0.5, 0.1, 1e-3})
    for (const double tolerance : {10.0, 1.0, 0.05})
      for (const bool turned : {false, true}) {
        const BezierPatch patch = turned ? transposed(lens(height)) : lens(height);
        const Mesh mesh = checked_mesh({patch}, {.tolerance = tolerance}, "a lens");
        EXPECT_GE(mesh.triangle_count(), 2u);
        EXPECT_EQ(good(check(mesh)).degenerate_triangles, 0u);
      }
}

TEST(VanishingPatch, BubblesFromOnePointHaveTriangles) {
  std::vector<Vec3> points(16);
  points[5] = {1, 0, 1}, points[6] = {0, 1, 1}, points[9] = {0, -1, 1}, points[10] = {-1, 0, 1};
  for (const double tolerance : {10.0, 0.3, 0.05}) {
    const Mesh mesh = checked_mesh({polynomial(3, 3, points)}, {.tolerance = tolerance}, "a bubble");
    EXPECT_GE(mesh.triangle_count(), 8u);
  }
}

/// Where the neighbour that stands for a needle leaves it, the needle gets triangles.
TEST(VanishingPatch, EditsLeaveNothingBehind) {
  for (const bool shares : {false, true}) {
    const std::vector<BezierPatch> patches{
        lens(1e-3), polynomial(2, 1, {{0, 0, 0}, {0, 2, 0}, {1, 1e-3, 0}, {1, 2, 0}, {2, 0, 0}, {2, 2, 0}})};
    Animated body(patches, {.tolerance = 0.1, .joining = {.share_vertices = shares}});
    EXPECT_EQ(body.mesh.triangle_count(), 2u);
    expect_within_bounds(body.set, body.plan, body.mesh, "as made");
    Edits away = moved(body.set, 1, [](const Vec3& p) { return p; });
    for (std::size_t k = 9; k < away.points.size(); ++k) away.points[k].z += 3;
    EXPECT_TRUE(body.run(away).topology);
    EXPECT_GE(body.mesh.triangle_count(), 4u);
    expect_within_bounds(body.set, body.plan, body.mesh, "moved away");
  }
}

}}  // namespace tessera::test
