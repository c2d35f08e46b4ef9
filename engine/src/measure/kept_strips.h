#pragma once
// The kept part of each patch of a face as strips, and the directions of its loops.

#include <cstdint>
#include <vector>

#include "base/internal_export.h"
#include "measure/strip.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// On which side of each piece the region is kept: 1 for smaller u, -1 for larger u, 0 for pieces of constant v. A
/// piece that others cross or touch counts by its middle, and makes `is_certain` false, as far as samples tell.
struct PieceSigns {
  std::vector<std::int8_t> signs;
  std::vector<bool> is_crossed;  ///< whether samples of the piece are on different sides
  bool is_certain = true;
};
PieceSigns piece_signs(const std::vector<TrimPiece>& pieces, bool starts_inside);

/// Tells for each piece whether the kept part lies on its left: 1, on its right: -1, or that it is a point: 0. A piece
/// that others cross counts by its middle, unless it is part of a kink in a loop that crosses itself nowhere else.
TESSERA_INTERNAL_EXPORT std::vector<std::int8_t> piece_directions(const TrimRegion::Impl& region);
/// Tells for each loop whether the kept part lies on its left: 1, on its right: -1, or that no piece tells: 0.
std::vector<std::int8_t> loop_directions(const TrimRegion::Impl& region, std::size_t loops);

/// The strips of one patch.
struct PatchStrips {
  std::size_t place;  ///< of the patch, a * count_v + b
  std::vector<CurveStrip> strips;
};
/// All strips of a face.
struct KeptStrips {
  std::vector<PatchStrips> patches;
  bool is_certain = true;  ///< whether no two pieces cross
};
/// Returns the strips of a region. `loop_error`: how far pieces that run along no parameter may be off, besides
/// TrimPiece::error.
KeptStrips kept_strips(const TrimRegion::Impl& region, const ParameterPoint& loop_error);

/// Returns the strip that is all of a patch.
inline CurveStrip whole_strip() { return {LocalCurve({1, 0}, {1, 1}), 0, 1, {}, true}; }

}}  // namespace tessera::abi_0_1
