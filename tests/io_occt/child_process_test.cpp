// Work in a process of its own.

#include "io_occt/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "support/errors.h"

namespace tessera::test {
namespace {

constexpr ChildLimits plenty{std::size_t{1} << 30, 60};
constexpr auto none = Status::no_index;

TEST(ChildProcess, ReturnsWhatItsWorkReturns) {
  for (const std::size_t size : {0, 1, 70'000, 50'000'000}) {
    const Result<std::string> bytes = run_in_child([&] { return std::string(size, 'x'); }, plenty, "it");
    ASSERT_TRUE(bytes.ok()) << bytes.status().message();
    EXPECT_EQ(*bytes, std::string(size, 'x'));
  }
}

TEST(ChildProcess, SharesNothing) {
  int value = 1;
  EXPECT_TRUE(run_in_child([&] { return std::string(static_cast<std::size_t>(++value), 'x'); }, plenty, "it").ok());
  EXPECT_EQ(value, 1);
}

/// Like a daemon, which has no streams: the pipe then takes their places.
TEST(ChildProcess, NeedsNoStreamsOfItsParent) {
  const auto without_streams = [] {
    for (int stream = 0; stream < 3; ++stream) ::close(stream);
    const Result<std::string> bytes = run_in_child([] { return std::string("x"); }, plenty, "it");
    return bytes.ok() ? *bytes : bytes.status().message();
  };
  const Result<std::string> bytes = run_in_child(without_streams, plenty, "it");
  ASSERT_TRUE(bytes.ok()) << bytes.status().message();
  EXPECT_EQ(*bytes, "x");
}

TEST(ChildProcess, CrashesAlone) {
  const auto crash = [](int signal) { return [signal] { return std::raise(signal), std::string("x"); }; };
  expect_refused(run_in_child(crash(SIGSEGV), plenty, "it"), StatusCode::internal, none,
                 "it crashed (Segmentation fault)");
  expect_refused(run_in_child(crash(SIGABRT), plenty, "it"), StatusCode::internal, none, "it crashed (Aborted)");
  expect_refused(run_in_child(crash(SIGKILL), plenty, "it"), StatusCode::internal, none, "it crashed (Killed)");
  const auto throws = []() -> std::string { throw std::runtime_error("x"); };
  expect_refused(run_in_child(throws, plenty, "it"), StatusCode::internal, none, "it ended without a result");
}

TEST(ChildProcess, HasItsLimits) {
  const auto endless = [] {
    volatile bool on = true;
    while (on) continue;
    return std::string();
  };
  expect_refused(run_in_child(endless, {plenty.memory_bytes, 1}, "it"), StatusCode::internal, none,
                 "it did not end within 1 second of processor time");
  const auto hungry = [] {
    std::vector<std::string> all;
    for (int k = 0; k < 400; ++k) all.emplace_back(std::size_t{1} << 20, 'x');
    return std::string("all");
  };
  EXPECT_TRUE(run_in_child(hungry, plenty, "it").ok());
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  expect_refused(run_in_child(hungry, {std::size_t{100} << 20, 60}, "it"), StatusCode::out_of_memory, none,
                 "it exceeded its memory limit");
#endif
}

TEST(ChildProcess, PrintsNothing) {
  testing::internal::CaptureStdout();
  const Result<std::string> bytes = run_in_child(
      [] {
        std::puts("noise");
        std::fflush(stdout);
        return std::string("x");
      },
      plenty, "it");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_TRUE(bytes.ok());
}

TEST(ChildProcess, LeavesNoneBehind) {
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(run_in_child([] { return std::string("x"); }, plenty, "it").ok());
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was not collected";
}

TEST(ChildProcess, NeedsNoStatus) {
  // Programs that ignore their children get none.
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const Result<std::string> good = run_in_child([] { return std::string("x"); }, plenty, "it");
  const Result<std::string> bad = run_in_child([] { return std::raise(SIGSEGV), std::string(); }, plenty, "it");
  std::signal(SIGCHLD, before);
  EXPECT_TRUE(good.ok());
  expect_refused(bad, StatusCode::internal, none, "it ended without a result");
}

}  // namespace
}  // namespace tessera::test
