// After the first call a repeated call allocates nothing, and calls need no more stack than evaluate.h states.

#include "support/allocations.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <functional>

#include <tbb/task_arena.h>

#include "base/impl_access.h"
#include "eval/uniform_grid.h"
#include "support/borders.h"
#include "support/points.h"

namespace tessera::test { namespace {

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
/// Returns the bytes of stack that a call takes in a thread that works alone, with the thread's own data.
std::size_t stack_of(std::function<void()> call) {
  constexpr unsigned char untouched = 0xa5;
  AlignedVector<unsigned char> stack(4 << 20, untouched);
  pthread_attr_t attributes;
  pthread_t thread;
  const auto start = [](void* data) -> void* {
    tbb::task_arena(1).execute(*static_cast<std::function<void()>*>(data));
    return nullptr;
  };
  EXPECT_EQ(pthread_attr_init(&attributes), 0);
  EXPECT_EQ(pthread_attr_setstack(&attributes, stack.data(), stack.size()), 0);
  if (pthread_create(&thread, &attributes, start, &call) != 0) return stack.size();
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  const auto deepest = std::find_if(stack.begin(), stack.end(), [](unsigned char byte) { return byte != untouched; });
  return static_cast<std::size_t>(stack.end() - deepest);
}

template <class T>
void expect_stated_stack(Precision precision) {
  Random random(82);
  PatchSetOptions options;
  options.blocks = {true, true, false, true, true, true};
  PatchSet set = set_of(mixed_patches(random, 4, 8), options);
  const auto t = uniform_parameters(33);
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.precision = precision}));
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  GridUpdate update = value_of(GridUpdate::make(set));
  AllBuffers<T> grids(plan);
  AlignedVector<T> blocks(3 * plan.block_capacity());
  const auto samples = random_samples<T>(random, set.patch_count(), 3000);
  const std::vector<double> places(samples.size(), 0.25);
  AllBuffers<T> scattered(samples.size());
  const std::uint32_t first = 0;
  const std::vector<Vec3> net(set.patch(first).points().size(), Vec3{1, 2, 3});
  const auto line = [](double height) { return callable([=](double s) { return Vec3{s, height, s * s}; }, {0, 1}); };
  const RuledSurface ruled = value_of(RuledSurface::make(line(0), line(1)));
  std::vector<T> rows(3 * t.size() * t.size());
  const auto expect_stack = [](const char* what, const auto& call) {
    EXPECT_LT(stack_of([&] { EXPECT_TRUE(call().ok()) << what; }), std::size_t{1} << 20) << what;
  };
  expect_stack("plan", [&] { return GridPlan::make(set, t, t, {.precision = precision}).status(); });
  expect_stack("grids", [&] { return evaluate(set, plan, grids.views()); });
  expect_stack("blocks", [&] { return evaluate(set, plan, QuantityBlocks<T>{.position = blocks}); });
  expect_stack("points", [&] { return evaluate(set, samples.views(), scattered.views()); });
  expect_stack("points of surfaces", [&] {
    const auto uv = View1<const double>::interleaved(places);
    return evaluate(set, map, {View1<const std::uint32_t>::interleaved(samples.patch), uv, uv}, scattered.views());
  });
  expect_stack("update", [&] { return update.run(set, plan, {{&first, 1}, net}, grids.views()); });
  expect_stack("update of blocks", [&] {
    return update.run(set, plan, {{&first, 1}, net}, QuantityBlocks<T>{.position = blocks});
  });
  expect_stack("ruled surface", [&] { return evaluate(ruled, t, t, View3<T>::interleaved(rows)); });
}

TEST(Stack, IsWithinWhatIsStated) {
  expect_stated_stack<float>(Precision::single_precision);
  expect_stated_stack<double>(Precision::double_precision);
}
#endif

}}  // namespace tessera::test
