// Units of length, as models and meshes name them.

#include <array>
#include <utility>

#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

double micrometres_in(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 8> units{
      {{"um", 1}, {"mm", 1e3}, {"cm", 1e4}, {"m", 1e6}, {"km", 1e9}, {"in", 25400}, {"inch", 25400}, {"ft", 304800}}};
  for (const auto& [name, length] : units)
    if (unit == name) return length;
  return 0;
}

}}  // namespace tessera::abi_0_1
