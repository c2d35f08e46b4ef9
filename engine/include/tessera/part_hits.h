#pragma once
// Rays against a model in parts: each part traces all rays in a scene of its own patches, and the nearest hit wins.
//
// Threads: each part calls on one thread; tracing runs in the caller's TBB arena.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/ray_hit.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"
#include "tessera/transport.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Returns the model's closest hits of this part's run of the rays, run_of_part(hits.size(), part, part_count).
///
/// `hits`: the closest hits of all rays, the same in every part, in the scene of this part's patches. Patch k of the
/// scene is patch first_patch + k of the model, and Hit::surface is the model's. Of hits at equal t the one of the
/// lowest patch wins. Patches of the result are the model's.
///
/// If all parts make their scenes with the model's box (RaySceneOptions::box), and otherwise equal options in exact
/// mode, these are the hits of a scene of the whole model, with the same bits but for two exceptions: `steps`, and
/// HitFlags::uncertified where a patch of another part makes a hit unsure. For a miss, HitFlags::incomplete is set if
/// it is in some part.
///
/// Errors: those of Transport::exchange(), unsupported (2^31 rays; patches of the model from 2^32 on; hits of
/// instances), count_mismatch (parts with different numbers of rays). Memory: 16 bytes per hit for the other parts, and
/// 160 for each ray of the run.
Result<std::vector<Hit>> merge_closest(Transport& transport, std::span<const Hit> hits, std::uint64_t first_patch);

/// Traces the rays in the scene, and merges the hits as merge_closest() does. If a part fails, all return its error.
/// Errors: those of RayScene::closest() and merge_closest(). Memory: 160 bytes per ray; give large lists in pieces.
Result<std::vector<Hit>> closest_in_parts(Transport& transport, const RayScene& scene, std::uint64_t first_patch,
                                          std::span<const Ray> rays, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
