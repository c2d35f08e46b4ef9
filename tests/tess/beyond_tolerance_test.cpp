// Patches that cannot keep a tolerance: they do not refuse the mesh of the others, and their bounds say what they keep.

#include <cmath>

#include "tess/far_parts.h"
#include "tessera/tessellate.h"

namespace tessera::test { namespace {

/// Expects a plan whose patches from `first` on are beyond the tolerance, and no others.
void expect_beyond(const PatchSet& set, const Tessellation& plan, std::size_t first, double tolerance) {
  std::vector<std::uint32_t> wanted;
  for (std::size_t k = first; k < set.patch_count(); ++k) wanted.push_back(static_cast<std::uint32_t>(k));
  EXPECT_TRUE(std::ranges::equal(plan.patches_beyond_tolerance(), wanted));
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    EXPECT_EQ(plan.bounds()[k] <= tolerance * (1 + 1e-6), k < first) << k;
}

std::vector<BezierPatch> joined(std::vector<BezierPatch> patches, const std::vector<BezierPatch>& others) {
  patches.insert(patches.end(), others.begin(), others.end());
  return patches;
}

/// Float positions do not hold the tolerance where the second body lies.
TEST(BeyondTolerance, RoundingCostsItsPatchesAlone) {
  for (const auto& body : {sphere(), closed_body()})
    for (const bool fewest : {false, true}) {
      const PatchSet set =
          good(PatchSet::make(joined(body, placed(body, 1, {1e6, 2e5, 0})), PatchSetOptions{.origin = Vec3{}}));
      TessellationOptions options{.tolerance = 1e-3};
      options.fewest = fewest;
      const Tessellation plan = good(Tessellation::make(set, options));
      expect_beyond(set, plan, body.size(), 1e-3);
      EXPECT_LT(plan.bound(), 0.2);  // a unit in the last place at 1e6 is 0.06
      const Mesh mesh = mesh_of(set, plan);
      expect_closed(mesh);
      expect_bounds(set, mesh, plan.bounds());
      EXPECT_EQ(tessera::tessellate(set, options).status().index(), static_cast<std::ptrdiff_t>(body.size()));
      options.precision = Precision::double_precision;
      EXPECT_TRUE(good(Tessellation::make(set, options)).patches_beyond_tolerance().empty());
    }
}

/// A quarter of a cylinder so large that 4096 segments along it keep no more than 0.02.
TEST(BeyondTolerance, TheLimitOfSegmentsCostsItsPatchesAlone) {
  const std::vector<BezierPatch> small = cylinder(1, 1);
  const PatchSet set = set_of(joined(small, cylinder(1e6, 1)));
  const Tessellation plan =
      good(Tessellation::make(set, {.tolerance = 1e-3, .precision = Precision::double_precision}));
  expect_beyond(set, plan, small.size(), 1e-3);
  EXPECT_LT(plan.bound(), 0.05);
  EXPECT_LT(plan.capacity().triangles, 100000u);
  expect_bounds(set, mesh_of(set, plan), plan.bounds(), 1);
}

TEST(BeyondTolerance, AnglesAndPixelsAreExceededAsWell) {
  const std::vector<BezierPatch> flat{polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}})};
  const PatchSet turned = set_of(joined(flat, cylinder(1, 1)));
  const Tessellation plan = good(Tessellation::make(turned, {.angle = 1e-4}));
  EXPECT_EQ(plan.patches_beyond_tolerance().size(), 4u);
  EXPECT_GT(plan.angle(), 1e-4);
  EXPECT_LT(plan.angle(), 8e-4);
  const PatchSet far =
      good(PatchSet::make(joined(sphere(), placed(sphere(), 1, {1e7, 0, 0})), PatchSetOptions{.origin = Vec3{}}));
  View view;
  view.eye = {1e7, 0, 9}, view.target = {1e7, 0, 0};
  const Tessellation seen = good(Tessellation::make(far, {.pixels = PixelTolerance{0.5, view}}));
  EXPECT_EQ(seen.patches_beyond_tolerance().size(), 8u);
  EXPECT_GT(seen.pixels(), 0.5);
}

/// Nothing of a mesh would be as wanted.
TEST(BeyondTolerance, AToleranceThatNoPatchKeepsIsRefused) {
  const auto refused = Tessellation::make(set_of(sphere()), {.tolerance = 1e-12});
  EXPECT_EQ(refused.status().code(), StatusCode::invalid_argument);
  EXPECT_NE(refused.status().message().find(" is enough"), std::string::npos) << refused.status().message();
}

TEST(BeyondTolerance, UpdatesPlanAsFreshPlansDo) {
  PatchSet set =
      good(PatchSet::make(joined(sphere(), placed(sphere(), 1, {1e6, 0, 0})), PatchSetOptions{.origin = Vec3{}}));
  Tessellation plan = good(Tessellation::make(set, {.tolerance = 1e-3}));
  Mesh mesh = mesh_of(set, plan);
  for (const double x : {1e6 + 3, 4.0, 1e6}) {  // the second body comes back to where floats serve, and leaves again
    std::vector<std::uint32_t> patches;
    std::vector<Vec3> points;
    const std::vector<BezierPatch> moved = placed(sphere(), 1, {x, 0, 0});
    for (std::uint32_t k = 0; k < 8; ++k) {
      patches.push_back(8 + k);
      points.insert(points.end(), moved[k].points().begin(), moved[k].points().end());
    }
    const MeshChange change = good(plan.update(set, PatchEdits{patches, points}, mesh.views()));
    if (change.topology) mesh = mesh_of(set, plan);
    expect_beyond(set, plan, x > 100 ? 8 : 16, 1e-3);
    const Tessellation fresh = good(Tessellation::make(set, {.tolerance = 1e-3}));
    EXPECT_TRUE(std::ranges::equal(fresh.patches_beyond_tolerance(), plan.patches_beyond_tolerance())) << x;
    expect_bounds(set, mesh, plan.bounds());
  }
}

}}  // namespace tessera::test
