// After warm-up a repeated tessellation allocates nothing.

#include "support/allocations.h"
#include "tess/tessellate_support.h"

namespace tessera::test {
namespace {

TEST(TessellationAllocation, NoneAfterTheFirstRuns) {
  const PatchSet set = set_of(mixed_patches(1, 400));
  const TessellationPlan plan = good(TessellationPlan::make(set, {.rate_u = 6, .rate_v = 5, .isa = {}}));
  Mesh mesh = good(plan.allocate());
  const MeshViews views = mesh.views();
  double done = 0;
  Execution execution;
  execution.progress = [&](double share) { done = share; };
  for (int warm_up = 0; warm_up < 20; ++warm_up) ASSERT_TRUE(plan.run(set, views, execution).ok());
  const std::size_t before = allocation_count();
  EXPECT_GT(before, 0u);  // the count works
  for (int repeat = 0; repeat < 10; ++repeat) ASSERT_TRUE(plan.run(set, views, execution).ok());
  EXPECT_EQ(allocation_count(), before);
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace tessera::test
