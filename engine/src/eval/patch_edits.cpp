#include "eval/patch_edits.h"

#include <array>
#include <string>

#include "kernel/table/kernel_table.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"
#include "surface/net/patch_pieces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t edits_per_task = 256;

/// Coordinates up to here, and an origin as near, fit blocks with weights that did: in float, with the smallest weight
/// 1e-9 of the largest, coefficients may reach 5.2e15 (largest_coefficient). Those of powers, up to 3^30 times as large
/// and times 1e7 where weights are near the largest double, may reach 5.2e33.
constexpr double plain_size = 0x1p40;

bool all_plain(std::span<const Vec3> points) {
  return kernel::default_kernels().within(&points.front().x, 3 * points.size(), plain_size);
}

/// Whether a patch with these points could be in a set of its own.
bool fits(const PatchSet::Impl& set, const BezierPatch& patch, std::span<const Vec3> points) {
  const Result<BezierPatch> edited = patch.with_points(points);
  return edited && PatchSet::make(std::span(&*edited, 1), {.blocks = set.kinds, .origin = set.origin}).ok();
}

std::span<const Vec3> points_of(const PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                                std::size_t edit) {
  return edits.points.subspan(touched.first_point(edit), set.patches[edits.patch[edit]].points().size());
}

Status points_error(std::size_t edit, std::uint32_t patch, std::span<const Vec3> points) {
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!is_finite(points[k]))
      return edit_error(StatusCode::non_finite, edit,
                        "control point " + std::to_string(k) + " of patch " + std::to_string(patch) + " is not finite");
  return edit_error(StatusCode::non_finite, edit,
                    "a control point of patch " + std::to_string(patch) +
                        ", relative to the set's origin, is outside the range of its blocks' numbers");
}

}  // namespace

Status prepare_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                     const Execution& execution, const KeepsShape* keeps_shape) {
  const bool near = max_abs(set.origin) <= plain_size;
  LeastIndex failed, reshaped;
  const Execution checking{.cancel = execution.cancel};
  Status status = parallel_for(edits.patch.size(), edits_per_task, checking, [&](std::size_t begin, std::size_t end) {
    const auto last = points_of(set, edits, touched, end - 1);
    const Vec3* first = points_of(set, edits, touched, begin).data();
    const bool plain = near && all_plain({first, last.data() + last.size()});
    for (std::size_t k = begin; k < end; ++k) {
      BezierPatch& patch = set.patches[edits.patch[k]];
      const auto points = points_of(set, edits, touched, k);
      if (!plain && !(near && all_plain(points)) && !fits(set, patch, points)) return failed.add(k);
      if (keeps_shape && !(*keeps_shape)(edits.patch[k], points)) return reshaped.add(k);
      PatchPieces::make_sole(patch);
    }
  });
  if (!status.ok()) return status;
  if (const std::size_t k = failed.index(); failed.found())
    return points_error(k, edits.patch[k], points_of(set, edits, touched, k));
  if (const std::size_t k = reshaped.index(); reshaped.found())
    return edit_error(
        StatusCode::stale, k,
        "the edit changes which edges of patch " + std::to_string(edits.patch[k]) + " are collapsed; make a new plan");
  return {};
}

void pack_edits(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                const kernel::KernelTable& kernels, std::uint32_t block) {
  constexpr std::size_t lanes = PatchSet::lanes;
  const std::uint32_t* patches = set.lane_patches.data() + block * lanes;
  const std::uint32_t* of_lane = touched.edits(block);
  const std::size_t used = set.lane_counts[block];
  const auto points = [&](std::size_t lane) { return edits.points.data() + touched.first_point(of_lane[lane]); };
  // All fit: they have been checked.
  if (touched.count(block) == set.lane_counts[block]) {
    std::array<const Vec3*, lanes> nets;
    for (std::size_t lane = 0; lane < lanes; ++lane) nets[lane] = points(lane < used ? lane : 0);
    (void)set.pack_block(block, kernels, nets.data());
    return;
  }
  for (std::size_t lane = 0; lane < used; ++lane) {
    if (of_lane[lane] == no_id) continue;
    PatchPieces::overwrite(set.patches[patches[lane]], points(lane));
    (void)set.pack_lanes(patches[lane]);
  }
}

void finish_edits(PatchSet::Impl& set, const PatchEdits& edits) {
  if (set.kinds.float_points || set.kinds.double_points)
    for (const std::uint32_t patch : edits.patch) set.note_threshold(patch);
  if (!edits.patch.empty()) set.note_edits(edits.patch);
}

}}  // namespace tessera::abi_0_1
