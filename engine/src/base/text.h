#pragma once
// Numbers in messages.

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace tessera::inline abi_0_1 {

/// The shortest text that reads back as the same double; "nan" for every NaN, whose sign means nothing. For messages of
/// failures, hence cold: the compiler optimises the calls for size.
[[gnu::cold]] inline std::string text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace tessera::inline abi_0_1
