#pragma once
// What surrounds the model: a sky, a sun, a floor. Radiances are linear, in units of a white wall in diffuse light.

#include <optional>

#include "tessera/geometry.h"

namespace tessera::render {

inline Vec3 multiply(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 mix(const Vec3& a, const Vec3& b, double share) { return (1 - share) * a + share * b; }

class Environment {
 public:
  /// A floor at the height of the box's bottom. From below it is not seen.
  Environment(const Box3& box, const Vec3& eye);

  Vec3 sun_direction() const;  ///< towards it, a unit vector
  Vec3 sun_light() const;      ///< what a white wall across the light reflects
  double sun_tangent() const;  ///< of half the sun's angle

  Vec3 sky(const Vec3& direction) const;

  /// Where a ray meets the floor in front of `farthest`.
  std::optional<double> floor(const Vec3& origin, const Vec3& direction, double farthest) const;
  Vec3 floor_colour() const;
  /// The floor's radiance after the haze between it and the eye; it becomes the sky's at the horizon.
  Vec3 in_haze(const Vec3& radiance, const Vec3& position, const Vec3& direction) const;
  /// What light comes from where `direction` leads if the model is not in the way: sky, or the floor, lit.
  Vec3 surroundings(const Vec3& direction) const;

 private:
  Vec3 centre_;
  double height_, size_;
  bool has_floor_;
};

}  // namespace tessera::render
