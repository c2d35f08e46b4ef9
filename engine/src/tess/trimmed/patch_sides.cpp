#include "tess/trimmed/patch_sides.h"

#include <algorithm>

namespace tessera::inline abi_0_1 {

void PatchSides::set(std::span<const TrimPiece> pieces, double ParameterPoint::*across, std::span<const double> lines,
                     std::span<const double> along, bool starts_inside) {
  double ParameterPoint::*const length = across == &ParameterPoint::u ? &ParameterPoint::v : &ParameterPoint::u;
  along_ = along;
  starts_inside_ = starts_inside;
  nodes_.assign(lines.size(), {});
  for (const TrimPiece& piece : pieces) {
    const ParameterPoint ends[] = {piece.start(), piece.end()};
    for (const bool last : {false, true}) {
      const ParameterPoint &at = ends[last], &other = ends[!last];
      const auto line = std::lower_bound(lines.begin(), lines.end(), at.*across);
      if (line == lines.end() || *line != at.*across) continue;
      nodes_[static_cast<std::size_t>(line - lines.begin())].push_back(
          {at.*length, other.*across<at.*across, other.*across> at.*across});
    }
  }
  for (std::vector<Node>& nodes : nodes_) std::ranges::sort(nodes, {}, &Node::at);
}

std::vector<SidePoint> PatchSides::points(std::size_t line, std::size_t k, int rate) const {
  const double from = along_[k], to = along_[k + 1], step = (to - from) / rate;
  std::vector<SidePoint> points;
  bool below = starts_inside_, above = starts_inside_;
  auto node = nodes_[line].begin();
  const auto end = nodes_[line].end();
  for (double at = from;;) {
    for (; node != end && node->at <= at; ++node) below ^= node->below, above ^= node->above;
    points.push_back({at, below, above});
    const double next = node != end && node->at < to ? node->at : to;
    if (below || above) {
      for (int i = 1; i < rate; ++i) {
        const double even = from + (to - from) * i / rate;
        const bool is_free = (even - at > step / 16 || at == from) && (next - even > step / 16 || next == to);
        if (even > at && even < next && is_free) points.push_back({even, below, above});
      }
    }
    if (next == to) break;
    at = next;
  }
  points.push_back({to, false, false});
  return points;
}

}  // namespace tessera::inline abi_0_1
