#pragma once
// New control points into a set, block by block: what updates of grids and of meshes have in common.

#include <cstdint>
#include <span>

#include "base/function_ref.h"
#include "eval/touched_blocks.h"
#include "tessera/execution.h"

namespace tessera::inline abi_0_1 {

/// Whether a patch with these control points is still what a plan was made for.
using KeepsShape = FunctionRef<bool(std::uint32_t patch, std::span<const Vec3> points)>;

/// Looks at all new points, and makes room for them: patches get memory of their own. Errors: non_finite, stale (a
/// patch that does not keep its shape), both of the first such edit; cancelled. What they are is then as before.
Status prepare_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                     const Execution& execution, const KeepsShape* keeps_shape = nullptr);

/// The edits of one block, prepared: into its patches and their lanes. Threads: any number, each a block of its own.
void pack_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                const kernel::KernelTable& kernels, std::uint32_t block);

/// Once all blocks are packed.
void finish_edits(PatchSet::Impl& set, const PatchEdits& edits);

}  // namespace tessera::inline abi_0_1
