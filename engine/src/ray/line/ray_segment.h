#pragma once
// A ray prepared for tracing in grid mode: checked, moved to the set's origin and cut to the scene's box, all in
// double.

#include "kernel/ray/ray_kernels.h"
#include "ray/line/facet_ray.h"
#include "tessera/geometry.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

static_assert(max_ray_component == kernel::RayBundle::max_component);

/// The part of a ray that can meet the scene, by arc length: points start + s * direction, 0 <= s <= reach.
struct RaySegment {
  Vec3 start;         ///< relative to the set's origin
  Vec3 direction;     ///< a unit vector
  double scale = 0;   ///< the length of the given direction: t = (offset + s) / scale
  double offset = 0;  ///< arc length from the ray's origin to start; may be negative
  double reach = 0;
  bool empty = true;  ///< misses the box

  double t_at(double s) const { return (offset + s) / scale; }
  /// Bounds the rounding of an s, by where the ray and the segment start.
  double rounding() const;
  /// Returns the ray for a tree of facets, from arc length s_near on; rounded outwards at the far end.
  FacetRay facet_ray(float s_near = 0) const;
};

/// Cuts a valid ray. `box` is relative to `origin`. The segment reaches `margin` further at both ends than box and
/// [tnear, tfar] say, because facets lie before or behind the surface.
RaySegment cut(const Ray& ray, const Vec3& origin, const Box3& box, double margin);

}}  // namespace tessera::abi_0_1
