// After warm-up a repeated tessellation allocates nothing.

#include <atomic>
#include <cstdlib>
#include <new>

// GCC takes the replaced operators, once inlined, for a mismatch.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

#include "tess/tessellate_support.h"

namespace {
std::atomic<std::size_t> allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const std::size_t unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size / unit + 1) * unit)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

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
  const std::size_t before = allocations;
  EXPECT_GT(before, 0u);  // the count works
  for (int repeat = 0; repeat < 10; ++repeat) ASSERT_TRUE(plan.run(set, views, execution).ok());
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace tessera::test
