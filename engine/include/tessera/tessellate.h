#pragma once
// A mesh in one call.
//
// Threads: any number of calls at once; work runs in the caller's TBB arena.

#include "tessera/execution.h"
#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/surface.h"
#include "tessera/tessellation.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Makes a set's mesh in one call, with all attributes, as Tessellation::make(), allocate() and run() do. Make a
/// Tessellation to edit the set, or to learn the bound, whether it is proven (certified()), and gap().
///
/// Errors: those of these three; the first of PatchSet::trim_faults(), for loops that cannot be used (index = the
/// surface, or the face of a shape); invalid_argument (patches_beyond_tolerance() or crossed_patches(): a tolerance
/// that the mesh would not keep; index = the first such patch).
Result<Mesh> tessellate(const PatchSet& set, const TessellationOptions& options, const Execution& execution = {});
/// Makes a model's mesh in one call, from make_patch_set(), with parts_by_surface(). Errors: as above, and those of
/// these two.
Result<Mesh> tessellate(const Model& model, const TessellationOptions& options, const Execution& execution = {});
/// Makes the mesh of one surface of any kind in one call. Errors: as for a model.
Result<Mesh> tessellate(const Surface& surface, const TessellationOptions& options, const Execution& execution = {});
/// Makes the mesh of a shape in one call, from make_patch_set(), with parts_by_face(). Along the edges that faces share
/// it is closed, unless Joining::close_edges is false. Errors: as for a model.
Result<Mesh> tessellate(const Shape& shape, const TessellationOptions& options, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
