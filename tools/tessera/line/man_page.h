#pragma once
// The manual page, in the macros of man(7).

#include <string>

#include "line/command_line.h"

namespace tessera::cli {

std::string man_page(const Command& tool, const std::string& version);

}  // namespace tessera::cli
