#pragma once

namespace tessera::kernel {

/// Patches in a block: one a lane.
inline constexpr int block_lanes = 16;

}  // namespace tessera::kernel
