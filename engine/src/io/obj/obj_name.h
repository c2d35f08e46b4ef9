#pragma once
// Names of groups in OBJ files.

#include <algorithm>
#include <string>
#include <string_view>

namespace tessera { inline namespace abi_0_1 {

/// `name` on one line, changed so that it reads back: no control characters, no # (begins a comment), no \ (continues
/// the line).
inline std::string obj_name(std::string_view name) {
  std::string line(name);
  const auto control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  std::replace_if(line.begin(), line.end(), control, ' ');
  for (std::size_t k = 0; k < line.size(); ++k)
    if (line[k] == '#' && (k == 0 || line[k - 1] == ' ')) line[k] = '_';
  while (!line.empty() && (line.back() == ' ' || line.back() == '\\')) line.pop_back();
  return line;
}

}}  // namespace tessera::abi_0_1
