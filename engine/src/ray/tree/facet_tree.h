#pragma once
// The tree over facets: grids, or triangles and quads, over borrowed vertices, and the tracing of single rays and
// packets.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "ray/line/facet_ray.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Grids of height x width vertices each, one after the other, 3 floats per vertex, rows (of equal height index)
/// contiguous.
struct GridVertices {
  const float* data =
      nullptr;  ///< one float more than 3 * vertices must be readable: the last vertex is read as 16 bytes
  std::size_t grids = 0;
  int height = 0, width = 0;
};

/// Triangles and quads by their corners, 3 and 4 indices each, over vertices. The last vertex is read as in
/// GridVertices.
struct FacetVertices {
  const float* data = nullptr;
  std::size_t vertices = 0;
  std::span<const std::uint32_t> triangles, quads;
};

/// The place where a ray meets a facet. On a grid u runs along its height and v along its width, both from 0 to 1. For
/// triangles and quads `grid` counts first triangles and then quads, and u and v are Embree's v and u.
struct FacetHit {
  static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t grid = nothing;
  float t = 0, u = 0, v = 0;
  bool hit() const { return grid != nothing; }
};

/// Const calls from any number of threads, each inside a FlushDenormals.
class FacetTree {
 public:
  static constexpr std::size_t packet = 16;
  /// Embree does not check this before 4.4.1.
  static constexpr int max_vertices_per_side = 32767;

  virtual ~FacetTree() = default;

  /// Checks that so many vertices fit one tree. Errors: unsupported.
  static Status check_size(const GridVertices& vertices);
  /// Builds the tree, in the caller's arena, and drops the one built before. `vertices` must stay in place and
  /// unchanged while the tree is used. On errors the tree is empty. Errors: unsupported (too many vertices), cancelled,
  /// out_of_memory, Embree's own.
  virtual Status build(const GridVertices& vertices, const Execution& execution) = 0;
  virtual Status build(const FacetVertices& facets, const Execution& execution) = 0;

  virtual FacetHit closest(const FacetRay& ray) const = 0;
  virtual bool occluded(const FacetRay& ray) const = 0;
  /// Trace 1 to `packet` rays at once; faster than one by one if they are coherent.
  virtual void closest(std::span<const FacetRay> rays, std::span<FacetHit> hits) const = 0;
  virtual void occluded(std::span<const FacetRay> rays, std::span<std::uint8_t> occluded) const = 0;

  /// Returns the box of all vertices; empty before the first build.
  virtual Box3 box() const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

}}  // namespace tessera::abi_0_1
