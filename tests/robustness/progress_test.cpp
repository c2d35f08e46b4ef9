// The progress of long calls rises from 0 to 1, once.

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "robustness/scene.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

/// Runs call(execution), which must succeed, and checks its reports.
template <class Call>
void rises_once(const char* name, const Call& call) {
  std::vector<double> shares;
  const Status status = call(Execution{.progress = [&](double share) { shares.push_back(share); }});
  ASSERT_TRUE(status.ok()) << name << ": " << status.message();
  ASSERT_FALSE(shares.empty()) << name;
  EXPECT_GT(shares.front(), 0) << name;
  for (std::size_t k = 1; k < shares.size(); ++k) EXPECT_LT(shares[k - 1], shares[k]) << name << ", report " << k;
  EXPECT_EQ(shares.back(), 1) << name;
}

class Progress : public ::testing::Test {
 protected:
  PatchSet set_ = set_of(various_patches(40), with_points());
};

TEST_F(Progress, Evaluation) {
  const auto t = uniform_parameters(9);
  const GridPlan plan = value_of(GridPlan::make(set_, t, t));
  const GridBuffers<float> room(plan);
  rises_once("grid", [&](const Execution& execution) {
    GridBuffers<float> out = room;
    return evaluate(set_, plan, out.views(), execution);
  });
  Random random(4);
  const Samples<float> samples = random_samples<float>(random, set_.patch_count(), 20000);
  std::vector<float> out(3 * samples.size());
  rises_once("points", [&](const Execution& execution) {
    return evaluate(set_, samples.views(), QuantityViews<float>{.position = View3<float>::interleaved(out)}, {},
                    execution);
  });
}

TEST_F(Progress, Meshes) {
  const Tessellation uniform = value_of(Tessellation::make(set_, {.rates = UniformRates{}}));
  Mesh mesh = value_of(uniform.allocate());
  rises_once("uniform mesh", [&](const Execution& execution) { return uniform.run(set_, mesh.views(), execution); });
  const auto plans = [&](const char* name, const TessellationOptions& options) {
    rises_once(name, [&](const Execution& execution) { return Tessellation::make(set_, options, execution).status(); });
  };
  plans("plan by length", {.tolerance = 2e-3});
  plans("plan by angle", {.angle = 0.3});
  plans("plan by both", {.tolerance = 2e-3, .angle = 0.3});
  plans("fewest", {.tolerance = 2e-3, .fewest = true});
  plans("finest for a budget", {.budget = 100000});
  Tessellation certified = value_of(Tessellation::make(set_, {.tolerance = 2e-3}));
  Mesh fine = value_of(certified.allocate());
  rises_once("mesh", [&](const Execution& execution) { return certified.run(set_, fine.views(), execution); });
}

TEST_F(Progress, Updates) {
  Tessellation plan = value_of(Tessellation::make(set_, {.tolerance = 2e-3}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set_, mesh.views()).ok());
  std::vector<std::uint32_t> patches(set_.patch_count());
  std::iota(patches.begin(), patches.end(), 0u);
  std::vector<Vec3> points;
  for (const std::uint32_t k : patches)
    for (const Vec3& p : set_.patch(k).points()) points.push_back(p + Vec3{0, 0, 1e-4});
  const auto follow = [&](const char* name, bool topology) {
    rises_once(name, [&](const Execution& execution) {
      const auto change = plan.update(set_, {patches, points}, mesh.views(), execution);
      EXPECT_EQ(change.ok() && change->topology, topology) << name;
      return change.status();
    });
  };
  follow("mesh update", false);
  for (Vec3& p : points) p.z *= 3;
  follow("other topology", true);
  mesh = value_of(plan.allocate());
  rises_once("nothing to follow", [&](const Execution& execution) {
    return plan.update(set_, PatchEdits{}, mesh.views(), execution).status();
  });
}

#ifdef TESSERA_HAS_RAY
TEST_F(Progress, Rays) {
  const std::vector<Ray> rays = rays_at(set_, 20000);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    rises_once("scene",
               [&](const Execution& execution) { return RayScene::make(set_, {.mode = mode}, execution).status(); });
    RayScene scene = value_of(RayScene::make(set_, {.mode = mode}));
    rises_once("closest", [&](const Execution& execution) { return scene.closest(rays, hits, execution); });
    rises_once("occluded", [&](const Execution& execution) { return scene.occluded(rays, occluded, execution); });
    rises_once("closest of no rays", [&](const Execution& execution) { return scene.closest({}, {}, execution); });
    rises_once("rebuild", [&](const Execution& execution) { return scene.rebuild(execution); });
    rises_once("nothing to refit", [&](const Execution& execution) { return scene.refit(execution); });
    const std::vector<Vec3> points(set_.patch(0).points().begin(), set_.patch(0).points().end());
    ASSERT_TRUE(set_.set_control_points(0, points).ok());
    rises_once("refit", [&](const Execution& execution) { return scene.refit(execution); });
    HitLists lists;
    if (mode == RayMode::grid) continue;
    rises_once("all", [&](const Execution& execution) { return scene.all(rays, lists, execution); });
    const std::vector<RayInstance> instances{{&scene, Affine::translated({1, 0, 0})}};
    rises_once("instances", [&](const Execution& execution) { return RayScene::make(instances, execution).status(); });
  }
}
#endif

}}  // namespace tessera::test
