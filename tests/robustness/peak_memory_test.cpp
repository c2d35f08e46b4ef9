// Every operation keeps to the memory that its header states.

#include <gtest/gtest.h>

#include "robustness/scene.h"
#include "support/allocations.h"
#include "support/borders.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

/// Checks the most memory that call() holds at a time besides its result, divided by `count`: at most `bytes`; and the
/// memory of the result: at most `kept_bytes`. The first call may take memory that remains: threads' own, or tables.
template <class Call>
void expect_at_most(const char* name, double bytes, std::size_t count, Call&& call, double kept_bytes = 1e9) {
  (void)call();
  const std::size_t before = restart_peak();
  [[maybe_unused]] const auto result = call();
  const std::size_t peak = peak_bytes(), kept = restart_peak();
  const auto each = [&](std::size_t held) { return static_cast<double>(held) / static_cast<double>(count); };
  std::printf("%-40s %9.1f bytes each beside the result, %8.1f for it\n", name, each(peak - kept), each(kept - before));
  EXPECT_LE(each(peak - kept), bytes) << name;
  EXPECT_LE(each(kept - before), kept_bytes) << name;
}

class PeakMemory : public ::testing::Test {
 protected:
  std::vector<BezierPatch> patches_ = wavy_field(60, 50);
  PatchSet set_ = set_of(patches_);
  std::size_t count_ = patches_.size();
};

TEST_F(PeakMemory, Sets) {
  expect_at_most("PatchSet::make", 64, count_, [&] { return set_of(patches_); });
  PatchSetOptions with;
  with.blocks.float_points = true;
  expect_at_most("PatchSet::make, with points", 64, count_, [&] { return set_of(patches_, with); });
  const BSplineSurface surface = [&] {
    Random random(3);
    return random_surface(random, 3, 3, {.inner = 50}, {.inner = 50}, false);
  }();
  expect_at_most("to_bezier(BSplineSurface)", 128, 51 * 51, [&] { return value_of(to_bezier(surface)); });
  expect_at_most(
      "SurfaceMap::make", 8, count_, [&] { return value_of(SurfaceMap::make(set_)); }, 128);
}

TEST_F(PeakMemory, Evaluation) {
  const std::vector<double> t = uniform_parameters(17);
  expect_at_most("GridPlan::make", 64, 17 + 17, [&] { return value_of(GridPlan::make(set_, t, t)); });
  const GridPlan plan = value_of(GridPlan::make(set_, t, t));
  AllBuffers<float> out(plan);
  expect_at_most("evaluate(set, plan)", 0, 1, [&] { return evaluate(set_, plan, out.views()); });
  expect_at_most(
      "GridUpdate::make", 8, count_, [&] { return value_of(GridUpdate::make(set_)); }, 16);
  const PatchSet points = set_of(patches_, with_points());
  Random random(4);
  const Samples<float> samples = random_samples<float>(random, count_, 100000);
  AllBuffers<float> values(samples.size());
  expect_at_most("evaluate(set, samples)", 0, 1, [&] { return evaluate(points, samples.views(), values.views()); });
}

TEST_F(PeakMemory, Meshes) {
  const auto uniform = [&] { return value_of(Tessellation::make(set_, {.rates = UniformRates{}})); };
  expect_at_most(
      "Tessellation::make", 8, count_, [&] { return uniform(); }, 24);
  const Tessellation plan = uniform();
  Mesh mesh = value_of(plan.allocate());
  expect_at_most("Tessellation::run", 0, 1, [&] { return plan.run(set_, mesh.views()); });
  expect_at_most("check(mesh)", 40, mesh.triangle_count(), [&] { return value_of(check(mesh)); });
  const auto certified = [&] { return value_of(Tessellation::make(set_, {.tolerance = 0.01})); };
  expect_at_most(
      "Tessellation::make, from a tolerance", 1024, count_, [&] { return certified(); }, 256);
  Mesh fine = value_of(certified().allocate());
  const std::vector<Vec3> points(set_.patch(7).points().begin(), set_.patch(7).points().end());
  const std::uint32_t patch = 7;
  expect_at_most(
      "Tessellation::update", 1024, count_,
      [&] {
        PatchSet set = set_of(patches_);
        Tessellation followed = certified();
        EXPECT_FALSE(value_of(followed.update(set_, {std::span(&patch, 1), points}, fine.views())).topology);
        return followed;
      },
      512);
}

#ifdef TESSERA_HAS_RAY
TEST_F(PeakMemory, Rays) {
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    expect_at_most("RayScene::make", 128, count_, [&] { return value_of(RayScene::make(set_, {.mode = mode})); });
    const RayScene scene = value_of(RayScene::make(set_, {.mode = mode}));
    const std::vector<Ray> rays = rays_at(set_, 20000);
    std::vector<Hit> hits(rays.size());
    expect_at_most("closest", 4096, 1, [&] { return scene.closest(rays, hits); });
    if (mode == RayMode::grid) continue;
    expect_at_most("all", sizeof(Hit) + 16, rays.size(), [&] {
      HitLists lists;
      EXPECT_TRUE(scene.all(rays, lists).ok());
      return lists;
    });
  }
}
#endif

}}  // namespace tessera::test
