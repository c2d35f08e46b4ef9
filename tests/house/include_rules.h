#pragma once
// Checks the #include lines of one file of engine/ against the table of floors.

#include <string>
#include <string_view>
#include <vector>

#include "house/floors.h"

namespace tessera::house {

/// A file of the engine by its path relative to engine/, with its content.
struct SourceFile {
  std::string path;  ///< "src/FLOOR/..." or "include/tessera/NAME.h"
  std::string text;
};

/// The breaches of the rules, a sentence each: "src/io/mesh/ply.cpp:7: <tbb/...> is not for io". `known` holds the
/// paths of all files, against which "floor/file.h" and "tessera/file.h" are resolved.
std::vector<std::string> check_includes(const SourceFile& file, const FloorTable& table, const Names& known);

/// Floors that the call tessera_floor(NAME SOURCES ... BELOW ...) in a CMake file states, by floor. They only order the
/// build, but must agree with the table.
std::map<std::string, Names, std::less<>> floors_of_cmake(const std::string& text);

/// Paths that a text includes in quotes.
Names quoted_includes(const std::string& text);

}  // namespace tessera::house
