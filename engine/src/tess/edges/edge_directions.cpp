#include "tess/edges/edge_directions.h"

#include <cassert>

#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {

EdgeDirections::EdgeDirections(const PatchSet::Impl& set, const SharedEdges& edges, const VertexCopies& weld,
                               std::span<const PatchShape> whole, std::span<const PatchShape> all)
    : set_(set),
      edges_(edges),
      weld_(weld),
      weld_at_(4 * all.size(), no_id),
      leading_(edges.count(), no_id),
      first_welded_(edges.count(), no_id),
      next_welded_(weld.borders.size(), no_id) {
  for (std::uint32_t k = 0; k < weld.borders.size(); ++k) {
    const std::uint32_t border = weld.borders[k].to;
    weld_at_[border] = k;
    if (edge(border) != no_id) next_welded_[k] = std::exchange(first_welded_[edge(border)], k);
  }
  for (const std::span<const PatchShape> shapes : {whole, all})
    for (std::uint32_t border = 0; border < weld_at_.size(); ++border)
      if (!shapes[border / 4].is_curve && edge(border) != no_id && !is_welded(border) &&
          leading_[edge(border)] == no_id)
        leading_[edge(border)] = border;
}

bool EdgeDirections::is_same(std::uint32_t border, std::uint32_t other) const {
  const PackedBorder a(set_, border / 4, all_sides[border % 4]), b(set_, other / 4, all_sides[other % 4]);
  return equal(a, b, false) || equal(a, b, true);
}

bool EdgeDirections::runs_against_leading(std::uint32_t border) const {
  if (edge(border) == no_id) return false;
  const std::uint32_t lead = leading(edge(border));
  if (lead == no_id || border == lead) return false;
  if (is_welded(border)) return weld_.borders[weld_at_[border]].reversed;
  if (is_same(border, lead)) return runs_against(set_, border, lead);
  for (std::uint32_t k = first_welded_[edge(border)]; k != no_id; k = next_welded_[k]) {
    const VertexCopies::Border& copy = weld_.borders[k];
    if (is_same(border, copy.to)) return runs_against(set_, border, copy.to) != copy.reversed;
  }
  assert(false);  // the edge was found because one of these borders is the same bits
  return false;
}

bool EdgeDirections::hold() const {
  for (std::uint32_t border = 0; border < weld_at_.size(); ++border) {
    if (edge(border) == no_id || is_welded(border)) continue;
    const std::uint32_t lead = leading(edge(border));
    if (lead != no_id && lead != border && !is_same(border, lead)) return false;
  }
  return true;
}

}}  // namespace tessera::abi_0_1
