#include "render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tessera/ray_scene.h"

namespace tessera::render {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double azimuth = -62 * degree, elevation = 14 * degree;  // of the eye as seen from the model
constexpr double fill = 0.84;                                      // share of the picture that the box takes
constexpr double lowered = 0.07;                                   // share of half the height: room for the sky

struct Axes {
  Vec3 right, up, back;

  Axes(const Vec3& eye, const Vec3& target, const Vec3& up_hint) : back(normalized(eye - target)) {
    right = cross(normalized(up_hint), back);
    if (!(length(right) > 1e-6)) right = cross(std::abs(back.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, back);
    right = normalized(right);
    up = cross(back, right);
  }
};

std::array<Vec3, 8> corners(const Box3& box) {
  std::array<Vec3, 8> out;
  for (std::size_t k = 0; k < 8; ++k) {
    out[k] = {k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y, k & 4 ? box.upper.z : box.lower.z};
  }
  return out;
}

}  // namespace

Camera fit_camera(const Box3& box, int width, int height, Up up) {
  Camera camera;
  camera.up = from_z_up({0, 0, 1}, up);
  const Vec3 back = from_z_up(
      {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)}, up);
  const Axes axes(back, {}, camera.up);
  const double tangent = fill * std::tan(camera.fov_degrees / 2 * degree), shorter = std::min(width, height);
  const double tangent_x = tangent * width / shorter, tangent_y = tangent * height / shorter;
  // A corner (x, y, z) in the camera's axes is visible if |x - cx| <= tangent_x (d - z), and likewise for y. The
  // narrowest pair of such planes gives the centre and the distance d.
  double right = -INFINITY, left = -INFINITY, top = -INFINITY, bottom = -INFINITY, nearest = -INFINITY;
  for (const Vec3& corner : corners(box)) {
    const Vec3 p = corner - box.centre();
    const double x = dot(p, axes.right), y = dot(p, axes.up), z = dot(p, axes.back);
    right = std::max(right, x + tangent_x * z), left = std::max(left, -x + tangent_x * z);
    top = std::max(top, y + tangent_y * z), bottom = std::max(bottom, -y + tangent_y * z);
    nearest = std::max(nearest, z);
  }
  const double distance =
      std::max({(right + left) / (2 * tangent_x), (top + bottom) / (2 * tangent_y), nearest + 1e-3 * box.diagonal()});
  const double rise = 0.5 * (top - bottom) + lowered * distance * tangent_y;
  camera.target = box.centre() + 0.5 * (right - left) * axes.right + rise * axes.up;
  camera.eye = camera.target + distance * back;
  return camera;
}

Camera choose_camera(const Settings& settings, const Box3& box) {
  return settings.camera ? *settings.camera : fit_camera(box, settings.width, settings.height, settings.up);
}

Status check(const Camera& camera) {
  const auto bad = [](const char* why) { return Status(StatusCode::invalid_argument, why); };
  // The comparisons fail for NaN.
  const auto in_range = [](const Vec3& v) { return is_finite(v) && max_abs(v) <= max_ray_component; };
  if (!in_range(camera.eye) || !in_range(camera.target) || !is_finite(camera.up)) {
    return bad("the eye and the target need coordinates of at most 1.844e18, as rays do, and up must be finite");
  }
  if (camera.eye == camera.target) return bad("the eye and the target are the same point");
  if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180)) {
    return bad("the field of view must lie between 0 and 180 degrees");
  }
  return {};
}

PixelRays::PixelRays(const Camera& camera, int width, int height) : eye_(camera.eye) {
  const Axes axes(camera.eye, camera.target, camera.up);
  const double pixel = 2 * std::tan(camera.fov_degrees / 2 * degree) / std::min(width, height);
  right_ = pixel * axes.right;
  down_ = -pixel * axes.up;
  corner_ = -axes.back - 0.5 * width * right_ - 0.5 * height * down_;
}

Ray PixelRays::through(double x, double y) const {
  Ray ray;
  ray.origin = eye_;
  ray.direction = normalized(corner_ + x * right_ + y * down_);
  return ray;
}

}  // namespace tessera::render
