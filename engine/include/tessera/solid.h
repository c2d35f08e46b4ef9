#pragma once
// Tells which points lie inside of surfaces, closed or open: sides, winding numbers and signed distances.

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

/// On which side of a surface a point lies.
enum class PointSide : std::uint8_t {
  outside,        ///< or in a cavity
  inside,         ///< in the material
  unknown,        ///< the surface is open, and the point's winding number is 0.5 or -0.5 within 1e-6
  invalid_point,  ///< the point is not finite, or beyond max_ray_component
};

/// On which side a point lies, and how sure that is.
struct Containment {
  /// A closed surface tells it by the number of times that a ray leaves the body; with an open one, a point is `inside`
  /// if its winding number is above 0.5 in absolute value.
  PointSide side = PointSide::unknown;
  /// The surface is closed, and the ray meets it in certified hits alone, away from edges: the side is right unless the
  /// point lies on the surface up to rounding. Otherwise it is that of most rays, or of the winding number.
  bool certified = false;
};

/// A closed surface, such as the shells of a solid, or an open one, prepared for the question which points lie inside.
///
/// Method for closed surfaces: a point is inside if a ray from it leaves the surface an odd number of times. Where all
/// patches hang together, the first hit tells that, by the side on which the hit's surface faces outwards. That side is
/// found when the solid is made, by rays from each surface that count all others. Where a hit lies within the gap of an
/// edge, touches the surface or is not certified, rays in other directions follow. A closed surface must not cross
/// itself.
///
/// Method for open surfaces: see winding_numbers().
///
/// Memory: a byte per surface; with winding numbers also 5 bytes per patch and 480 bytes per arc of an open border, of
/// which a straight border is one and a full circle eight. The scene must outlive the solid (it may be moved). After an
/// edit of the set both are stale; make the solid anew after the scene's refit(). Threads: const calls from any number
/// of threads.
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

  /// Writes the generalized winding number of each point: the solid angle that the surface covers, seen from there, as
  /// a share of the whole sphere. A closed surface has 1 inside, and 0 outside and in cavities. An open one has numbers
  /// in between, which change smoothly, and jump by 1 across the surface.
  ///
  /// - `points`: in the model's coordinates.
  /// - `numbers`: at least as many; NaN for a point that is not finite, or beyond max_ray_component.
  ///
  /// Method: one ray's hits count, each by the side of its normal, and an integral along the open borders alone is
  /// added; the sum does not depend on the ray's direction. If a hit is not certified, or the ray passes a border too
  /// near to tell the side, another direction follows; after seven, the middle one of their numbers counts.
  ///
  /// Error: about 1e-6, estimated and not proven. On the surface itself, and within 1e-9 of the model's size from an
  /// open border, any number between those on both sides may come out. Edges that faces share count as closed, whatever
  /// their gap.
  ///
  /// Orientation: patches across an edge of two faces, or across a border with equal control points, are turned to face
  /// to one side; then patches whose open borders run beside each other within 1e-2 of the model's size. A closed part
  /// then faces outwards. An open part faces away from the centroid of its area, on the whole; if it does neither, as a
  /// plane, the normals of its first patch stay. Exceptions:
  ///
  /// - Where no orientation exists, as on a Moebius strip, the surface counts as cut open along the shorter ones of the
  ///   edges that contradict, and the number does not jump by 1 on every way across it.
  /// - A face that loops cut into several parts is turned as one, so that the number of a closed surface may be -1.
  ///
  /// The first call for a closed surface finds the orientation. Time: about that of all hits of a ray per point, and
  /// less than 0.1 microseconds per arc of an open border.
  ///
  /// Errors: buffer_too_small, stale, cancelled, out_of_memory.
  ///
  /// Source: Jacobson, Kavan, Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding
  /// numbers; Spainhour, Kreidler, Gunderman, Weiss 2024, Robust containment queries over collections of trimmed NURBS
  /// surfaces via generalized winding numbers.
  Status winding_numbers(std::span<const Vec3> points, std::span<double> numbers,
                         const Execution& execution = {}) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit Solid(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The distance of a point from a surface, and how sure it is.
struct SignedDistance {
  double distance = 0;                  ///< negative inside; NaN for an invalid point, and where the side is unknown
  PointSide side = PointSide::unknown;  ///< as Containment::side
  bool is_side_certified = false;       ///< whether the sign is sure, as Containment::certified
  bool is_nearest_certified = false;    ///< whether the absolute value is proven, as NearestFlags::certified
};
/// Writes the distance of each point from the surface, and how sure its sign and its value are.
///
/// - `scene`: of the same set as the solid's.
/// - `distances`: at least as many as there are points.
///
/// Errors: buffer_too_small, stale, cancelled, out_of_memory.
Status signed_distances(const Solid& solid, const PointScene& scene, std::span<const Vec3> points,
                        std::span<SignedDistance> distances, const Execution& execution = {});

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
