#pragma once
// Numbers and counts in messages.

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// The shortest text that reads back as the same double; "nan" for every NaN, whose sign means nothing. For messages of
/// failures, hence cold: the compiler optimises the calls for size.
[[gnu::cold]] inline std::string text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

/// "(x, y, z)".
[[gnu::cold]] inline std::string text(const Vec3& p) {
  return '(' + text(p.x) + ", " + text(p.y) + ", " + text(p.z) + ')';
}

/// "(x, y, z) to (x, y, z)".
[[gnu::cold]] inline std::string text(const Box3& box) { return text(box.lower) + " to " + text(box.upper); }

/// "1 vertex", "2 vertices"; `plural` if an s is not enough.
[[gnu::cold]] inline std::string counted(std::uint64_t count, std::string_view noun, std::string_view plural = {}) {
  std::string out = std::to_string(count) + ' ';
  out += count == 1 || plural.empty() ? noun : plural;
  if (count != 1 && plural.empty()) out += 's';
  return out;
}

}}  // namespace tessera::abi_0_1
