#pragma once
// The surroundings of the model: a sky, a sun, a floor. Radiances are linear, in units of a white wall in diffuse
// light.

#include <optional>

#include "render/up_axis.h"
#include "tessera/geometry.h"

namespace tessera::render {

inline Vec3 multiply(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 mix(const Vec3& a, const Vec3& b, double share) { return (1 - share) * a + share * b; }

class Environment {
 public:
  /// The floor is at the lower end of the box along `up`. It is invisible from below.
  Environment(const Box3& box, const Vec3& eye, Up up);

  Vec3 up() const { return from_z_up({0, 0, 1}, up_); }
  Vec3 sun_direction() const;  ///< towards the sun, a unit vector
  Vec3 sun_light() const;      ///< the light that a white wall across the sunlight reflects
  double sun_tangent() const;  ///< of half the sun's angle

  Vec3 sky(const Vec3& direction) const;

  /// The distance where a ray meets the floor in front of `farthest`.
  std::optional<double> floor(const Vec3& origin, const Vec3& direction, double farthest) const;
  Vec3 floor_colour() const;
  /// The floor's radiance through the haze between it and the eye; at the horizon it becomes the sky's.
  Vec3 in_haze(const Vec3& radiance, const Vec3& position, const Vec3& direction) const;
  /// The light from `direction` if the model is not in the way: sky, or the lit floor.
  Vec3 surroundings(const Vec3& direction) const;

 private:
  Up up_;
  Vec3 centre_;  // z is up, here and below
  double height_, size_;
  bool has_floor_;
};

}  // namespace tessera::render
