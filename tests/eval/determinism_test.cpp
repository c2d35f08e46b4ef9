// Results are the same bytes for any number of threads, and on every ISA with fused multiply-adds; checks which ISA
// ran.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "support/grids.h"
#include "support/suite_isa.h"

namespace tessera::test { namespace {

bool available(Isa isa) { return std::ranges::count(available_isas(), isa) > 0; }

template <class T, class Buffers = AllBuffers<T>>
Buffers run_once(const PatchSet& set, Isa isa, int threads, ExecutionReport* report = nullptr) {
  const auto u = uniform_parameters(9), v = uniform_parameters(14);
  const GridPlan plan = value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>, .isa = isa}));
  Buffers out(plan);
  // The arena may be larger than the machine; without this limit TBB would make no second worker on one core.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Execution execution;
  execution.report = report;
  arena.execute([&] { EXPECT_TRUE(evaluate(set, plan, out.views(), execution).ok()); });
  return out;
}

template <class T>
void compare_runs() {
  Random random(21);
  PatchSetOptions options;
  options.blocks.double_bernstein = true;
  const PatchSet set = set_of(mixed_patches(random, 4, 12), options);
  for (const Isa isa : available_isas()) {
    ExecutionReport report;
    const auto one = run_once<T>(set, isa, 1, &report);
    EXPECT_GT(report.tasks, 2u) << "too little work to be shared";
    EXPECT_EQ(report.isa, isa);
    EXPECT_TRUE(one == run_once<T>(set, isa, 2)) << name(isa);
    EXPECT_TRUE(one == run_once<T>(set, isa, 8)) << name(isa);
  }
  if (!available(Isa::avx512)) GTEST_SKIP() << "this machine lacks AVX-512";
  EXPECT_TRUE(run_once<T>(set, Isa::avx2, 1) == run_once<T>(set, Isa::avx512, 2));
}

TEST(Determinism, FloatBytes) { compare_runs<float>(); }
TEST(Determinism, DoubleBytes) { compare_runs<double>(); }

/// SSE2 has no fused multiply-add: were its bits those of AVX2, the wrong kernel would have run.
TEST(Determinism, Sse2RoundsDifferently) {
  if (!available(Isa::avx2)) GTEST_SKIP() << "this machine lacks AVX2";
  Random random(22);
  const PatchSet set = set_of(mixed_patches(random, 4));
  EXPECT_FALSE(run_once<float>(set, Isa::sse2, 1) == run_once<float>(set, Isa::avx2, 1));
}

TEST(Isa, EnvironmentForcesOne) {
  for (const Isa isa : available_isas()) {
    const ForcedIsa forced(isa);
    EXPECT_EQ(value_of(default_isa()), isa);
    Random random(23);
    const PatchSet set = set_of({random_polynomial(random, 3, 3)});
    const auto t = uniform_parameters(3);
    const GridPlan plan = value_of(GridPlan::make(set, t, t));
    GridBuffers<float> out(plan);
    ExecutionReport report;
    Execution execution;
    execution.report = &report;
    ASSERT_TRUE(evaluate(set, plan, out.views(), execution).ok());
    EXPECT_EQ(report.isa, isa);
  }
  const ForcedIsa unknown("mmx");
  EXPECT_EQ(default_isa().status().code(), StatusCode::isa_unavailable);
  EXPECT_NE(default_isa().status().message().find("mmx"), std::string::npos);
  Random random(24);
  const PatchSet set = set_of({random_polynomial(random, 3, 3)});
  const auto t = uniform_parameters(3);
  EXPECT_EQ(GridPlan::make(set, t, t).status().code(), StatusCode::isa_unavailable);
  for (const char* const none : {"", static_cast<const char*>(nullptr)}) {
    const ForcedIsa open(none);
    EXPECT_EQ(value_of(default_isa()), available_isas().back());
  }
}

}}  // namespace tessera::test
