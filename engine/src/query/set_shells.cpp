#include "query/set_shells.h"

#include <cstdint>
#include <vector>

#include "base/union_find.h"
#include "block/patch_edges.h"
#include "block/patch_trims.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Counts the edges with an odd number of coedges, marks the patches of faces that name edges, and joins the faces of
/// each edge.
std::size_t take_edges(const PatchEdges& edges, std::vector<std::uint8_t>& has_edges, UnionFind& shells) {
  std::vector<std::uint8_t> is_odd(edges.edges.size(), 0);
  std::vector<std::uint32_t> patch_of(edges.edges.size(), no_id);
  for (const PatchEdges::Face& face : edges.faces) {
    std::uint32_t first = no_id;
    for (const std::uint32_t patch : face.patches) {
      if (patch == no_id) continue;
      has_edges[patch] = 1;
      if (first == no_id) first = patch;
      shells.unite(first, patch);
    }
    for (const TrimLoop& loop : *face.loops) {
      for (const Coedge& coedge : loop.coedges) {
        if (coedge.edge == no_id) continue;
        const std::size_t edge = face.first_edge + coedge.edge;
        is_odd[edge] ^= 1;
        if (first == no_id) continue;
        if (patch_of[edge] != no_id) shells.unite(patch_of[edge], first);
        patch_of[edge] = first;
      }
    }
  }
  std::size_t open = 0;
  for (std::size_t k = 0; k < is_odd.size(); ++k) open += is_odd[k] != 0 && !edges.edges[k].degenerate;
  return open;
}

}  // namespace

SetShells find_shells(const SetView& set, const Adjacency& borders) {
  const PatchSet::Impl& impl = set.impl();
  const std::size_t count = set.patch_count();
  std::vector<std::uint8_t> has_edges(count, 0);
  UnionFind shells(count);
  SetShells out;
  if (impl.edges) out.open_borders = take_edges(*impl.edges, has_edges, shells);
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    const bool is_cut = impl.trims && impl.trims->is_cut[patch] != 0;
    if (has_edges[patch] == 0 && is_cut) ++out.open_borders;
    for (std::size_t side = 0; side < link_sides.size(); ++side) {
      const EdgeLink& link = borders.across(patch, static_cast<int>(side));
      if (link.exists()) shells.unite(patch, link.patch);
      if (has_edges[patch] == 0 && !link.exists() && !set.collapsed_sides(patch).has(link_sides[side]))
        ++out.open_borders;
    }
  }
  for (std::uint32_t patch = 0; patch < count; ++patch) out.count += shells.find(patch).member == patch;
  return out;
}

}}  // namespace tessera::abi_0_1
