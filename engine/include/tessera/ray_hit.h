#pragma once
// Rays and their hits.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tessera/geometry.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The points origin + t * direction with tnear <= t <= tfar, in the model's coordinates.
///
/// The interval includes both ends. The refined t, in double, lies in it. A ray is valid under these conditions:
///
/// - origin and direction are finite, with components of at most 1.844e18
/// - the direction is not zero; it need not be a unit vector
/// - 0 <= tnear <= tfar; tfar may be infinite
/// - spawn_offset is 0 to 1.844e18
struct Ray {
  Vec3 origin = {}, direction = {};                       ///< in the model
  double tnear = 0;                                       ///< at least 0
  double tfar = std::numeric_limits<double>::infinity();  ///< at least tnear
  /// Exact mode: the largest distance from the origin to a surface that the ray starts on. 0: every root is a hit.
  ///
  /// A ray that starts on a surface meets it at t = 0 up to rounding. That one intersection with each surface within
  /// this distance is ignored; all others count. For an origin that is a hit's position, use RayScene::spawn_offset().
  ///
  /// Kantorovich's theorem decides which one that is: it shows that there is a root within this distance of the origin
  /// and no other near it. So other hits are kept, at however small a distance and angle, as long as the surface
  /// departs from the ray in between by more than the tolerance. Where it does not, as along a plane or over a chord of
  /// sqrt(8 tolerance / curvature), all of that stretch counts as the origin.
  double spawn_offset = 0;
};
/// The largest magnitude of a valid ray's components: about the square root of float's range.
inline constexpr double max_ray_component = 1.844e18;
/// Whether a ray is valid, as Ray says.
bool is_valid(const Ray& ray);

/// Whether a ray has a hit.
enum class HitKind : std::uint8_t {
  miss,
  hit,
  invalid_ray,  ///< treated as a miss
};

/// Exceptions that the numbers of a hit do not show.
struct HitFlags {
  bool unrefined : 1 = false;  ///< Newton did not converge inside the patch: t, position, u, v are those of the facet
  bool degenerate_normal : 1 = false;  ///< the normal is a limit at a degenerate point, or undefined (zero)
  /// Exact mode: the point lies on the ray within the tolerance, but it was not proven to be the only root of the
  /// surface near there. The ray touches the surface or runs along it (t is then good to about the square root of
  /// tolerance times size), meets a pole, or passes a border by less than the tolerance. Where it touches the border of
  /// patches that fold over each other there, as at a convex edge, RayScene::all() has two hits, one of them so
  /// flagged.
  bool uncertified : 1 = false;
  /// Exact mode: the bound on the work for one piece of a patch was reached, as where a surface runs along the ray or
  /// is folded up into a line. There may be other hits, also for a miss.
  bool incomplete : 1 = false;
  /// Exact mode, uncertified hits: the ray runs along the tangent plane, within 1e-3 of its direction.
  bool tangential : 1 = false;
  /// Exact mode, uncertified hits: the position is off the ray by more than rounding, yet within the tolerance.
  bool within_tolerance : 1 = false;
  /// Exact mode: the ray passes an edge of a shape within its gap, where the faces may leave a slit. A closest hit is
  /// the point of a face's loop there that is nearest to the ray. Hits of RayScene::all() are those of the ray moved
  /// sideways, out of the reach of edges. See RayScene::edge_gaps().
  bool edge : 1 = false;
  bool reserved : 1 = false;  ///< always false, so that no bit of the byte is left to chance
};

/// Where a ray meets a surface. For a miss or an invalid ray, only `kind` is meaningful; for a miss in exact mode also
/// `steps` and HitFlags::incomplete.
struct Hit {
  HitKind kind = HitKind::miss;  ///< whether the other members are meaningful
  HitFlags flags;                ///< exceptions that the numbers do not show
  /// Exact mode: the work, in pieces of patches visited and parts of them searched.
  std::uint16_t steps = 0;
  std::uint32_t surface = 0, patch = 0;  ///< PatchSource::surface, and the index in the set
  /// The value of `instance` in scenes of patches.
  static constexpr std::uint32_t no_instance = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t instance = no_instance;                ///< index, in a scene of instances
  double t = std::numeric_limits<double>::infinity();  ///< position = origin + t * direction, up to the residual
  double u = 0, v = 0;                                 ///< in the surface's domain
  double patch_u = 0, patch_v = 0;                     ///< in the patch, [0,1]^2
  Vec3 position;                                       ///< on the surface at (u,v)
  Vec3 normal;                                         ///< unit, along du x dv
  Vec3 du, dv;          ///< derivatives of the position by the surface's u and v; to about 1e-8
  double residual = 0;  ///< distance from the position to the ray; for an unrefined hit, to the surface at (u,v)
};

/// The hits of several rays: hits[first[k]] to hits[first[k + 1] - 1] are those of ray k, in the order of t.
struct HitLists {
  std::vector<Hit> hits;           ///< ray after ray
  std::vector<std::size_t> first;  ///< one more than there are rays
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
