#include "tess/trimmed/patch_stations.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {

const RunStations* PatchStations::run_of(std::uint32_t piece) const {
  const auto after = std::ranges::upper_bound(within, piece, {}, &RunStations::first);
  return after != within.begin() && piece < (*(after - 1))->end ? *(after - 1) : nullptr;
}

void PatchStations::put_on_side(Side side, std::vector<SidePoint>& points) const {
  for (const RunStations* const run : on_sides) {
    if (run->side != side) continue;
    const auto first = std::ranges::upper_bound(points, run->low, {}, &SidePoint::at);
    if (first == points.begin()) continue;
    const SidePoint from = *(first - 1);
    // A run without length ends at the point before `first`, so the search for its end begins there.
    const auto last = std::ranges::lower_bound(first, points.end(), run->high, {}, &SidePoint::at);
    const auto is_other = [&](const SidePoint& of) { return of.below != from.below || of.above != from.above; };
    if ((is_far(side) ? from.above : from.below) || std::any_of(first, last, is_other)) continue;
    std::vector<SidePoint> inside;
    for (const double place : run->along) inside.push_back({place, from.below, from.above});
    points.insert(points.erase(first, last), inside.begin(), inside.end());
  }
}

}}  // namespace tessera::abi_0_1
