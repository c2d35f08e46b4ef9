#pragma once
// The manual page, in the macros of man(7).

#include <string>

#include "command_text.h"

namespace tessera::cli {

std::string man_page(const CommandText& tool, const std::string& version);

}  // namespace tessera::cli
