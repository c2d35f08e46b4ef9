#pragma once
// Newton's method from the facets that a packet's rays hit to the true surface, lanes = rays of one patch. Refiner
// (refine.h) decides the rays that this leaves open.

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernel/ray/ray_kernels.h"
#include "ray/facet/refine.h"
#include "ray/line/ray_segment.h"
#include "ray/line/set_view.h"
#include "ray/tree/facet_tree.h"

namespace tessera { inline namespace abi_0_1 {

class PacketRefiner {
 public:
  static constexpr std::size_t size = kernel::PolishedRays::size;

  /// `cells`: how far a root may lie from its facet, in parameters.
  PacketRefiner(const SetView& set, const kernel::RayKernels& kernels, double cells)
      : set_(set), kernels_(kernels), cells_(cells) {}

  /// Finds the roots next to the facets that were hit, as far as Newton's method goes straight to them inside of their
  /// patches. Each ray gets the same result, whatever other rays there are.
  void run(std::span<const RaySegment> segments, std::span<const FacetHit> facets);
  bool has_root(std::size_t k) const { return (found_ >> k & 1u) != 0; }
  /// Returns the root of a ray that has one. `segment`, `facet`: those of the ray.
  SurfaceRoot root(std::size_t k, const RaySegment& segment, const FacetHit& facet) const;

 private:
  void polish(std::uint32_t patch, unsigned lanes, std::span<const RaySegment> segments,
              std::span<const FacetHit> facets);

  const SetView& set_;
  const kernel::RayKernels& kernels_;
  double cells_;
  unsigned found_ = 0;
  kernel::PolishedRays rays_;
};

}}  // namespace tessera::abi_0_1
