// Programs as child processes.

#include "io/cad/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "support/errors.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

using namespace std::chrono_literals;
constexpr std::size_t plenty = std::size_t{1} << 27;

Result<ChildProcess> shell(const std::string& script) { return ChildProcess::start({"/bin/sh", "-c", script}); }

/// All that a script prints, up to its end.
std::string printed(const std::string& script) {
  Result<ChildProcess> child = shell(script);
  std::string bytes;
  EXPECT_TRUE(child.ok() && child->read(bytes, plenty, {}) == Reading::ended) << script;
  return bytes;
}

TEST(ChildProcess, ItsOutputIsReadUpToTheSizeOrTheEnd) {
  EXPECT_EQ(printed("printf one; printf two >&2"), "onetwo");
  EXPECT_EQ(printed("true"), "");
  EXPECT_EQ(printed("head -c 5000000 /dev/zero"), std::string(5'000'000, '\0'));
  Result<ChildProcess> child = shell("printf abcdef; sleep 60");
  ASSERT_TRUE(child.ok());
  std::string bytes;
  EXPECT_EQ(child->read(bytes, 4, {}), Reading::whole);
  EXPECT_EQ(bytes, "abcd");
  EXPECT_EQ(child->read(bytes, 6, {}), Reading::whole);
  EXPECT_EQ(bytes, "abcdef");
}

TEST(ChildProcess, TimeAndPatienceEnd) {
  Result<ChildProcess> child = shell("sleep 60");
  ASSERT_TRUE(child.ok());
  std::string bytes;
  EXPECT_EQ(child->read(bytes, 1, {50ms, nullptr}), Reading::late);
  std::atomic<bool> cancel{false};
  std::thread later([&] {
    std::this_thread::sleep_for(50ms);
    cancel = true;
  });
  EXPECT_EQ(child->read(bytes, 1, {{}, &cancel}), Reading::cancelled);
  later.join();
}

TEST(ChildProcess, TheStatusIsThatOfTheEnd) {
  const auto end = [](const std::string& script) { return shell(script)->collect(10s).value_or(-1); };
  const int done = end("exit 3"), crashed = end("kill -SEGV $$");
  EXPECT_TRUE(WIFEXITED(done) && WEXITSTATUS(done) == 3) << done;
  EXPECT_TRUE(WIFSIGNALED(crashed) && WTERMSIG(crashed) == SIGSEGV) << crashed;
  Result<ChildProcess> stubborn = shell("exec >/dev/null 2>&1; sleep 60");
  std::string bytes;
  ASSERT_EQ(stubborn->read(bytes, 1, {}), Reading::ended);
  EXPECT_FALSE(stubborn->collect(20ms)) << "it ended by itself";
}

TEST(ChildProcess, FilesThatAreNoProgramsAreErrors) {
  const ScratchFolder folder;
  const auto expect = [](const std::string& file, const std::string& words) {
    expect_refused(ChildProcess::start({file}), StatusCode::io_error, Status::no_index, "cannot be started: " + words);
  };
  expect(folder / "none", "No such file or directory");
  expect(folder.path().string(), "Permission denied");
  expect(folder.file("text", "words"), "Permission denied");
  const std::string broken = folder.file("broken",
                                         "\x7f"
                                         "ELF, but not really");
  std::filesystem::permissions(broken, std::filesystem::perms::owner_all);
  expect(broken, "Exec format error");
}

TEST(ChildProcess, LeavesNoneBehind) {
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(printed("printf x"), "x");
    EXPECT_TRUE(shell("sleep 60").ok());  // killed by the destructor
  }
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was not collected";
}

TEST(ChildProcess, NeedsNoStatus) {
  // Programs that ignore their children get none.
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  Result<ChildProcess> child = shell("printf x; exit 3");
  std::string bytes;
  const Reading end = child->read(bytes, 2, {});
  const std::optional<int> status = child->collect(10s);
  std::signal(SIGCHLD, before);
  EXPECT_EQ(end, Reading::ended);
  EXPECT_EQ(bytes, "x");
  EXPECT_FALSE(status);
}

/// A daemon has closed its streams: the pipe then takes their places.
TEST(ChildProcess, NeedsNoStreamsOfItsParent) {
  EXPECT_EXIT(
      {
        for (int stream = 0; stream < 3; ++stream) ::close(stream);
        ::_exit(printed("printf x") == "x" ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

TEST(ChildProcess, InheritsNeitherDescriptorsNorBlockedSignals) {
  const int before = ::dup(STDERR_FILENO);  // without close-on-exec
  sigset_t blocked, old;
  sigfillset(&blocked);
  ::pthread_sigmask(SIG_SETMASK, &blocked, &old);
  const std::string status = printed("ls /proc/self/fd | wc -l; exec grep SigBlk /proc/self/status");
  ::pthread_sigmask(SIG_SETMASK, &old, nullptr);
  ::close(before);
  EXPECT_EQ(status, "4\nSigBlk:\t0000000000000000\n");  // the streams, and the folder that ls reads
}

TEST(ChildProcess, IgnoresTheHangUpThatItsParentIgnoresButNoCrash) {
  const auto hang_up = std::signal(SIGHUP, SIG_IGN), pipe = std::signal(SIGPIPE, SIG_IGN);
  const std::string words = printed("kill -HUP $$; echo up; kill -PIPE $$; echo lost");
  std::signal(SIGHUP, hang_up);
  std::signal(SIGPIPE, pipe);
  EXPECT_EQ(words, "up\n");
}

}}  // namespace tessera::test
