#pragma once
// Runs the command line tool as its users do, and captures its output.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace tessera::test {

struct ToolRun {
  int status = -1;  ///< the exit status; 128 + n after signal n
  std::string output, errors;
};

/// A running program: found as the shell would find it, with its arguments, in the folder `where`. `variables`
/// ("NAME=value") come before the environment. Neither stream is a terminal, and no signal is ignored.
class RunningProgram {
 public:
  RunningProgram(const ScratchFolder& where, const std::vector<std::string>& program,
                 const std::vector<std::string>& variables = {}) {
    std::vector<std::string> words{"/usr/bin/env", "-C", where.path().string()};
    words.insert(words.end(), variables.begin(), variables.end());
    words.insert(words.end(), program.begin(), program.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors_.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error = ::posix_spawn(&child_, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("the program could not be started");
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() {
    if (child_ == 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }

  pid_t id() const { return child_; }
  void signal(int number) const { ::kill(child_, number); }
  ToolRun wait() {
    int state = 0;
    if (::waitpid(child_, &state, 0) != child_) throw std::runtime_error("the program is lost");
    child_ = 0;
    return {WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state), content_of(output_), content_of(errors_)};
  }

 private:
  ScratchFolder streams_;
  std::string output_ = streams_ / "output", errors_ = streams_ / "errors";
  pid_t child_ = 0;
};

/// Runs a program to its end.
inline ToolRun run_program(const ScratchFolder& where, const std::vector<std::string>& program,
                           const std::vector<std::string>& variables = {}) {
  return RunningProgram(where, program, variables).wait();
}

/// The built binary with these arguments.
inline ToolRun run_tool(const ScratchFolder& where, std::vector<std::string> arguments,
                        const std::vector<std::string>& variables = {}) {
  arguments.insert(arguments.begin(), TESSERA_TOOL);
  return run_program(where, arguments, variables);
}

}  // namespace tessera::test
