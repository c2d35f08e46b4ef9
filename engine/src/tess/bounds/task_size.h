#pragma once
// How planning and meshing are cut into tasks.

#include <cstddef>

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::size_t patches_per_task = 64, blocks_per_task = 8, normals_per_task = 4;

}}  // namespace tessera::abi_0_1
