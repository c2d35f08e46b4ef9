#pragma once
// The project's own sources, as the tests of the house read them.

#include <string>
#include <vector>

namespace tessera::house {

/// Paths relative to the root of all regular files under `folder` (also relative), sorted. Throws if there is no such
/// folder.
std::vector<std::string> files_under(const std::string& folder);

/// The content of a file by its path relative to the root. Throws if it cannot be read.
std::string read_text(const std::string& path);

}  // namespace tessera::house
