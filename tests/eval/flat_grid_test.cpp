// Positions alone, patch after patch with long rows, have a kernel of their own. It gives the bits of blocks, at any
// place in memory, for one patch and for many, whole and in parts, and writes nothing beyond.

#include <gtest/gtest.h>

#include <cstring>

#include "support/grids.h"

namespace tessera::test { namespace {

std::vector<double> flat_parameters(int count) {
  std::vector<double> t;
  for (int k = 0; k < count; ++k) t.push_back((k + 0.3) / count);
  return t;
}

PatchSet polynomial_set(int patches) {
  Random random(53);
  std::vector<BezierPatch> all;
  for (int k = 0; k < patches; ++k)
    all.push_back(k % 7 == 5   ? random_polynomial(random, 2, 5)
                  : k % 7 == 6 ? random_polynomial(random, 1, 1)
                               : random_polynomial(random, 3, 3));
  return set_of(all);
}

void check_flat(int patches, int nu, int nv, std::size_t shift, Stores stores, Isa isa) {
  SCOPED_TRACE(testing::Message() << patches << " patches, " << nu << "x" << nv << " at " << shift << ", "
                                  << name(isa));
  const PatchSet set = polynomial_set(patches);
  const auto plan = value_of(GridPlan::make(set, flat_parameters(nu), flat_parameters(nv), {.isa = isa}));
  AlignedVector<float> blocks(plan.block_capacity());
  ASSERT_TRUE(evaluate(set, plan, QuantityBlocks<float>{.position = blocks}).ok());
  const float untouched = -7;
  const std::size_t count = 3 * plan.capacity(), samples = plan.count_u() * plan.count_v();
  AlignedVector<float> memory(count + shift + 16, untouched), expected = memory;
  for (std::size_t k = 0; k < plan.capacity(); ++k) {
    const PatchSet::Slot slot = set.slot(k / samples);
    for (std::size_t c = 0; c < 3; ++c)
      expected[shift + 3 * k + c] =
          blocks[((slot.block * samples + k % samples) * 3 + c) * PatchSet::lanes + slot.lane];
  }
  Execution execution;
  ExecutionReport report;
  execution.stores = stores;
  execution.report = &report;
  const auto view = View3<float>::interleaved(std::span<float>(memory).subspan(shift, count));
  ASSERT_TRUE(evaluate(set, plan, QuantityViews<float>{.position = view}, execution).ok());
  EXPECT_EQ(report.isa, isa);
  EXPECT_EQ(std::memcmp(memory.data(), expected.data(), memory.size() * sizeof(float)), 0);
}

TEST(FlatGrid, BitsOfBlocksInAnyPlace) {
  for (const Isa isa : available_isas())
    for (const Stores stores : {Stores::plain, Stores::streaming})
      for (const int patches : {1, 3, 40})
        for (const auto& [nu, nv] : {std::pair{2, 16}, {5, 17}, {33, 33}, {16, 21}, {1, 64}, {7, 100}})
          for (const std::size_t shift : {0, 1, 7, 15}) check_flat(patches, nu, nv, shift, stores, isa);
}

/// Large grids are cut into parts of rows.
TEST(FlatGrid, PartsOfOnePatch) {
  for (const Isa isa : available_isas())
    for (const auto& [nu, nv] : {std::pair{300, 200}, {2500, 16}, {3, 20000}})
      check_flat(2, nu, nv, 5, Stores::automatic, isa);
}

}}  // namespace tessera::test
