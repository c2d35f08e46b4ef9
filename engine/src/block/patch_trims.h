#pragma once
// The trims of a set: which of its patches loops cut, and by which pieces.

#include <cstdint>
#include <vector>

#include "tessera/patch_set.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

/// The patches of a set that the loops of their faces cut.
struct PatchTrims {
  struct Cut {
    std::uint32_t patch = 0;   ///< index into the set
    std::uint32_t region = 0;  ///< index into `regions`
    std::uint32_t place = 0;   ///< the patch of the region's grid, a * count_v + b
  };
  std::vector<TrimRegion> regions;   ///< made for patches: they locate no points
  std::vector<Cut> cuts;             ///< by growing patch
  std::vector<std::uint8_t> is_cut;  ///< `[patch]`
};

/// What a face keeps of one of its patches.
enum class PatchUse : std::uint8_t { out, whole, cut };

/// Returns the uses of a face's patches, `[a][b]`. A whole patch whose side a loop touches counts as cut, because its
/// mesh must have a vertex there.
std::vector<PatchUse> patch_uses(const TrimRegion& region);

}}  // namespace tessera::abi_0_1
