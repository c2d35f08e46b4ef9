#pragma once
// The width of a block of patches, for packing and for the kernels.

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// The number of patches in a block: one per lane.
inline constexpr int block_lanes = 16;

}}}  // namespace tessera::abi_0_1::kernel
