#pragma once
// The edges of triangles that chords become where points lie on them.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/trimmed/cut_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Lists the edges of single triangles along the chords of loops. A chord on which other points lie becomes several; of
/// a part that two chords share nothing is left, since both of its sides are inside or outside.
///
/// - `cutter`: after it has triangulated a patch.
/// - `numbers`: by vertex of the cutter, the vertex of the patch, or no_id.
/// - `triangles`: of the patch.
std::vector<CutPatch::LoopSegment> divided_chords(const PatchCutter& cutter, std::span<const std::uint32_t> numbers,
                                                  std::span<const CutPatch::Triangle> triangles);

}}  // namespace tessera::abi_0_1
