#pragma once
// The line of a ray in the coordinates that exact rays are traced in. A far origin costs it no accuracy.

#include <optional>

#include "tessera/geometry.h"
#include "tessera/ray_scene.h"

namespace tessera::inline abi_0_1 {

/// The coordinates of an exact scene: x = scale (p - centre), scale a power of two. The scene's box lies in [-1,1]^3,
/// and its longer side is at least 1 long: lengths there are shares of the model's size.
struct SceneFrame {
  Vec3 centre;
  double scale = 1;

  /// `box`: not empty, of a finite diagonal that is not zero.
  static SceneFrame around(const Box3& box);
  /// Whether a box that is not empty, another one perhaps, lies in it as well: the longer side may be 3/4 long, so that a
  /// size that goes up and down by a little does not ask for another frame each time.
  bool holds(const Box3& box) const;
  Vec3 to_scene(const Vec3& p) const { return scale * (p - centre); }
  Vec3 to_model(const Vec3& x) const { return centre + (1 / scale) * x; }
};

/// Points start + s * direction, s in [near, far] where tnear and tfar say so, in [enter, leave] where the scene's box
/// is, which is inside the former but for `slack`. The start is the line's point nearest to the scene's centre, right
/// to 2^-52 whatever the distance of the ray's origin, and the line is that of the ray: o + t D is taken in twice the
/// precision, and the rounding of the unit direction counts over the scene's size alone.
struct RayLine {
  Vec3 start, direction;  ///< the direction is a unit vector
  Vec3 across[2];         ///< with it an orthonormal basis
  double near = 0, far = 0;
  double enter = 0, leave = 0;
  double slack = 0;   ///< how far an s may be off for the rounding of t
  bool empty = true;  ///< passes the scene by
  double spawn = 0;   ///< as Ray::spawn_offset, with all rounding; 0 where the ray leaves no surface

  double t_at(double s) const { return base + (shift + s) / speed; }
  /// Where t is 0.
  double s_of_origin() const { return -base * speed - shift; }

  double base = 0, shift = 0, speed = 1;  ///< t = base + (shift + s) / speed
};

/// What lines are cut to: the scene's box in its own coordinates, and the rounding of start, direction and quotients.
Box3 clipping_box(const Box3& box);

/// The line of a valid ray. `box`: of the scene, in its own coordinates.
RayLine line_of(const Ray& ray, const SceneFrame& frame, const Box3& box);

/// A model that stands elsewhere, as rays need to know it.
struct Placement {
  Affine back;        ///< directions into the model's coordinates; the translation counts for nothing
  Vec3 centre;        ///< where the frame's centre stands
  double growth = 1;  ///< an upper bound of what lengths grow by on the way back

  /// Of a map whose condition number, of which this is a bound, is at most 1e8. Where it is larger: nothing.
  static std::optional<Placement> of(const Affine& to_world, const SceneFrame& frame);
};

/// The same where the model of the frame stands elsewhere. The map rounds the direction, and what lies between the line
/// and the model's centre, but no distance of the origin: by 2^-50 times the map's condition number, of the model's size.
RayLine line_of(const Ray& ray, const Placement& placement, const SceneFrame& frame, const Box3& box);

}  // namespace tessera::inline abi_0_1
