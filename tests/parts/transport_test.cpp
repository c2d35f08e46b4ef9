// Parts that take turns, and jobs with a folder in common, by the same checks; then what each does when parts fail.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "parts/transport_checks.h"
#include "support/errors.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

/// Runs each part as a job on a thread of its own, all in one folder. Returns the error of the lowest part.
Status run_jobs(std::size_t count, const std::function<Status(Transport&)>& run) {
  const ScratchFolder folder;
  std::vector<Status> results(count);
  std::vector<std::thread> threads;
  for (std::size_t part = 0; part < count; ++part)
    threads.emplace_back([&, part] {
      const JobFolder options{
          .folder = folder / "run", .wait = std::chrono::seconds(60), .look_every = std::chrono::milliseconds(1)};
      const auto transport = make_job_transport(options, part, count, "a run");
      results[part] = transport ? run(**transport) : transport.status();
    });
  for (std::thread& thread : threads) thread.join();
  const auto failed = std::ranges::find(results, false, &Status::ok);
  return failed == results.end() ? Status() : *failed;
}

struct Way {
  const char* name;
  Status (*run)(std::size_t, const std::function<Status(Transport&)>&);
};
const Way ways[] = {{"Turns", run_parts}, {"Jobs", run_jobs}};

class EveryTransport : public testing::TestWithParam<std::tuple<Way, TransportCheck>> {};

TEST_P(EveryTransport, PassesTheCheck) {
  const auto& [way, check] = GetParam();
  for (const std::size_t count : {1u, 2u, 3u, 7u}) {
    const Status status = way.run(count, check.run);
    EXPECT_TRUE(status.ok()) << count << " parts: " << status.message();
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryTransport,
                         testing::Combine(testing::ValuesIn(ways), testing::ValuesIn(transport_checks)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).name) + std::get<1>(test.param).name;
                         });

TEST(RunParts, OnlyOnePartRunsAtATime) {
  int running = 0, most = 0;
  std::vector<std::size_t> order;
  const Status status = run_parts(5, [&](Transport& transport) {
    for (int round = 0; round < 3; ++round) {
      most = std::max(most, ++running);
      order.push_back(transport.part());
      std::this_thread::yield();
      --running;
      if (Status agreed = transport.agree({}); !agreed.ok()) return agreed;
    }
    return Status();
  });
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(most, 1);
  ASSERT_EQ(order.size(), 15u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(order[k], k);
}

TEST(RunParts, ErrorOfAPartReachesAllOthers) {
  std::vector<std::string> heard;
  const Status status = run_parts(4, [&](Transport& transport) -> Status {
    if (Status agreed = transport.agree({}); !agreed.ok()) return agreed;
    if (transport.part() == 2) return Status(StatusCode::non_finite, "no number", 5);
    Status met = transport.agree({});
    heard.push_back(met.message());
    const Status again = transport.agree({});
    EXPECT_EQ(again.message(), met.message());
    return met;
  });
  EXPECT_EQ(status.code(), StatusCode::non_finite);
  EXPECT_EQ(status.index(), 5);
  EXPECT_EQ(status.message(), "part 2: no number");
  EXPECT_EQ(heard, std::vector<std::string>(3, "part 2: no number"));
}

TEST(RunParts, PartsThatHaveNotBegunAreNotRunAfterAnError) {
  int begun = 0;
  const Status status = run_parts(4, [&](Transport&) { return ++begun, Status(StatusCode::internal, "no"); });
  EXPECT_EQ(status.message(), "part 0: no");
  EXPECT_EQ(begun, 1);
}

TEST(RunParts, PartThatEndsEarlyIsAnErrorForOthersAndNoHang) {
  for (const std::size_t early : {0u, 1u, 2u}) {
    const Status status =
        run_parts(3, [&](Transport& transport) { return transport.part() == early ? Status() : transport.agree({}); });
    EXPECT_EQ(status.code(), StatusCode::io_error);
    EXPECT_NE(status.message().find("part " + std::to_string(early) + ", which has ended"), std::string::npos)
        << status.message();
  }
}

TEST(RunParts, PartsMustMakeTheSameCall) {
  const Status status = run_parts(3, [](Transport& transport) {
    if (transport.part() != 1) return transport.agree({});
    return transport.exchange(std::vector<Message>(3)).status();
  });
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.message(), "part 1: makes another call than part 0, though all must make the same");
}

TEST(RunParts, ExceptionsAreErrors) {
  Status status = run_parts(3, [](Transport& transport) -> Status {
    if (transport.part() == 1) throw std::runtime_error("thrown");
    return transport.agree({});
  });
  EXPECT_EQ(status.code(), StatusCode::internal);
  EXPECT_EQ(status.message(), "part 1: thrown");
  status = run_parts(3, [](Transport& transport) -> Status {
    if (transport.part() == 2) throw std::bad_alloc();
    return transport.agree({});
  });
  EXPECT_EQ(status.code(), StatusCode::out_of_memory);
  EXPECT_EQ(status.message(), "part 2: out of memory");
}

TEST(RunParts, NumberOfPartsIsLimited) {
  const auto nothing = [](Transport&) { return Status(); };
  EXPECT_EQ(run_parts(0, nothing).code(), StatusCode::invalid_argument);
  EXPECT_EQ(run_parts(max_parts + 1, nothing).message(), "there are 65537 parts, expected 1 to 65536");
  EXPECT_TRUE(run_parts(500, [](Transport& transport) {
                std::uint64_t one[] = {1};
                const auto sums = transport.prefix_sum(one);
                if (!sums) return sums.status();
                return one[0] == transport.part() && (*sums)[0] == 500 ? Status() : wrong("the sum");
              }).ok());
}

}}  // namespace tessera::test
