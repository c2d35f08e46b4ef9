// Jobs that are killed, late, mistaken or unlucky, each a process of its own.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "parts/transport_checks.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/transport.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

JobFolder soon(const fs::path& folder, int seconds = 0) {
  return {.folder = folder, .wait = std::chrono::seconds(seconds), .look_every = std::chrono::milliseconds(1)};
}

std::unique_ptr<Transport> job(const fs::path& folder, std::size_t part, std::size_t count, int seconds = 0,
                               std::string_view run = "a run") {
  auto transport = make_job_transport(soon(folder, seconds), part, count, run);
  EXPECT_TRUE(transport.ok()) << transport.status().message();
  return transport ? *std::move(transport) : nullptr;
}

Message text_message(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// One round of a computation that depends on all rounds before: each part adds what it hears.
Status add_round(Transport& transport, std::uint64_t& sum) {
  std::uint64_t values[] = {sum + transport.part() + 1};
  const auto sums = transport.prefix_sum(values);
  if (!sums) return sums.status();
  sum = (*sums)[0];
  return {};
}

constexpr int rounds = 20;

/// The sum that add_round() gives after all rounds.
std::uint64_t expected_sum(std::uint64_t count) {
  std::uint64_t sum = 0;
  for (int round = 0; round < rounds; ++round) sum = count * sum + count * (count + 1) / 2;
  return sum;
}

/// Starts a job in a process that ends with 0 if it found the right sum. It waits a little after each round.
pid_t start_job(const fs::path& folder, std::size_t part, std::size_t count) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::alarm(60);
  const auto transport = make_job_transport(soon(folder, 50), part, count, "a run");
  if (!transport) ::_exit(2);
  std::uint64_t sum = 0;
  for (int round = 0; round < rounds; ++round) {
    if (!add_round(**transport, sum).ok()) ::_exit(3);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ::_exit(sum == expected_sum(count) ? 0 : 4);
}

int exit_status(pid_t child) {
  int state = 0;
  ::waitpid(child, &state, 0);
  return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

TEST(Jobs, KilledJobsGoOnWhereTheyWere) {
  const ScratchFolder scratch;
  const fs::path folder = scratch / "run";
  std::vector<pid_t> jobs;
  for (std::size_t part = 0; part < 3; ++part) jobs.push_back(start_job(folder, part, 3));
  int killed = 0;
  for (int time = 0; time < 8; ++time) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const std::size_t part = time % 3;
    ::kill(jobs[part], SIGKILL);
    killed += exit_status(jobs[part]) == -1;
    jobs[part] = start_job(folder, part, 3);
  }
  EXPECT_GE(killed, 1);
  for (const pid_t job : jobs) EXPECT_EQ(exit_status(job), 0);
  for (const std::string& name : scratch.names()) EXPECT_EQ(name, "run");
  EXPECT_EQ(exit_status(start_job(folder, 1, 3)), 0) << "a run that has ended can be repeated";
}

TEST(Jobs, LateMessageIsNamed) {
  const ScratchFolder folder;
  const auto transport = job(folder.path(), 1, 3);
  const Status status = transport->agree({});
  EXPECT_EQ(status.code(), StatusCode::cancelled);
  EXPECT_EQ(status.message(),
            "part 1: has waited for part 0 for 0 seconds: " + folder / "call-000000.part-000000.messages" +
                " is missing. Start it again once that part runs");
  EXPECT_EQ(transport->agree({}).message(), status.message());
}

TEST(Jobs, CallersCancelWaiting) {
  const ScratchFolder folder;
  const std::atomic<bool> cancel = true;
  JobFolder options = soon(folder.path(), 600);
  options.cancel = &cancel;
  const auto transport = make_job_transport(options, 0, 2, "a run");
  ASSERT_TRUE(transport.ok());
  EXPECT_EQ((*transport)->agree({}).code(), StatusCode::cancelled);
}

TEST(Jobs, TwoRunsInOneFolderAreFound) {
  const ScratchFolder folder;
  job(folder.path(), 0, 2);
  expect_refused(make_job_transport(soon(folder.path()), 1, 3, "a run"), StatusCode::parse_error, Status::no_index,
                 "run.txt: is of a run with another number of parts");
  expect_refused(make_job_transport(soon(folder.path()), 1, 2, "another"), StatusCode::parse_error, Status::no_index,
                 "run.txt: is of a run with another input or other options");
  // Without the first file, the messages tell.
  EXPECT_EQ(job(folder.path(), 0, 2)->agree({}).code(), StatusCode::cancelled);
  fs::remove(folder / "run.txt");
  const Status met = job(folder.path(), 1, 2, 0, "another")->agree({});
  EXPECT_EQ(met.code(), StatusCode::parse_error);
  EXPECT_NE(met.message().find("call-000000.part-000000.messages: is not of this run"), std::string::npos)
      << met.message();
}

TEST(Jobs, MessageThatIsThereMustBeTheSame) {
  const ScratchFolder folder;
  const auto send = [&](std::string_view text) {
    return job(folder.path(), 0, 2)->exchange({Message(), text_message(text)}).status();
  };
  EXPECT_EQ(send("one").code(), StatusCode::cancelled);
  EXPECT_EQ(send("one").code(), StatusCode::cancelled);
  EXPECT_EQ(send("two").code(), StatusCode::parse_error);
  EXPECT_NE(send("two").message().find("holds other messages than this part sends"), std::string::npos);
  EXPECT_EQ(send("").code(), StatusCode::parse_error);
  EXPECT_EQ(job(folder.path(), 0, 2)->agree({}).code(), StatusCode::parse_error) << "another call";
}

TEST(Jobs, DamagedMessagesAreErrors) {
  const ScratchFolder folder;
  ASSERT_EQ(job(folder.path(), 0, 2)->exchange({Message(), text_message("a message of some length")}).status().code(),
            StatusCode::cancelled);
  const std::string file = folder / "call-000000.part-000000.messages", good = content_of(file);
  const auto take = [&] { return job(folder.path(), 1, 2)->exchange(std::vector<Message>(2)); };
  const auto taken = take();
  ASSERT_TRUE(taken.ok()) << taken.status().message();
  EXPECT_EQ((*taken)[0], text_message("a message of some length"));
  for (std::size_t size = 0; size < good.size(); ++size) {
    folder.file("call-000000.part-000000.messages", good.substr(0, size));
    EXPECT_EQ(take().status().code(), StatusCode::parse_error) << "cut at " << size;
  }
  for (std::size_t place = 0; place < good.size(); ++place) {
    std::string bad = good;
    bad[place] ^= 4;
    folder.file("call-000000.part-000000.messages", bad);
    EXPECT_EQ(take().status().code(), StatusCode::parse_error) << "changed at " << place;
  }
  folder.file("call-000000.part-000000.messages", good + "x");
  EXPECT_EQ(take().status().code(), StatusCode::parse_error);
}

TEST(Jobs, FullDiskIsAnErrorAndLeavesNoFile) {
  const ScratchFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto transport = make_job_transport(soon(folder.path()), 0, 2, "a run");
    const Status status = (*transport)->exchange({Message(), Message(100'000)}).status();
    ::_exit(status.code() == StatusCode::io_error ? 0 : 1);
  }
  EXPECT_EQ(exit_status(child), 0);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"run.txt"});
}

TEST(Jobs, WrongArgumentsAreNamed) {
  const ScratchFolder folder;
  const auto refused = [&](JobFolder options, std::size_t part, const std::string& words) {
    expect_refused(make_job_transport(options, part, 3, ""), StatusCode::invalid_argument, Status::no_index, words);
  };
  refused(soon(folder.path()), 3, "part 3 is none of 3 parts");
  refused(soon({}), 0, "folder is empty");
  refused(soon(folder.path(), -1), 0, "wait is negative");
  JobFolder options = soon(folder.path());
  options.look_every = std::chrono::milliseconds(0);
  refused(options, 0, "look_every is below 1 ms");
  expect_refused(make_job_transport(soon(folder.file("file", "x")), 0, 3, ""), StatusCode::io_error, Status::no_index,
                 "file: cannot be made");
}

}}  // namespace tessera::test
