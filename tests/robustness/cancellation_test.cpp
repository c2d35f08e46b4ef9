// The results of a cancelled call: every record is unchanged, or as the whole call writes it, and nothing between.

#include <gtest/gtest.h>

#include <cstring>

#include "robustness/scene.h"
#include "robustness/workers.h"

namespace tessera::test { namespace {

/// Runs call(execution) repeatedly, cancelled at one share of its work after the other; runs look(status) after each.
template <class Call, class Look>
void cancelled_at_many_places(Call call, Look look) {
  int cancelled = 0;
  for (const double share : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 2.0}) {
    std::atomic<bool> cancel = share == 0;
    const Status status = call({.cancel = &cancel, .progress = [&](double done) {
                                  if (done >= share) cancel = true;
                                }});
    EXPECT_TRUE(status.ok() || status.code() == StatusCode::cancelled) << status.message();
    EXPECT_TRUE(share < 2 || status.ok());
    cancelled += !status.ok();
    look(status);
  }
  EXPECT_GE(cancelled, 4);
}

/// Counts records of `width` numbers that are neither unchanged nor complete.
template <class T>
std::size_t torn(const std::vector<T>& now, const std::vector<T>& before, const std::vector<T>& done,
                 std::size_t width) {
  std::size_t count = 0;
  const std::size_t bytes = width * sizeof(T);
  for (std::size_t k = 0; k + width <= now.size(); k += width)
    count += std::memcmp(&now[k], &before[k], bytes) != 0 && std::memcmp(&now[k], &done[k], bytes) != 0;
  return count;
}

class Cancelled : public ::testing::Test {
 protected:
  PatchSet set_ = set_of(various_patches(40), with_points());
};

TEST_F(Cancelled, Grids) {
  const auto t = uniform_parameters(9);
  const GridPlan plan = value_of(GridPlan::make(set_, t, t));
  const GridBuffers<float> before(plan);
  GridBuffers<float> done = before;
  ASSERT_TRUE(evaluate(set_, plan, done.views()).ok());
  for (const Stores stores : {Stores::plain, Stores::streaming}) {
    GridBuffers<float> out = before;
    cancelled_at_many_places(
        [&](Execution execution) {
          execution.stores = stores;
          return evaluate(set_, plan, out.views(), execution);
        },
        [&](const Status& status) {
          EXPECT_EQ(torn(out.position, before.position, done.position, 3), 0u);
          EXPECT_EQ(torn(out.normal, before.normal, done.normal, 3), 0u);
          EXPECT_TRUE(!status.ok() || out == done);
          out = before;
        });
  }
}

TEST_F(Cancelled, Points) {
  Random random(4);
  const Samples<float> samples = random_samples<float>(random, set_.patch_count(), 200000);
  const std::vector<float> before(3 * samples.size(), -7);
  std::vector<float> done = before, out = before;
  const auto run = [&](std::vector<float>& to, const Execution& execution) {
    return evaluate(set_, samples.views(), QuantityViews<float>{.position = View3<float>::interleaved(to)}, {},
                    execution);
  };
  ASSERT_TRUE(run(done, {}).ok());
  cancelled_at_many_places([&](const Execution& execution) { return run(out, execution); },
                           [&](const Status&) {
                             EXPECT_EQ(torn(out, before, done, 3), 0u);
                             out = before;
                           });
}

template <class Plan>
void check_meshes(const PatchSet& set, const Plan& plan) {
  Mesh done = value_of(plan.allocate());
  Mesh before = done;
  std::ranges::fill(before.positions, -7777.0f);
  std::ranges::fill(before.normals, -7.0f);
  std::ranges::fill(before.indices, 7u);
  ASSERT_TRUE(plan.run(set, done.views()).ok());
  Mesh out = before;
  cancelled_at_many_places([&](const Execution& execution) { return plan.run(set, out.views(), execution); },
                           [&](const Status&) {
                             // Borders are written twice, the second time with bits that neighbours share.
                             for (std::size_t k = 0; k < out.positions.size(); ++k)
                               if (std::abs(out.positions[k] - done.positions[k]) < 1e-5f)
                                 out.positions[k] = done.positions[k];
                             EXPECT_EQ(torn(out.positions, before.positions, done.positions, 3), 0u);
                             EXPECT_EQ(torn(out.normals, before.normals, done.normals, 3), 0u);
                             EXPECT_EQ(torn(out.indices, before.indices, done.indices, 3), 0u);
                             out = before;
                           });
}

TEST_F(Cancelled, UniformMeshes) { check_meshes(set_, value_of(Tessellation::make(set_, {.rates = UniformRates{}}))); }
TEST_F(Cancelled, CertifiedMeshes) { check_meshes(set_, value_of(Tessellation::make(set_, {.tolerance = 2e-3}))); }

/// Patches have their new points and their new vertices, or neither.
TEST_F(Cancelled, Updates) {
  const auto t = uniform_parameters(5);
  const GridPlan plan = value_of(GridPlan::make(set_, t, t));
  GridUpdate update = value_of(GridUpdate::make(set_));
  std::vector<std::uint32_t> patches;
  std::vector<Vec3> points, old;
  for (std::size_t k = 0; k < set_.patch_count(); ++k) {
    patches.push_back(static_cast<std::uint32_t>(k));
    for (const Vec3& p : set_.patch(k).points()) {
      old.push_back(p);
      points.push_back(p + Vec3{0, 0, 0.125});
    }
  }
  GridBuffers<float> out(plan), fresh(plan);
  ASSERT_TRUE(evaluate(set_, plan, out.views()).ok());
  const QuantityViews<float> views{.position = out.views().position};
  cancelled_at_many_places(
      [&](const Execution& execution) {
        return update.run(set_, plan, {patches, points}, views, execution);
      },
      [&](const Status&) {
        ASSERT_TRUE(evaluate(set_, plan, fresh.views()).ok());
        EXPECT_TRUE(out.position == fresh.position);
        ASSERT_TRUE(update.run(set_, plan, {patches, old}, views).ok());
      });
}

#ifdef TESSERA_HAS_RAY
TEST_F(Cancelled, Rays) {
  const std::vector<Ray> rays = rays_at(set_, 20000);
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(built([&] { return RayScene::make(set_, {.mode = mode}); }));
    std::vector<Hit> done(rays.size()), out(rays.size());
    ASSERT_TRUE(scene.closest(rays, done).ok());
    cancelled_at_many_places([&](const Execution& execution) { return scene.closest(rays, out, execution); },
                             [&](const Status&) {
                               for (std::size_t k = 0; k < rays.size(); ++k) {
                                 Bits now, none, whole;
                                 now.add(out[k]);
                                 none.add(Hit{});
                                 whole.add(done[k]);
                                 ASSERT_TRUE(now == none || now == whole) << k;
                               }
                               std::ranges::fill(out, Hit{});
                             });
    HitLists lists;
    if (mode == RayMode::grid) continue;
    cancelled_at_many_places([&](const Execution& execution) { return scene.all(rays, lists, execution); },
                             [&](const Status& status) { EXPECT_TRUE(status.ok() || lists.hits.empty()); });
  }
}
#endif

}}  // namespace tessera::test
