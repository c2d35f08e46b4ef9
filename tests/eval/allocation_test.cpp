// After the first call a repeated call allocates nothing, and calls need no more stack than evaluate.h states.

#include "support/allocations.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <functional>

#include <tbb/task_arena.h>

#include "base/impl_access.h"
#include "eval/uniform_grid.h"
#include "support/points.h"

namespace tessera::test {
namespace {

template <class Call>
void expect_no_allocation(Call&& call) {
  ASSERT_TRUE(call().ok());
  const std::size_t before = allocation_count();
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(call().ok());
  EXPECT_EQ(allocation_count(), before);
}

TEST(Allocations, AreCounted) {
  const std::size_t before = allocation_count();
  const auto memory = std::make_unique<int>(1);
  EXPECT_EQ(allocation_count(), before + 1);
}

TEST(Allocations, NoneWhenEvaluatingAgain) {
  Random random(81);
  PatchSetOptions options;
  options.blocks.double_bernstein = true;
  const PatchSet set = set_of(mixed_patches(random, 4, 8), options);
  const auto t = uniform_parameters(9);
  const GridPlan singles = value_of(GridPlan::make(set, t, t));
  const GridPlan doubles = value_of(GridPlan::make(set, t, t, {.precision = Precision::double_precision}));
  GridBuffers<float> a(singles);
  GridBuffers<double> b(doubles);
  AlignedVector<float> blocks(singles.block_capacity());
  expect_no_allocation([&] { return evaluate(set, singles, a.views()); });
  expect_no_allocation([&] { return evaluate(set, doubles, b.views()); });
  expect_no_allocation([&] { return evaluate(set, singles, QuantityBlocks<float>{.position = blocks}); });
  AllBuffers<float> all(singles);
  AllBuffers<double> all_doubles(doubles);
  expect_no_allocation([&] { return evaluate(set, singles, all.views()); });
  expect_no_allocation([&] { return evaluate(set, doubles, all_doubles.views()); });
  expect_no_allocation([&] { return evaluate(set, singles, QuantityBlocks<float>{.gaussian = blocks}); });
  const UniformGrid grid = value_of(UniformGrid::make(set, 8, 8, std::nullopt));
  expect_no_allocation([&] { return grid.run(impl_of(set), {.position = a.views().position}, {}); });
}

#ifndef __SANITIZE_ADDRESS__  // which makes frames larger
/// Runs a call in a thread with a stack of this size, and no other thread. A call that needs more ends the program.
void run_with_stack(std::size_t bytes, std::function<void()> call) {
  pthread_attr_t attributes;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, bytes), 0);
  pthread_t thread;
  const auto start = [](void* data) -> void* {
    tbb::task_arena(1).execute(*static_cast<std::function<void()>*>(data));
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, start, &call), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

template <class T>
void evaluate_with_stack(std::size_t bytes, Precision precision) {
  Random random(82);
  PatchSetOptions options;
  options.blocks = {true, true, false, true, true, true};
  PatchSet set = set_of(mixed_patches(random, 4, 8), options);
  const auto t = uniform_parameters(33);
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.precision = precision}));
  GridUpdate update = value_of(GridUpdate::make(set));
  AllBuffers<T> grids(plan);
  const auto samples = random_samples<T>(random, set.patch_count(), 3000);
  AllBuffers<T> scattered(samples.size());
  const std::uint32_t first = 0;
  const std::vector<Vec3> net(set.patch(first).points().size(), Vec3{1, 2, 3});
  run_with_stack(bytes, [&] {
    EXPECT_TRUE(evaluate(set, plan, grids.views()).ok());
    EXPECT_TRUE(evaluate(set, samples.views(), scattered.views()).ok());
    EXPECT_TRUE(update.run(set, plan, {{&first, 1}, net}, grids.views()).ok());
  });
}

TEST(Stack, OfTheStatedSizeSuffices) {
  evaluate_with_stack<float>(1 << 20, Precision::single_precision);
  evaluate_with_stack<double>(1 << 20, Precision::double_precision);
}
#endif

}  // namespace
}  // namespace tessera::test
