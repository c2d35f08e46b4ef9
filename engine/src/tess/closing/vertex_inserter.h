#pragma once
// Divides the triangles of patches at the vertices that edges need.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/bounds/chord_bound.h"
#include "tess/closing/patch_edit.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The patches whose triangles are divided.
struct DividedTriangles {
  std::vector<PatchEdit> edits;            ///< of whole patches, by growing patch
  std::vector<std::uint32_t> edited_cuts;  ///< by growing place among the cuts
  std::vector<std::uint32_t> numbers;      ///< by inserted vertex: its number in its patch; no_id if it is not used
};

/// Inserts the vertices that are used into their patches. Cut patches are divided in place: their distances are
/// extended to the new triangles. Patches are shared among the threads of the caller's arena. Errors: cancelled.
///
/// - `is_used`: by inserted vertex.
/// - `divisions`: by patch; `cuts`: the patches that loops cut, by growing patch.
/// - `chord`: of a cut patch. Threads: any number of calls.
/// - `cancel`: unless null. Cut patches may be divided in part then.
Result<DividedTriangles> divide_triangles(std::span<const InsertedVertex> inserted,
                                          std::span<const std::uint8_t> is_used, std::span<const Division> divisions,
                                          std::span<CutPatch> cuts, FunctionRef<ChordBound(std::uint32_t patch)> chord,
                                          const std::atomic<bool>* cancel);

}}  // namespace tessera::abi_0_1
