#include "parallel/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace tessera::test { namespace {

TEST(ParallelFor, CoversEachIndexOnce) {
  for (const std::size_t count : {0u, 1u, 7u, 64u, 1000u})
    for (const std::size_t grain : {0u, 1u, 3u, 64u, 5000u}) {
      std::vector<std::atomic<int>> seen(count);
      ExecutionReport report;
      Execution execution;
      execution.report = &report;
      ASSERT_TRUE(parallel_for(count, grain, execution, [&](std::size_t begin, std::size_t end) {
                    EXPECT_LE(end - begin, std::max<std::size_t>(grain, 1));
                    for (; begin < end; ++begin) ++seen[begin];
                  }).ok());
      for (const auto& times : seen) EXPECT_EQ(times, 1);
      const std::size_t step = std::max<std::size_t>(grain, 1);
      EXPECT_EQ(report.tasks, (count + step - 1) / step);
    }
}

TEST(ParallelFor, ExceptionsBecomeStatuses) {
  for (const std::size_t count : {1u, 1000u}) {
    const auto run = [&](auto&& thrower) {
      return parallel_for(count, 1, {}, [&](std::size_t begin, std::size_t) {
        if (begin == count / 2) thrower();
      });
    };
    EXPECT_EQ(run([] { throw std::runtime_error("boom"); }).message(), "boom");
    EXPECT_EQ(run([] { throw std::bad_alloc(); }).code(), StatusCode::out_of_memory);
    EXPECT_EQ(run([] { throw 1; }).code(), StatusCode::internal);
  }
}

// A caller that keeps floating-point exceptions from trapping keeps them so on all threads; TBB's own threads have the
// settings of whoever used them first.
TEST(ParallelFor, RunsWithTheCallersFloatingPointSettings) {
  const auto directions = [] {
    std::mutex mutex;
    std::map<int, int> seen;
    EXPECT_TRUE(parallel_for(2000, 1, {}, [&](std::size_t, std::size_t) {
                  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(20);
                  while (std::chrono::steady_clock::now() < end) continue;
                  const std::lock_guard lock(mutex);
                  ++seen[std::fegetround()];
                }).ok());
    return seen;
  };
  EXPECT_EQ(directions(), (std::map<int, int>{{FE_TONEAREST, 2000}}));
  std::fesetround(FE_UPWARD);
  const std::map<int, int> upward = directions();
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(upward, (std::map<int, int>{{FE_UPWARD, 2000}}));
  EXPECT_EQ(directions(), (std::map<int, int>{{FE_TONEAREST, 2000}}));
}

TEST(ParallelFor, StopsWhenCancelled) {
  std::atomic<bool> cancel = false;
  std::atomic<std::size_t> pieces = 0;
  Execution execution;
  execution.cancel = &cancel;
  const Status status = parallel_for(100000, 1, execution, [&](std::size_t, std::size_t) {
    if (++pieces == 10) cancel = true;
  });
  EXPECT_EQ(status.code(), StatusCode::cancelled);
  EXPECT_LT(pieces, 1000u);
}

TEST(ParallelFor, AFlagThatIsLoweredAgainHidesNoMissingPiece) {
  constexpr std::size_t count = 200'000;
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::atomic<bool> cancel = false, is_over = false;
    std::thread lowers([&] {
      while (!cancel && !is_over) std::this_thread::yield();
      cancel = false;
    });
    std::atomic<std::size_t> pieces = 0;
    const Status status = parallel_for(count, 1, {.cancel = &cancel}, [&](std::size_t, std::size_t) {
      if (++pieces == 1000) cancel = true;
    });
    is_over = true;
    lowers.join();
    EXPECT_EQ(status.ok(), pieces == count) << pieces;
  }
}

TEST(ParallelFor, ProgressRisesToOne) {
  double last = 0;
  int calls = 0;
  Execution execution;
  execution.progress = [&](double share) {
    EXPECT_GT(share, last);
    last = share;
    ++calls;
  };
  ASSERT_TRUE(parallel_for(5000, 1, execution, [](std::size_t, std::size_t) {}).ok());
  EXPECT_EQ(last, 1);
  EXPECT_GE(calls, 2);
  EXPECT_LE(calls, 101);
}

}}  // namespace tessera::test
