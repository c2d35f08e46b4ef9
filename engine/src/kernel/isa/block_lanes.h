#pragma once

namespace tessera::inline abi_0_1::kernel {

/// Patches in a block: one a lane.
inline constexpr int block_lanes = 16;

}  // namespace tessera::inline abi_0_1::kernel
