#pragma once
// From pixels to rays.

#include "render/render.h"

namespace tessera::render {

/// A three-quarter view from above that frames the whole box; z is up.
Camera fit_camera(const Box3& box, int width, int height);

/// Whether rays can be made from it.
Status check(const Camera& camera);

/// A checked camera and a picture.
class PixelRays {
 public:
  PixelRays(const Camera& camera, int width, int height);
  /// Through (x, y) in pixels from the picture's top left; the direction is a unit vector.
  Ray through(double x, double y) const;

 private:
  Vec3 eye_, corner_, right_, down_;  // directions to the top left corner, and to one pixel further
};

}  // namespace tessera::render
