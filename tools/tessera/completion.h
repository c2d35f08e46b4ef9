#pragma once
// Scripts that complete the command line in a shell: commands, options, words that an option takes, and files.

#include <string>

#include "command_text.h"

namespace tessera::cli {

std::string bash_completion(const CommandText& tool);
std::string zsh_completion(const CommandText& tool);
std::string fish_completion(const CommandText& tool);

}  // namespace tessera::cli
