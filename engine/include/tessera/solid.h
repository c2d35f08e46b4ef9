#pragma once
// Tells which points lie inside of a closed surface, and their signed distances.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/nearest_points.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// On which side of a closed surface a point lies.
enum class PointSide : std::uint8_t {
  outside,        ///< or in a cavity
  inside,         ///< in the material
  unknown,        ///< rays in all directions that were tried contradict each other, as where the surface is open
  invalid_point,  ///< the point is not finite, or beyond max_ray_component
};

/// On which side a point lies, and how sure that is.
struct Containment {
  PointSide side = PointSide::unknown;  ///< by the number of times that a ray leaves the body
  /// The surface is closed, and the ray meets it in certified hits alone, away from edges: the side is right unless the
  /// point lies on the surface up to rounding. Otherwise it is that of most rays.
  bool certified = false;
};

/// A closed surface, such as the shells of a solid, prepared for the question which points lie inside.
///
/// Method: a point is inside if a ray from it leaves the surface an odd number of times. Where all patches hang
/// together, the first hit tells that, by the side on which the hit's surface faces outwards. That side is found when
/// the solid is made, by rays from each surface that count all others. Where a hit lies within the gap of an edge,
/// touches the surface or is not certified, rays in other directions follow. A surface must not cross itself.
///
/// Memory: a byte per surface; the scene must outlive the solid (it may be moved). After an edit of the set both are
/// stale; make the solid anew after the scene's refit(). Threads: const calls from any number of threads.
class Solid {
 public:
  /// Makes a solid of a ray scene's surfaces.
  ///
  /// Errors: unsupported (a scene in grid mode, of instances, or with RaySceneOptions::patches), stale, cancelled,
  /// out_of_memory.
  static Result<Solid> make(const RayScene& scene, const Execution& execution = {});

  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;
  ~Solid();

  /// Whether the surface is closed: each edge of a shape has an even number of coedges, and each other border of a
  /// patch has the control points of one other.
  bool is_closed() const;
  /// Returns the number of edges and borders where the surface is open.
  std::size_t open_borders() const;

  /// Tells for each point on which side it lies.
  ///
  /// - `points`: in the model's coordinates.
  /// - `sides`: at least as many.
  ///
  /// Errors: buffer_too_small, stale, cancelled, out_of_memory.
  Status contains(std::span<const Vec3> points, std::span<Containment> sides, const Execution& execution = {}) const;
  /// Tells on which side one point lies. A stale scene, as any error, returns PointSide::invalid_point.
  Containment contains(const Vec3& point) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit Solid(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Writes the distance of each point from the surface, negative inside. It is NaN for an invalid point, and where the
/// side is unknown.
///
/// - `scene`: of the same set as the solid's.
/// - `distances`: at least as many as there are points.
///
/// Errors: buffer_too_small, stale, cancelled, out_of_memory.
Status signed_distances(const Solid& solid, const PointScene& scene, std::span<const Vec3> points,
                        std::span<double> distances, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
