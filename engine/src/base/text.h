#pragma once
// Numbers in messages.

#include <array>
#include <charconv>
#include <string>

namespace tessera {

/// The shortest text that reads back as the same double.
inline std::string text(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace tessera
