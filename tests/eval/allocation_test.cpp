// After the first call a repeated call allocates nothing.

#include "support/allocations.h"

#include <gtest/gtest.h>

#include "base/impl_access.h"
#include "eval/uniform_grid.h"
#include "support/grids.h"

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

}  // namespace
}  // namespace tessera::test
