#pragma once
// The side to which normals of closed surfaces point, by the parity of hits.

#include <array>
#include <cstdint>
#include <span>

#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/geometry.h"
#include "tessera/ray_hit.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Directions without any regularity, so that few rays run along edges or lie in planes of a model.
inline constexpr std::array<Vec3, 7> ray_directions{{{0.36172, 0.51394, 0.77787},
                                                     {-0.62719, 0.70301, 0.33513},
                                                     {0.83192, -0.27103, 0.48417},
                                                     {-0.29981, -0.81377, 0.49793},
                                                     {0.54713, 0.62291, -0.55939},
                                                     {-0.70199, 0.17993, -0.68907},
                                                     {0.11939, -0.66109, -0.74073}}};
/// How far a direction is from a tangent plane at least for its side to count, as a sine.
inline constexpr double least_sine = 1e-6;

/// Whether a hit is certified, and away from edges.
inline bool is_clear(const HitFlags& flags) {
  return !flags.uncertified && !flags.incomplete && !flags.edge && !flags.degenerate_normal && !flags.unrefined;
}

/// The side to which the normals of a closed surface point.
enum Facing : std::int8_t { outwards = 1, inwards = -1, unsure = 0 };

/// Counts hits of rays. Const calls from any number of threads.
class HitParity {
 public:
  /// `scene`: in exact mode. `counted`: 1 for patches whose hits count, `[patch]`; empty: all.
  explicit HitParity(const RayScene::Impl& scene, std::span<const std::uint8_t> counted = {})
      : scene_(&scene), counted_(counted) {}

  /// Counts all hits of a ray. Errors: those of rays.
  Status count(const Ray& ray, bool& is_odd, bool& is_sure) const;
  /// Tells which way the normal at a point of a patch points. The rays along it and against it, which leave out the
  /// point itself, meet a closed surface an odd number of times together.
  Facing facing_at(std::uint32_t patch, double u, double v) const;
  /// Tells which way the normals of patches point, if three of their points agree. `signs`: -1 for patches whose
  /// normals are turned around, `[patch]`; empty: none.
  Facing facing_of(std::span<const std::uint32_t> patches, std::span<const std::int8_t> signs = {}) const;

 private:
  const RayScene::Impl* scene_;
  std::span<const std::uint8_t> counted_;
};

}}  // namespace tessera::abi_0_1
