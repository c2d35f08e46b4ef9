#pragma once
// Embree's side of a ray scene: grids, or triangles and quads, over borrowed vertices, and the tracing of single rays
// and packets. Embree's types stay in embree_scene.cpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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

/// Sets flush-to-zero and denormals-are-zero for this thread, and masks floating-point exceptions, as Embree wants them
/// for speed; the end of the scope restores the caller's state. Doubles are affected too, so only tracing belongs
/// inside.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

/// Within a FlushDenormals: lets denormal numbers count again, for foreign code.
class CountDenormals {
 public:
  CountDenormals();
  ~CountDenormals();
  CountDenormals(const CountDenormals&) = delete;
  CountDenormals& operator=(const CountDenormals&) = delete;

 private:
  unsigned saved_;
};

/// Owns device, scene and geometry. Const calls from any number of threads, each inside a FlushDenormals.
class EmbreeScene {
 public:
  static constexpr std::size_t packet = 16;
  /// Embree does not check this before 4.4.1.
  static constexpr int max_vertices_per_side = 32767;

  /// Errors: internal and out_of_memory, from Embree.
  static Result<EmbreeScene> make();
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;
  ~EmbreeScene();

  /// Checks that so many vertices fit one scene. Errors: unsupported.
  static Status check_size(const GridVertices& vertices);
  /// Builds the BVH, in the caller's arena, and drops the one built before. `vertices` must stay in place and unchanged
  /// while the scene is used. On errors the scene is empty. Errors: unsupported (too many vertices), cancelled,
  /// Embree's own.
  Status build(const GridVertices& vertices, const Execution& execution);
  Status build(const FacetVertices& facets, const Execution& execution);

  FacetHit closest(const FacetRay& ray) const;
  bool occluded(const FacetRay& ray) const;
  /// Trace at most `packet` rays at once; faster than one by one if they are coherent.
  void closest(std::span<const FacetRay> rays, std::span<FacetHit> hits) const;
  void occluded(std::span<const FacetRay> rays, std::span<std::uint8_t> occluded) const;

  /// Returns the box of all vertices; empty before the first build.
  Box3 box() const;
  /// Returns the bytes that Embree has allocated.
  std::size_t memory_bytes() const;

 private:
  struct State;
  explicit EmbreeScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}}  // namespace tessera::abi_0_1
