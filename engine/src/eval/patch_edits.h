#pragma once
// Writes new control points into a set, block by block; updates of grids and of meshes share it.

#include <cstdint>
#include <span>

#include "base/function_ref.h"
#include "eval/touched_blocks.h"
#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 {

/// Whether a plan still holds for a patch with these control points.
using KeepsShape = FunctionRef<bool(std::uint32_t patch, std::span<const Vec3> points)>;

/// Checks all new points, and gives each edited patch memory that no other patch shares. Errors, which leave the set's
/// values as they were: non_finite, stale (a patch that does not keep its shape), index = the first such edit;
/// cancelled.
Status prepare_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                     const Execution& execution, const KeepsShape* keeps_shape = nullptr);

/// Writes the edits of one block into its patches and their lanes. prepare_edits() has checked them. Threads: several
/// calls may run at once, for different blocks.
void pack_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                const kernel::KernelTable& kernels, std::uint32_t block);

/// Updates what the set derives from its points. Call it once, after pack_edits() of every touched block.
void finish_edits(PatchSet::Impl& set, const PatchEdits& edits);

}}  // namespace tessera::abi_0_1
