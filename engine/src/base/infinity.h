#pragma once

#include <limits>

namespace tessera { inline namespace abi_0_1 {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}}  // namespace tessera::abi_0_1
