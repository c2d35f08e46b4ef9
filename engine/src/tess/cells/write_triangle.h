#pragma once

#include <cstdint>

namespace tessera { inline namespace abi_0_1 {

/// Writes the corners of a triangle. Returns where the next one goes.
inline std::uint32_t* write(std::uint32_t* to, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  to[0] = a;
  to[1] = b;
  to[2] = c;
  return to + 3;
}

}}  // namespace tessera::abi_0_1
