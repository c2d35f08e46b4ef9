#include "render/environment.h"

#include <cmath>

namespace tessera::render {
namespace {

const Vec3 zenith{0.12, 0.25, 0.54}, middle{0.30, 0.49, 0.84}, horizon{1.14, 0.86, 0.62};
const Vec3 glow{1.0, 0.78, 0.52};
const Vec3 floor_albedo{0.34, 0.265, 0.21};
const Vec3 sun{1.9, 1.58, 1.2};
const Vec3 to_sun = normalized({-0.86, -0.52, 0.80});
constexpr double haze_begins = 1.5, haze_length = 9;  // in units of the model's size

}  // namespace

Environment::Environment(const Box3& box, const Vec3& eye, Up up)
    : up_(up),
      centre_(to_z_up(box.centre(), up)),
      height_(to_z_up(box.lower, up).z),
      size_(box.diagonal()),
      has_floor_(to_z_up(eye, up).z > height_) {}

Vec3 Environment::sun_direction() const { return from_z_up(to_sun, up_); }
Vec3 Environment::sun_light() const { return sun; }
double Environment::sun_tangent() const { return 0.07; }

Vec3 Environment::sky(const Vec3& direction) const {
  const double rise = std::max(to_z_up(direction, up_).z, 0.0);
  const double high = 1 - std::exp(-2.2 * rise), low = std::exp(-17 * rise);
  const double towards = std::max(dot(direction, sun_direction()), 0.0);
  const Vec3 clear = mix(mix(middle, zenith, high), horizon, low);
  return clear + (0.25 * std::pow(towards, 6) + 1.6 * std::pow(towards, 60)) * glow;
}

std::optional<double> Environment::floor(const Vec3& origin, const Vec3& direction, double farthest) const {
  const double fall = -to_z_up(direction, up_).z;
  if (!has_floor_ || !(fall > 0)) return {};
  const double t = (to_z_up(origin, up_).z - height_) / fall;
  // An object that lies in the floor hides it.
  if (!(t > 0 && t < farthest * (1 - 1e-6))) return {};
  return t;
}

Vec3 Environment::floor_colour() const { return floor_albedo; }

Vec3 Environment::in_haze(const Vec3& radiance, const Vec3& position, const Vec3& direction) const {
  const Vec3 from_centre = to_z_up(position, up_) - centre_;
  const double distance = std::hypot(from_centre.x, from_centre.y) / size_;
  const double depth = std::max(distance - haze_begins, 0.0) / haze_length;
  const Vec3 level = direction - dot(direction, up()) * up();
  return mix(radiance, sky(level), 1 - std::exp(-depth));
}

Vec3 Environment::surroundings(const Vec3& direction) const {
  const double rise = to_z_up(direction, up_).z;
  if (!has_floor_ || rise >= 0) return sky(direction);
  const Vec3 lit = multiply(floor_albedo, to_sun.z * sun + Vec3{0.5, 0.55, 0.6});
  return mix(lit, horizon, std::exp(8 * rise));
}

}  // namespace tessera::render
