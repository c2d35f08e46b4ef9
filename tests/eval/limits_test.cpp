// The machine's limits and the work of a plan.

#include <gtest/gtest.h>

#include <cmath>

#include "support/grids.h"
#include "tessera/limits.h"

namespace tessera::test { namespace {

TEST(Limits, AreMeasuredForEachIsa) {
  for (const Isa isa : available_isas()) {
    const Limits limits = value_of(measure_limits({.isa = isa, .store_bytes = 1 << 20}));
    EXPECT_EQ(limits.isa, isa);
    for (const double rate : {limits.float_operations_per_second, limits.double_operations_per_second,
                              limits.plain_store_bytes_per_second, limits.streaming_store_bytes_per_second})
      EXPECT_TRUE(std::isfinite(rate) && rate > 0) << rate;
    EXPECT_EQ(limits.store_bytes_per_second,
              std::max(limits.plain_store_bytes_per_second, limits.streaming_store_bytes_per_second));
  }
}

TEST(Limits, ABufferThatNoMemoryHoldsIsRefused) {
  const auto limits = measure_limits({.store_bytes = std::size_t{1} << 63});
  EXPECT_EQ(limits.status().code(), StatusCode::out_of_memory);
}

/// 12, 36, 50 and 72 operations per point of a bicubic; in proportion to the order; 4/3 of it and 4 more if rational;
/// 30 for curvatures.
TEST(Limits, WorkFollowsTheStatedCounts) {
  Random random(61);
  const auto u = uniform_parameters(5), v = uniform_parameters(8);
  const auto work = [&](const BezierPatch& patch, QuantityFlags outputs) {
    return value_of(GridPlan::make(set_of({patch}), u, v)).work(outputs);
  };
  const BezierPatch cubic = random_polynomial(random, 3, 3);
  EXPECT_EQ(work(cubic, {.position = true}).lane_operations, 40 * 12);
  EXPECT_EQ(work(cubic, {.position = true}).bytes_written, 40 * 12);
  EXPECT_EQ(work(cubic, {.position = true, .du = true, .dv = true}).lane_operations, 40 * 36);
  EXPECT_EQ(work(cubic, {.position = true, .normal = true}).lane_operations, 40 * 50);
  EXPECT_EQ(work(cubic, {.position = true, .normal = true}).bytes_written, 40 * 24);
  EXPECT_EQ(work(cubic, {.position = true, .duu = true}).lane_operations, 40 * 72);
  const QuantityFlags twenty{
      .position = true, .du = true, .dv = true, .duu = true, .duv = true, .dvv = true, .gaussian = true, .mean = true};
  EXPECT_EQ(work(cubic, twenty).lane_operations, 40 * 102);
  EXPECT_EQ(work(cubic, twenty).bytes_written, 40 * 80);
  EXPECT_EQ(work(cubic, {.normal_kind = true}).bytes_written, 40);
  EXPECT_EQ(work(random_rational(random, 3, 3), twenty).lane_operations, 40 * (72 * 4 / 3 + 4 + 30));
  EXPECT_EQ(work(random_polynomial(random, 1, 1), {.position = true}).lane_operations, 40 * 6);
  EXPECT_EQ(work(random_rational(random, 3, 3), {.position = true}).lane_operations, 40 * 20);
}

TEST(Limits, TheSlowerOfComputingAndStoringCounts) {
  Limits limits;
  limits.float_operations_per_second = 100;
  limits.double_operations_per_second = 50;
  limits.store_bytes_per_second = 10;
  EXPECT_DOUBLE_EQ(seconds_at_limit(limits, {.lane_operations = 1000, .bytes_written = 20}), 10);
  EXPECT_DOUBLE_EQ(seconds_at_limit(limits, {.lane_operations = 1000, .bytes_written = 20, .double_precision = true}),
                   20);
  EXPECT_DOUBLE_EQ(seconds_at_limit(limits, {.lane_operations = 10, .bytes_written = 20}), 2);
}

}}  // namespace tessera::test
