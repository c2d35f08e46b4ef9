#pragma once
// Makes rays of pixels.

#include "render/render.h"

namespace tessera::render {

/// A three-quarter view from above that frames the whole box.
Camera fit_camera(const Box3& box, int width, int height, Up up);
/// The camera of the settings, or one that fits the box.
Camera choose_camera(const Settings& settings, const Box3& box);

/// Checks that the camera can make rays.
Status check(const Camera& camera);

/// The rays of a checked camera for a picture.
class PixelRays {
 public:
  PixelRays(const Camera& camera, int width, int height);
  /// The ray through (x, y) in pixels from the picture's top left; its direction is a unit vector.
  Ray through(double x, double y) const;
  /// The side of a pixel at distance 1 along the view.
  double pixel() const { return length(right_); }

 private:
  Vec3 eye_, corner_, right_, down_;  // to the top left corner, and steps to the next pixel
};

}  // namespace tessera::render
