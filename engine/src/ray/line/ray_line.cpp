#include "ray/line/ray_line.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "ray/line/orthonormal_basis.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct TwoSum {
  double high, low;
  /// a + b without rounding (Knuth; Muller et al., Handbook of Floating-Point Arithmetic, alg. 4.4).
  TwoSum(double a, double b) : high(a + b) {
    const double part = high - a;
    low = (a - (high - part)) + (b - part);
  }
};

/// Returns origin + t d - centre, rounded as if all but the last sum were exact to twice the precision.
double point_on_line(double origin, double t, double d, double centre) {
  const double product = t * d, rest = std::fma(t, d, -product);
  const TwoSum from(origin, -centre), sum(from.high, product);
  return sum.high + (sum.low + (from.low + rest));
}

/// Narrows [enter, leave] to where start + s * direction lies in [lower, upper].
void clip(double start, double direction, double lower, double upper, RayLine& line) {
  constexpr double parallel = 1e-300;  // the reciprocal is finite
  if (std::abs(direction) < parallel) {
    if (start < lower || start > upper) line.leave = -std::numeric_limits<double>::infinity();
    return;
  }
  const double inverse = 1 / direction;
  double in = (lower - start) * inverse, out = (upper - start) * inverse;
  if (in > out) std::swap(in, out);
  line.enter = std::max(line.enter, in);
  line.leave = std::min(line.leave, out);
}

}  // namespace

SceneFrame SceneFrame::around(const Box3& box) {
  SceneFrame frame;
  frame.centre = box.centre();
  const double reach = std::max(max_abs(box.lower - frame.centre), max_abs(box.upper - frame.centre));
  int exponent = 0;
  std::frexp(reach, &exponent);  // reach < 2^exponent
  frame.scale = std::ldexp(1.0, -exponent);
  return frame;
}

bool SceneFrame::holds(const Box3& box) const {
  const Vec3 low = to_scene(box.lower), high = to_scene(box.upper);
  return std::max(max_abs(low), max_abs(high)) <= 1 && max_abs(high - low) >= 0.75;
}

Box3 clipping_box(const Box3& box) {
  constexpr double pad = 1e-12;
  constexpr Vec3 by{pad, pad, pad};
  return {box.lower - by, box.upper + by};
}

namespace {

/// Sets the unit direction and the speed. `given`: the ray's direction, in the model's coordinates.
template <bool Placed>
void set_direction(const Vec3& given, double scale, RayLine& line) {
  const double largest = max_abs(given);
  if (largest > 1e-100) {
    const double stretch = length(given);
    line.direction = (1 / stretch) * given;
    line.speed = stretch * scale;
  } else {  // divides first by the largest component, whose square is no normal number
    const Vec3 scaled{given.x / largest, given.y / largest, given.z / largest};
    const double stretch = length(scaled);
    line.direction = (1 / stretch) * scaled;
    line.speed = largest * stretch * scale;
  }
}

/// Returns o + line.base d - c.
Vec3 near_centre(const Ray& ray, const RayLine& line, const Vec3& c) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  return {point_on_line(o.x, line.base, d.x, c.x), point_on_line(o.y, line.base, d.y, c.y),
          point_on_line(o.z, line.base, d.z, c.z)};
}

/// Sets the range within the scene's box.
void clip(const Box3& box, RayLine& line) {
  line.enter = line.near - line.slack;
  line.leave = line.far + line.slack;
  const Box3 room = clipping_box(box);
  clip(line.start.x, line.direction.x, room.lower.x, room.upper.x, line);
  clip(line.start.y, line.direction.y, room.lower.y, room.upper.y, line);
  clip(line.start.z, line.direction.z, room.lower.z, room.upper.z, line);
  line.empty = !(line.enter <= line.leave);
}

/// Completes the line from base, start, direction and speed. `scale`: an upper bound of the factor by which lengths
/// grow. One instance per kind of ray, so that each is inlined where it is used.
template <bool Placed>
void complete(const Ray& ray, double scale, const Box3& box, RayLine& line) {
  line.shift = -dot(line.start, line.direction);  // the rest from the rounding of `base`
  line.start += line.shift * line.direction;

  line.slack = 8 * epsilon * (1 + std::abs(line.base) * line.speed);
  line.near = (ray.tnear - line.base) * line.speed - line.shift;
  line.far = (ray.tfar - line.base) * line.speed - line.shift;
  clip(box, line);
  if (!line.empty) {
    const OrthonormalBasis across(line.direction);
    line.across[0] = across.first, line.across[1] = across.second;
  }
  if (ray.spawn_offset > 0) line.spawn = scale * ray.spawn_offset + 2 * line.slack;
}

}  // namespace

RayLine line_of(const Ray& ray, const SceneFrame& frame, const Box3& box) {
  RayLine line;
  set_direction<false>(ray.direction, frame.scale, line);
  line.base = -dot(frame.to_scene(ray.origin), line.direction) / line.speed;
  if (!std::isfinite(line.base) || !(line.speed > 0)) return line;  // no t in double reaches the scene
  line.start = frame.scale * near_centre(ray, line, frame.centre);
  complete<false>(ray, frame.scale, box, line);
  return line;
}

RayLine moved(const RayLine& line, const Vec3& by, const Box3& box) {
  RayLine out = line;
  out.start += by;
  clip(box, out);
  return out;
}

std::optional<Placement> Placement::of(const Affine& to_world, const SceneFrame& frame) {
  constexpr double most = 1e8;
  using Long = long double;  // if longer than double, the inverse is right to its last digits
  const auto& c = to_world.columns;
  const auto cross_of = [](const Vec3& a, const Vec3& b) {
    const Long x = a.x, y = a.y, z = a.z;
    return std::array<Long, 3>{y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  };
  const std::array<std::array<Long, 3>, 3> rows{cross_of(c[1], c[2]), cross_of(c[2], c[0]), cross_of(c[0], c[1])};
  const Long volume = rows[0][0] * c[0].x + rows[0][1] * c[0].y + rows[0][2] * c[0].z;
  Placement out;
  const auto at = [&](std::size_t row, std::size_t column) { return static_cast<double>(rows[row][column] / volume); };
  for (std::size_t k = 0; k < 3; ++k) out.back.columns[k] = {at(0, k), at(1, k), at(2, k)};
  out.centre = to_world.point(frame.centre);
  out.growth = out.back.norm_bound();
  // Written so that NaN fails.
  if (!(to_world.norm_bound() * out.growth <= most) || !is_finite(out.back) || !is_finite(out.centre)) return {};
  return out;
}

RayLine line_of(const Ray& ray, const Placement& placement, const SceneFrame& frame, const Box3& box) {
  RayLine line;
  const Vec3 direction = placement.back.vector(ray.direction);
  if (!is_finite(direction) || !(max_abs(direction) > 0)) return line;  // no t in double reaches the scene
  set_direction<true>(direction, frame.scale, line);
  const Vec3 from = frame.scale * placement.back.vector(ray.origin - placement.centre);
  line.base = -dot(from, line.direction) / line.speed;
  if (!std::isfinite(line.base) || !(line.speed > 0)) return line;
  line.start = frame.scale * placement.back.vector(near_centre(ray, line, placement.centre));
  complete<true>(ray, frame.scale * placement.growth, box, line);
  return line;
}

}}  // namespace tessera::abi_0_1
