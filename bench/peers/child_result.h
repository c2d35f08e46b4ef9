#pragma once
// Work in a process of its own, forked from this one, which returns one plain value: a crash or a hang of the work ends
// that process alone.

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace tessera::bench {

/// How the work ended: its value, or else why there is none.
template <class Value>
struct ChildResult {
  Value value{};
  std::string failure;  ///< empty if there is a value, else "ended by signal 11"
};

/// Runs `work` in a forked process for at most `seconds`. The caller must have no other thread, such as one of TBB's.
/// Throws std::runtime_error if no process can be started.
template <class Value, class Work>
ChildResult<Value> in_child(unsigned seconds, Work&& work) {
  static_assert(std::is_trivially_copyable_v<Value>);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    alarm(seconds);
    int status = 1;
    try {
      const Value value = work();
      status = write(ends[1], &value, sizeof value) == static_cast<ssize_t>(sizeof value) ? 0 : 1;
    } catch (const std::exception& error) {
      std::printf("  %s\n", error.what());
      std::fflush(stdout);
    }
    _exit(status);
  }
  close(ends[1]);
  ChildResult<Value> result;
  const bool whole = read(ends[0], &result.value, sizeof result.value) == static_cast<ssize_t>(sizeof result.value);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status))
    result.failure = WTERMSIG(status) == SIGALRM ? "no end within " + std::to_string(seconds) + " s"
                                                 : "ended by signal " + std::to_string(WTERMSIG(status));
  else if (!whole)
    result.failure = "failed";
  return result;
}

}  // namespace tessera::bench
