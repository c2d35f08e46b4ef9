// Other people's threads: the same bytes for any number of workers, calls from tasks, arenas and threads of the
// caller's, and the results of cancelled calls.

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <future>

#include "robustness/scene.h"
#include "robustness/workers.h"
#include "support/borders.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/parametric_surface.h"

namespace tessera::test { namespace {

TEST(Workers, AnyNumberOfThemGivesTheSameBytes) {
  Bits expected;
  EXPECT_EQ(with_workers(1, [&] { expected = everything(); }), 1u);
  EXPECT_GT(expected.size(), 1000000u);
  for (const int workers : {2, 3, 8, 64}) {
    Bits bits;
    EXPECT_EQ(with_workers(workers, [&] { bits = everything(); }), static_cast<std::size_t>(workers));
    EXPECT_TRUE(bits == expected) << workers << " workers";
  }
}

/// Checks that `threads` threads run the library's own loop at the same time: a function of the caller's waits for
/// them.
TEST(Workers, AreAllAtWorkInOneCall) {
  for (const int workers : {2, 3, 8, 64}) {
    Meeting meeting(static_cast<std::size_t>(workers));
    const auto surface = value_of(ParametricSurface::make({.position = [&](double u, double v) {
      if (u > 0 && u < 1) meeting.join();
      return Vec3{u, v, u * v};
    }}));
    const std::vector<double> u = uniform_parameters(8 * workers), v{0.5};
    std::vector<double> memory(3 * u.size());
    with_workers(workers, [&] {
      EXPECT_TRUE(evaluate(surface, u, v, View3<double>::interleaved(memory), {}, Calls::concurrent).ok());
    });
    EXPECT_EQ(meeting.threads(), static_cast<std::size_t>(workers));
  }
}

/// Each call would block if it waited for work that only its own thread can do; ctest's time limit would show that.
TEST(CallersThreads, TasksOfTheCallersMayCall) {
  const Bits expected = everything(3);
  std::atomic<int> same = 0;
  tbb::parallel_for(
      0, 6, [&](int) { same += everything(3) == expected; }, tbb::simple_partitioner());
  EXPECT_EQ(same, 6);
  tbb::task_group group;
  for (int k = 0; k < 4; ++k) group.run([&] { same += everything(3) == expected; });
  group.wait();
  EXPECT_EQ(same, 10);
}

TEST(CallersThreads, ACancelledTaskGroupLosesNoPieces) {
  const Bits expected = everything(3);
  std::atomic<bool> is_same = false;
  tbb::task_group group;
  group.run([&] {
    group.cancel();  // this task runs on, and so must all that it calls
    is_same = everything(3) == expected;
  });
  EXPECT_EQ(group.wait(), tbb::canceled);
  EXPECT_TRUE(is_same);
}

/// Would block if the thread that reports took another piece of the call while it waits for the tasks of the report.
TEST(CallersThreads, ReportsOfProgressMayStartTasks) {
  const auto surface = value_of(ParametricSurface::make({.position = [](double u, double v) {
    return Vec3{u, v, u * v};
  }}));
  const std::vector<double> u = uniform_parameters(4000), v = uniform_parameters(20);
  std::vector<double> memory(3 * u.size() * v.size());
  std::atomic<std::size_t> reports = 0, done = 0;
  const auto report = [&](double) {
    ++reports;
    tbb::parallel_for(0, 100, [&](int) { ++done; });
  };
  with_workers(8, [&] {
    EXPECT_TRUE(
        evaluate(surface, u, v, View3<double>::interleaved(memory), {.progress = report}, Calls::concurrent).ok());
  });
  EXPECT_GT(reports, 1u);
  EXPECT_EQ(done, 100 * reports);
}

TEST(CallersThreads, ArenasOfOneMayCall) {
  const Bits expected = everything(3);
  tbb::task_arena one(1);
  one.execute([&] { EXPECT_TRUE(everything(3) == expected); });
  std::atomic<int> same = 0;
  tbb::task_arena outer(3);
  outer.execute([&] {
    tbb::parallel_for(
        0, 4,
        [&](int) {
          tbb::task_arena inner(1);
          inner.execute([&] { same += everything(3) == expected; });
        },
        tbb::simple_partitioner());
  });
  EXPECT_EQ(same, 4);
  one.execute([&] {
    tbb::parallel_for(
        0, 3, [&](int) { same += everything(3) == expected; }, tbb::simple_partitioner());
  });
  EXPECT_EQ(same, 7);
}

TEST(CallersThreads, PoolsOfThreadsMayCall) {
  const Bits expected = everything(3);
  std::vector<std::future<bool>> pool;
  for (int k = 0; k < 6; ++k) pool.push_back(std::async(std::launch::async, [&] { return everything(3) == expected; }));
  for (auto& result : pool) EXPECT_TRUE(result.get());
}

/// One set, one plan, one scene, used by all at once; and an edit between, with exclusive access.
TEST(CallersThreads, MayShareConstObjects) {
  PatchSet set = set_of(various_patches(4), with_points());
  const std::vector<Vec3> before(set.patch(5).points().begin(), set.patch(5).points().end());
  std::vector<Vec3> after = before;
  for (Vec3& p : after) p.z += 0.25;
  const auto plan = value_of(Tessellation::make(set, {.tolerance = 2e-3}));
#ifdef TESSERA_HAS_RAY
  RayScene scene = value_of(built([&] { return RayScene::make(set); }));
  const std::vector<Ray> rays = rays_at(set, 600);
#endif
  const auto use = [&] {
    Bits bits;
    evaluate_into(bits, set);
    Mesh mesh = value_of(plan.allocate());
    EXPECT_TRUE(plan.run(set, mesh.views()).ok());
    bits.add(mesh);
#ifdef TESSERA_HAS_RAY
    std::vector<Hit> hits(rays.size());
    EXPECT_TRUE(scene.closest(rays, hits).ok());
    HitLists lists;
    EXPECT_TRUE(scene.all(rays, lists).ok());
    for (const Hit& hit : hits) bits.add(hit);
#endif
    return bits;
  };
  for (const std::vector<Vec3>* points : std::initializer_list<const std::vector<Vec3>*>{&after, &before}) {
    const Bits expected = use();
    std::vector<std::future<bool>> users;
    for (int k = 0; k < 5; ++k) users.push_back(std::async(std::launch::async, [&] { return use() == expected; }));
    for (auto& user : users) EXPECT_TRUE(user.get());
    ASSERT_TRUE(set.set_control_points(5, *points).ok());
#ifdef TESSERA_HAS_RAY
    ASSERT_TRUE(built([&] { return scene.refit(); }).ok());
#endif
  }
}

}}  // namespace tessera::test
