#pragma once
// The rivals of exact rays: Embree's own geometries of the same patches, in robust scenes.

#include <embree3/rtcore.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "support/torus.h"
#include "tessera/execution.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::bench {

class Rival {
 public:
  /// Two triangles for each of quads x quads cells per patch.
  static Rival triangles(const PatchSet& set, int quads, Isa isa);
  /// Embree's grids with quads x quads cells per patch.
  static Rival grids(const PatchSet& set, int quads, Isa isa);
  /// The Catmull-Clark surface of the torus' control points, which is the B-spline surface; `rate` cells per patch.
  static Rival subdivision(const test::Torus& torus, int rate, Isa isa);

  /// Finds t of the closest hits, infinity for a miss; in the caller's arena.
  void closest(std::span<const Ray> rays, std::span<float> t) const;
  /// Finds t of the closest hits in packets of 16, for coherent rays.
  void closest_packets(std::span<const Ray> rays, std::span<float> t) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const;

  /// Builds the BVH anew, in the caller's arena.
  void build();
  std::size_t memory_bytes() const;

 private:
  struct State;
  struct Release {
    void operator()(State* state) const;
  };
  explicit Rival(Isa isa);
  void evaluate(const PatchSet& set, int quads, Isa isa, RTCGeometryType type);
  std::unique_ptr<State, Release> state_;
};

}  // namespace tessera::bench
