#pragma once
// The line of a ray in the coordinates of exact rays, accurate even if the ray's origin is far away.

#include <cmath>
#include <optional>

#include "tessera/geometry.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

/// The coordinates of an exact scene: x = scale (p - centre), scale a power of two. The scene's box lies in [-1,1]^3,
/// and its longer side is at least 1 long: lengths there are shares of the model's size.
struct SceneFrame {
  Vec3 centre;
  double scale = 1;

  /// Makes the frame of `box`, which must not be empty; its diagonal must be finite and not zero.
  static SceneFrame around(const Box3& box);
  /// Returns whether a nonempty box, perhaps another one, also lies in the frame. Its longer side may be 3/4 long, so
  /// that a size that varies a little does not need a new frame each time.
  bool holds(const Box3& box) const;
  Vec3 to_scene(const Vec3& p) const { return scale * (p - centre); }
  Vec3 to_model(const Vec3& x) const { return centre + (1 / scale) * x; }
};

/// The points start + s * direction with s in [near, far] between tnear and tfar, and in [enter, leave] within the
/// scene's box. The second range is inside the first except for `slack`. The start is the line's point nearest to the
/// scene's centre, right to 2^-52 whatever the distance of the ray's origin. The line is that of the ray: o + t D is
/// computed in twice the precision, and the rounding of the unit direction counts only over the scene's size.
struct RayLine {
  Vec3 start, direction;  ///< the direction is a unit vector
  Vec3 across[2];         ///< an orthonormal basis with the direction
  double near = 0, far = 0;
  double enter = 0, leave = 0;
  double slack = 0;   ///< error bound of an s from the rounding of t
  bool empty = true;  ///< the line misses the scene
  double spawn = 0;   ///< Ray::spawn_offset with all rounding; 0 if the ray leaves no surface

  double t_at(double s) const { return base + (shift + s) / speed; }
  /// Returns the s where t is 0.
  double s_of_origin() const { return -base * speed - shift; }

  double base = 0, shift = 0, speed = 1;  ///< t = base + (shift + s) / speed
};

/// Returns the distance of a point, in the scene's coordinates, from a line.
inline double distance(const RayLine& line, const Vec3& point) {
  const Vec3 from_start = point - line.start;
  const double x = dot(line.across[0], from_start), y = dot(line.across[1], from_start);
  return std::sqrt(x * x + y * y);
}

/// Returns the box to which lines are cut: the scene's, in its own coordinates, with the rounding of start, direction
/// and quotients.
Box3 clipping_box(const Box3& box);

/// Returns the line of a valid ray. `box`: of the scene, in its own coordinates.
RayLine line_of(const Ray& ray, const SceneFrame& frame, const Box3& box);

/// Returns the line moved by a vector across it.
RayLine moved(const RayLine& line, const Vec3& by, const Box3& box);

/// The placement of a model elsewhere, in the form that rays need.
struct Placement {
  Affine back;        ///< maps directions into the model's coordinates; its translation is ignored
  Vec3 centre;        ///< the place of the frame's centre
  double growth = 1;  ///< an upper bound of the factor by which lengths grow on the way back

  /// Returns the placement of a map whose condition number, bounded from above, is at most 1e8; otherwise nothing.
  static std::optional<Placement> of(const Affine& to_world, const SceneFrame& frame);
};

/// Returns the line for a model of the frame that is placed elsewhere. The map rounds the direction, and the vector
/// between the line and the model's centre, but not the distance of the origin: by 2^-50 times the map's condition
/// number, relative to the model's size.
RayLine line_of(const Ray& ray, const Placement& placement, const SceneFrame& frame, const Box3& box);

}}  // namespace tessera::abi_0_1
