#include "ray/facet/packet_refine.h"

#include <algorithm>
#include <bit>

#include "ray/leaf/polished_root.h"
#include "ray/line/lane_vectors.h"
#include "ray/line/orthonormal_basis.h"

namespace tessera { inline namespace abi_0_1 {

void PacketRefiner::run(std::span<const RaySegment> segments, std::span<const FacetHit> facets) {
  found_ = 0;
  if (kernels_.packets == nullptr) return;
  unsigned open = 0;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    if (facets[k].hit()) open |= 1u << k;
  }
  while (open != 0) {
    const std::uint32_t patch = facets[static_cast<std::size_t>(std::countr_zero(open))].grid;
    unsigned lanes = 0;
    for (std::size_t k = 0; k < facets.size(); ++k) {
      if ((open >> k & 1u) != 0 && facets[k].grid == patch) lanes |= 1u << k;
    }
    open &= ~lanes;
    if (polished_side_by_side(set_.patch(patch))) polish(patch, lanes, segments, facets);
  }
}

void PacketRefiner::polish(std::uint32_t index, unsigned lanes, std::span<const RaySegment> segments,
                           std::span<const FacetHit> facets) {
  const BezierPatch& patch = set_.patch(index);
  const SceneFrame frame{set_.origin(), 1};
  for (std::size_t k = 0; k < facets.size(); ++k) {
    if ((lanes >> k & 1u) == 0) continue;
    const OrthonormalBasis across(segments[k].direction);
    const double u = std::clamp(facets[k].u, 0.0f, 1.0f), v = std::clamp(facets[k].v, 0.0f, 1.0f);
    if (std::has_single_bit(lanes)) {
      RayLine line;
      line.start = segments[k].start, line.direction = segments[k].direction;
      line.across[0] = across.first, line.across[1] = across.second;
      LeafRoot root;
      if (!tessera::polish(patch, frame, kernels_, line, {u, v, cells_, cells_}, false, root)) return;
      rays_.root_u[k] = root.u, rays_.root_v[k] = root.v, rays_.s[k] = root.s;
      put(root.position, rays_.position, k), put(root.du, rays_.du, k), put(root.dv, rays_.dv, k);
      found_ |= lanes;
      return;
    }
    put(segments[k].start, rays_.start, k), put(segments[k].direction, rays_.direction, k);
    put(across.first, rays_.across[0], k), put(across.second, rays_.across[1], k);
    rays_.u[k] = u, rays_.v[k] = v;
    rays_.reach_u[k] = rays_.reach_v[k] = cells_;
  }
  polish_side_by_side(patch, frame, kernels_, {}, rays_, lanes);
  for (std::size_t k = 0; k < facets.size(); ++k) {
    if ((lanes >> k & 1u) != 0 && rays_.state[k] == kernel::PolishedRays::found) found_ |= 1u << k;
  }
}

SurfaceRoot PacketRefiner::root(std::size_t k, const RaySegment& segment, const FacetHit& facet) const {
  const Vec3 position = get(rays_.position, k);
  const double s = rays_.s[k];
  return {facet.grid,
          rays_.root_u[k],
          rays_.root_v[k],
          s,
          set_.origin() + position,
          get(rays_.du, k),
          get(rays_.dv, k),
          length(position - segment.start - s * segment.direction)};
}

}}  // namespace tessera::abi_0_1
