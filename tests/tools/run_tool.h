#pragma once
// Runs the command line tool as its users do, and catches what it says.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace tessera::test {

struct ToolRun {
  int status = -1;  ///< the exit status; 128 + n after signal n
  std::string output, errors;
};

/// A program, found as the shell would find it, with its arguments, in the folder `where`. `variables` ("NAME=value")
/// come before the environment. Neither stream is a terminal.
inline ToolRun run_program(const ScratchFolder& where, const std::vector<std::string>& program,
                           const std::vector<std::string>& variables = {}) {
  const ScratchFolder streams;
  const std::string output = streams / "output", errors = streams / "errors";
  std::vector<std::string> words{"/usr/bin/env", "-C", where.path().string()};
  words.insert(words.end(), variables.begin(), variables.end());
  words.insert(words.end(), program.begin(), program.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int state = 0;
  if (error != 0 || ::waitpid(child, &state, 0) != child) throw std::runtime_error("the tool could not be started");
  return {WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state), content_of(output), content_of(errors)};
}

/// The built binary with these arguments.
inline ToolRun run_tool(const ScratchFolder& where, std::vector<std::string> arguments,
                        const std::vector<std::string>& variables = {}) {
  arguments.insert(arguments.begin(), TESSERA_TOOL);
  return run_program(where, arguments, variables);
}

}  // namespace tessera::test
