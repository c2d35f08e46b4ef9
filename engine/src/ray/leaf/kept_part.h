#pragma once
// The part of a patch's rectangle that the loops of a face keep: a hull of it, and a coarse map.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "block/patch_trims.h"
#include "tessera/geometry.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

struct KeptPart {
  PatchUse use = PatchUse::whole;
  Domain hull;                        ///< if cut: holds all that is kept, and what rounding adds
  std::vector<std::uint32_t> pieces;  ///< those that may pass through the rectangle
};

/// Finds what loops keep of a rectangle. `region`: locates points; `pieces`: those of its pieces that cut the patch.
///
/// The boundary of what is kept consists of parts of pieces and of the rectangle's sides. The latter end at pieces, or
/// at corners that are kept. So the hull holds the pieces within the rectangle, and these corners.
KeptPart kept_part(const TrimRegion& region, std::span<const std::uint32_t> pieces, const Domain& rectangle);

/// The kept part of a rectangle by 8 x 8 squares of it: bit 8 i + j is that of square (i, j) along u and v.
struct KeptSquares {
  static constexpr unsigned per_side = 8;
  std::uint64_t inside = 0, outside = 0;  ///< squares that are kept or cut away as wholes

  PatchUse use() const { return ~inside == 0 ? PatchUse::whole : ~outside == 0 ? PatchUse::out : PatchUse::cut; }

  /// The side of all points of a box, in shares of the rectangle; its parts beyond [0, 1] do not count. `border`: the
  /// squares do not tell.
  TrimSide side_of(const Domain& box) const {
    const auto square = [](double x) { return static_cast<unsigned>(std::clamp(per_side * x, 0.0, per_side - 1.0)); };
    const unsigned i = square(box.u0), j = square(box.v0), i1 = square(box.u1), j1 = square(box.v1);
    if (i1 - i > 1) return TrimSide::border;
    const std::uint64_t column = (std::uint64_t{2} << j1) - (std::uint64_t{1} << j);
    const std::uint64_t bits = column << per_side * i | column << per_side * i1;
    return (inside & bits) == bits ? TrimSide::inside : (outside & bits) == bits ? TrimSide::outside : TrimSide::border;
  }
};

}}  // namespace tessera::abi_0_1
