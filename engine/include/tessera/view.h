#pragma once
// What a camera sees, for tolerances in pixels.

#include <numbers>

#include "tessera/vec.h"

#pragma GCC visibility push(default)
namespace tessera {

/// A picture of width x height square pixels, its middle in the direction of the target.
struct View {
  Vec3 eye, target;           ///< where the camera stands, and what it looks at
  Vec3 up{0, 0, 1};           ///< which way is up in the picture; another is taken where this is the direction of sight
  bool orthographic = false;  ///< parallel rays; else they meet in the eye
  double field_of_view = 40 * std::numbers::pi / 180;  ///< across the shorter side, radians, above 0 and below pi
  double extent = 1;               ///< orthographic: how much the shorter side shows, in the model's lengths
  int width = 1280, height = 800;  ///< of the picture, in pixels
  /// In perspective, what is less deep than this in front of the eye is not seen. 0: a thousandth of the target's distance.
  double near_distance = 0;
};

}  // namespace tessera
#pragma GCC visibility pop
