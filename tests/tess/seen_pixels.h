#pragma once
// Measures in a camera's picture how far points of surfaces lie beside their triangles.

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/triangle_distance.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test {

/// A camera of the tests' own: a pinhole whose picture plane is spanned by two directions.
class Pinhole {
 public:
  explicit Pinhole(const View& view) : view_(view) {
    axis_ = normalized(view.target - view.eye);
    right_ = normalized(cross(axis_, view.up));
    down_ = cross(axis_, right_);
    const double shorter = std::min(view.width, view.height);
    pixel_ = view.orthographic ? view.extent / shorter : 2 * std::tan(view.field_of_view / 2) / shorter;
  }
  double depth(const Vec3& p) const { return dot(p - view_.eye, axis_); }
  /// A point in pixels from the middle.
  Vec3 seen(const Vec3& p) const {
    const double scale = 1 / (pixel_ * (view_.orthographic ? 1 : depth(p)));
    return {scale * dot(p - view_.eye, right_), scale * dot(p - view_.eye, down_), 0};
  }
  bool shows(const Vec3& p) const {
    if (!view_.orthographic && !(depth(p) >= near())) return false;
    const Vec3 at = seen(p);
    return std::abs(at.x) <= 0.5 * view_.width && std::abs(at.y) <= 0.5 * view_.height;
  }
  double near() const {
    return view_.near_distance > 0 ? view_.near_distance : 1e-3 * length(view_.target - view_.eye);
  }

 private:
  View view_;
  Vec3 axis_, right_, down_;
  double pixel_;
};

/// The point of a triangle nearest to p, from a fine lattice that is refined around the best.
inline Vec3 nearest_of_triangle(const Vec3& p, const Vec3 (&corner)[3]) {
  double a0 = 0, b0 = 0, step = 0.25;
  for (int round = 0; round < 24; ++round) {
    double best = 1e300, at_a = a0, at_b = b0;
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j) {
        const double a = a0 + i * step, b = b0 + j * step;
        if (a < 0 || b < 0 || a + b > 1) continue;
        const double distance = length(p - (corner[0] + a * (corner[1] - corner[0]) + b * (corner[2] - corner[0])));
        if (distance < best) best = distance, at_a = a, at_b = b;
      }
    a0 = at_a, b0 = at_b;
    step *= 0.5;
  }
  return corner[0] + a0 * (corner[1] - corner[0]) + b0 * (corner[2] - corner[0]);
}

struct PixelFound {
  double share = 0;      ///< the largest distance in the picture, over the patch's bound
  std::size_t seen = 0;  ///< points in the frame
};

inline PixelFound pixels_over_bound(const PatchSet& set, const Tessellation& plan, const Mesh& mesh, const View& view,
                                    Random& random) {
  const Pinhole camera(view);
  PixelFound found;
  const std::size_t step = std::max<std::size_t>(mesh.triangle_count() / 1500, 1);
  for (std::size_t t = random() % step; t < mesh.triangle_count(); t += step) {
    const std::uint32_t* k = &mesh.indices[3 * t];
    Vec3 corner[3];
    bool in_front = true;
    for (int c = 0; c < 3; ++c) {
      const float* p = &mesh.positions[3 * k[c]];
      corner[c] = mesh.origin + Vec3{p[0], p[1], p[2]};
      in_front = in_front && (view.orthographic || camera.depth(corner[c]) > 0);
    }
    for (int sample = 0; sample < 6; ++sample) {
      double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      if (sample == 0) a = b = 0.5;
      const auto mixed = [&](std::size_t c) {
        return (1 - a - b) * double(mesh.parameters[2 * k[0] + c]) + a * double(mesh.parameters[2 * k[1] + c]) +
               b * double(mesh.parameters[2 * k[2] + c]);
      };
      const Vec3 p = de_casteljau(set.patch(mesh.patches[t]), mixed(0), mixed(1));
      if (!camera.shows(p)) continue;
      ++found.seen;
      // Either the nearest point in the picture, or the image of the nearest in space: both belong to the triangle.
      double distance = 1e300;
      if (in_front)
        distance = distance_to_triangle(camera.seen(p), camera.seen(corner[0]), camera.seen(corner[1]),
                                        camera.seen(corner[2]));
      const double bound = plan.pixel_bounds()[mesh.patches[t]];
      if (!(distance <= bound)) {
        const Vec3 q = nearest_of_triangle(p, corner);
        if (view.orthographic || camera.depth(q) > 0)
          distance = std::min(distance, length(camera.seen(p) - camera.seen(q)));
      }
      found.share = std::max(found.share, bound > 0 ? distance / bound : (distance > 1e-9 ? 1e9 : 0));
    }
  }
  return found;
}

inline std::vector<View> views_of(const PatchSet& set) {
  const Vec3 centre = set.box().centre();
  const double size = set.box().diagonal();
  std::vector<View> views;
  const Vec3 from[] = {{1, -2, 0.7}, {-0.8, 0.3, 0.5}, {0.1, 0.45, -0.2}, {0.02, 0.03, 0.01}};  // outside; then inside
  for (const Vec3& way : from) {
    View view{.eye = centre + size * way, .target = centre};
    view.width = 640, view.height = 400;
    if (length(way) < 0.1) view.target = centre + size * Vec3{0.3, 0.2, -0.5}, view.near_distance = 1e-2 * size;
    views.push_back(view);
    view.orthographic = true;
    view.extent = 0.6 * size;
    views.push_back(view);
  }
  return views;
}

}  // namespace tessera::test
