#pragma once
// The text of `tessera --help`, and of --help after a command.

#include <string>

#include "line/command_line.h"

namespace tessera::cli {

/// The help of a command, or of the tool itself, which lists its commands.
std::string help_text(const Command& tool, const Command& command);

}  // namespace tessera::cli
