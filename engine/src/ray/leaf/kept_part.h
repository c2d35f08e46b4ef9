#pragma once
// The part of a rectangle of a patch that the loops of its face keep.

#include <cstdint>
#include <span>

#include "block/patch_trims.h"
#include "tessera/geometry.h"
#include "tessera/trim_region.h"

namespace tessera::inline abi_0_1 {

struct KeptPart {
  PatchUse use = PatchUse::whole;
  Domain hull;  ///< if cut: holds all that is kept, and what rounding adds
};

/// Finds what loops keep of a rectangle. `region`: locates points; `pieces`: those of its pieces that cut the patch.
///
/// The boundary of what is kept consists of parts of pieces and of the rectangle's sides. The latter end at pieces, or
/// at corners that are kept. So the hull holds the pieces within the rectangle, and these corners.
KeptPart kept_part(const TrimRegion& region, std::span<const std::uint32_t> pieces, const Domain& rectangle);

}  // namespace tessera::inline abi_0_1
