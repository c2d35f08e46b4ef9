#pragma once

#include <limits>

namespace tessera::inline abi_0_1 {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace tessera::inline abi_0_1
