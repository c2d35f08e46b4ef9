#pragma once
// Scripts that complete the command line in a shell: commands, options, words that an option takes, and files.

#include <string>

#include "line/command_line.h"

namespace tessera::cli {

/// The help of an option in completions: the first sentence, without the default.
std::string short_text(const Option& option);
/// `text` with a backslash before each of `characters`.
std::string escaped(const std::string& text, const std::string& characters);
/// `text` in single quotes, as all shells accept it.
std::string shell_quoted(const std::string& text);

std::string bash_completion(const Command& tool);
std::string zsh_completion(const Command& tool);
std::string fish_completion(const Command& tool);

}  // namespace tessera::cli
