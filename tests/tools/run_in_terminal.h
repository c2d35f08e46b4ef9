#pragma once
// Runs the command line tool on a terminal of its own.

#include <fcntl.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace tessera::test {

struct TerminalRun {
  int status = -1;
  std::string screen;  ///< all bytes that the terminal got
  std::string output;  ///< other output: standard output if `errors_only`
};

struct TerminalKind {
  int columns = 80, rows = 24;
  bool errors_only = false;  ///< standard output is a file
  std::vector<std::string> variables{"TERM=xterm-256color", "COLORTERM=truecolor", "NO_COLOR="};
};

/// Whether this machine has pseudo-terminals: some containers have none.
inline bool has_pseudo_terminals() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master >= 0) ::close(master);
  return master >= 0;
}

/// The built binary with these arguments, in the folder `where`; its streams are a pseudo-terminal.
inline TerminalRun run_in_terminal(const ScratchFolder& where, const std::vector<std::string>& arguments,
                                   const TerminalKind& kind = {}) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 64> slave{};
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0 ||
      ::ptsname_r(master, slave.data(), slave.size()) != 0)
    throw std::runtime_error("no pseudo-terminal");
  winsize size{};
  size.ws_col = static_cast<unsigned short>(kind.columns);
  size.ws_row = static_cast<unsigned short>(kind.rows);
  ::ioctl(master, TIOCSWINSZ, &size);

  std::vector<std::string> words{"/usr/bin/env", "-C", where.path().string()};
  words.insert(words.end(), kind.variables.begin(), kind.variables.end());
  words.emplace_back(TESSERA_TOOL);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const ScratchFolder streams;
  const std::string output = streams / "output";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, slave.data(), O_WRONLY | O_NOCTTY, 0);
  if (kind.errors_only) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT, 0600);
  } else {
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  }
  pid_t child = 0;
  const int error = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("the program could not be started");

  TerminalRun run;
  std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = ::read(master, bytes.data(), bytes.size())) > 0;)
    run.screen.append(bytes.data(), static_cast<std::size_t>(count));
  int state = 0;
  ::waitpid(child, &state, 0);
  ::close(master);
  run.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  if (kind.errors_only) run.output = content_of(output);
  return run;
}

}  // namespace tessera::test
