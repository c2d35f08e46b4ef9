#include "tess/trimmed/patch_sides.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {

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
      if (at.*across == other.*across) continue;
      const auto line = std::lower_bound(lines.begin(), lines.end(), at.*across);
      if (line == lines.end() || *line != at.*across) continue;
      nodes_[static_cast<std::size_t>(line - lines.begin())].push_back(
          {at.*length, other.*across<at.*across, other.*across> at.*across});
    }
  }
  for (std::vector<Node>& nodes : nodes_) std::ranges::sort(nodes, {}, &Node::at);
}

std::vector<SidePoint> PatchSides::points(std::size_t line, std::size_t k, Segments segments) const {
  const double from = along_[k], to = along_[k + 1];
  std::vector<double> even;
  even.reserve(static_cast<std::size_t>(segments.rate()) + 1);
  for (int i = 0; i <= segments.rate(); ++i) even.push_back(line_at(from, to, segments, i));
  std::vector<SidePoint> points;
  points.reserve(even.size() + 1);
  bool below = starts_inside_, above = starts_inside_;
  auto node = nodes_[line].begin();
  const auto end = nodes_[line].end();
  std::size_t i = 1;
  for (double at = from;;) {
    for (; node != end && node->at <= at; ++node) below ^= node->below, above ^= node->above;
    points.push_back({at, below, above});
    const double next = node != end && node->at < to ? node->at : to;
    for (; i + 1 < even.size() && even[i] < next; ++i) {
      const double gap = std::min(even[i] - even[i - 1], even[i + 1] - even[i]) / 16;
      const bool is_free = (even[i] - at > gap || at == from) && (next - even[i] > gap || next == to);
      if ((below || above) && even[i] > at && is_free) points.push_back({even[i], below, above});
    }
    if (next == to) break;
    at = next;
  }
  points.push_back({to, false, false});
  return points;
}

}}  // namespace tessera::abi_0_1
