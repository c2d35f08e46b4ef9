#include "serve/browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <system_error>
#include <utility>

namespace tessera::cli {
namespace {

constexpr const char* program = "xdg-open";

}  // namespace

BrowserStart::BrowserStart(const std::string& address) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A session of its own: Ctrl-C ends this program, and not the browser.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string words[] = {program, address};
  std::array<char*, 3> argv{words[0].data(), words[1].data(), nullptr};
  if (const int error = ::posix_spawnp(&child_, program, &actions, &attributes, argv.data(), environ); error != 0) {
    fault_ = std::string(program) + " cannot be started: " + std::system_category().message(error);
    child_ = 0;
  }
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

std::string BrowserStart::take_fault() {
  int state = 0;
  if (child_ != 0 && ::waitpid(child_, &state, WNOHANG) != 0) {
    child_ = 0;
    if (WIFEXITED(state) && WEXITSTATUS(state) != 0)
      fault_ = std::string(program) + " ended with " + std::to_string(WEXITSTATUS(state));
  }
  return std::exchange(fault_, {});
}

}  // namespace tessera::cli
