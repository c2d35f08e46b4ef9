#include "tess/plan/close_faces.h"

#include <algorithm>
#include <optional>

#include "block/patch_edges.h"
#include "tess/plan/face_cutter.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Vertices that are inserted into cut patches may make triangles a little larger than they were cut for: then these
/// patches are cut anew for less, and so are all to which vertices were added. In the last attempt they keep the bounds
/// that they have.
constexpr int max_closings = 6;

/// `[4 * patch + side]`: whether triangles of two patches have the same border.
std::vector<std::uint8_t> joined_borders(const SharedEdges& edges, const DividedPatches& patches) {
  std::vector<std::uint8_t> borders(edges.count(), 0), is_joined(4 * patches.divisions.size(), 0);
  const auto full_borders = [&](auto visit) {
    const auto visit_side = [&](std::size_t patch, Side side) {
      if (const std::uint32_t edge = edges.edge(patch, side); edge != no_id)
        visit(4 * patch + static_cast<std::size_t>(side), edge);
    };
    for (std::size_t patch = 0; patch < patches.divisions.size(); ++patch)
      for (const Side side : all_sides)
        if (!patches.divisions[patch].empty) visit_side(patch, side);
    for (const CutPatch& cut : patches.rare->cuts)
      for (const Side side : all_sides)
        if (cut.is_full[static_cast<std::size_t>(side)]) visit_side(cut.patch, side);
  };
  full_borders([&](std::size_t, std::uint32_t edge) { borders[edge] += borders[edge] < 2; });
  full_borders([&](std::size_t border, std::uint32_t edge) { is_joined[border] = borders[edge] == 2; });
  for (const CutPatch& cut : patches.rare->cuts)
    for (std::size_t side = 0; side < 4; ++side) is_joined[4 * cut.patch + side] |= cut.is_shared[side];
  return is_joined;
}

/// Bounds the cut patches whose triangles closing has divided, and lists those beyond their limits. Returns whether
/// there are any that cutting them anew may help.
bool bound_edited(FaceCutter& cutter, RarePatches& patches) {
  std::vector<std::uint32_t>& beyond = patches.beyond;
  const std::size_t known = beyond.size();
  for (const std::uint32_t c : patches.closed->edited_cuts) {
    const std::uint32_t patch = patches.cuts[c].patch;
    const double excess = cutter.bound_edited(c);
    const bool is_known = std::binary_search(beyond.begin(), beyond.begin() + std::ptrdiff_t(known), patch);
    const double factor = excess <= 1 || is_known ? 1 : 0.95 / excess;
    cutter.cut_again(c, factor);
    if (factor < 1) beyond.push_back(patch);
  }
  if (beyond.size() == known) return false;
  std::ranges::sort(beyond);
  return true;
}

}  // namespace

Status close_faces(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                   const Execution& execution) {
  const PatchSet::Impl& set = facts.needs.set();
  RarePatches& rare = patches.rare.make();
  std::optional<FaceCutter> cutter;
  if (set.trims) cutter.emplace(facts, request, patches, execution);
  for (int attempt = 0; attempt < max_closings; ++attempt) {
    if (cutter)
      if (Status status = cutter->cut(); !status.ok()) return status;
    const std::vector<std::uint8_t> is_joined = joined_borders(facts.borders.edges(), patches);
    const auto chord = [&](std::uint32_t patch) { return facts.needs.chord(patch); };
    Result<ClosedEdges> closed =
        close_edges({.set = set,
                     .runs = *facts.faces.runs,
                     .divisions = patches.divisions,
                     .cuts = rare.cuts,
                     .stations = cutter ? cutter->stations() : nullptr,
                     .is_joined = is_joined,
                     .chord = chord,
                     .max_gap = facts.needs.options().max_gap,
                     .lists_vertices = facts.needs.options().lists_edge_vertices,
                     .same_share = same_share(set, facts.needs.options().least_share * request.tolerance),
                     .cancel = execution.cancel});
    if (!closed) return closed.status();
    rare.closed = *std::move(closed);
    patches.open_edges = static_cast<std::uint32_t>(
        std::max(std::int64_t{0}, std::int64_t{patches.open_edges} - rare.closed->closed_segments));
    if (!cutter || !bound_edited(*cutter, rare)) break;
  }
  return {};
}

}}  // namespace tessera::abi_0_1
