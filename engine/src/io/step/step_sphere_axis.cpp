#include "io/step/step_sphere_axis.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exact/curve_foot.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool runs_through(const Curve& border, const Vec3& pole, double tolerance) {
  const FastCurve at(border);
  const std::vector<double> parameters = sample_parameters(border, 8);
  std::vector<Vec3> points;
  for (const double t : parameters) points.push_back(at.point(t));
  const Interval d = border.domain();
  const double t = nearest_foot(at, pole, d, parameters, points), end = 1e-6 * (d.to - d.from);
  return t > d.from + end && t < d.to - end && length(at.point(t) - pole) <= tolerance;
}

}  // namespace

StepElementary off_poles(const StepElementary& sphere, std::span<const Curve* const> borders, double tolerance) {
  const Frame& frame = sphere.frame;
  const auto is_crossed = [&](double side) {
    const Vec3 pole = frame.at({0, 0, side * sphere.radius});
    return std::ranges::any_of(borders, [&](const Curve* border) { return runs_through(*border, pole, tolerance); });
  };
  if (!is_crossed(1) && !is_crossed(-1)) return sphere;
  std::vector<Vec3> samples;
  for (const Curve* const border : borders) {
    const FastCurve at(*border);
    for (const double t : sample_parameters(*border, 8)) samples.push_back(frame.local(at.point(t)));
  }
  Vec3 best{1, 0, 0};
  double farthest = -1;
  for (const Vec3& axis :
       {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{1, -1, 0}, Vec3{1, 0, 1}, Vec3{-1, 0, 1}, Vec3{0, 1, 1},
        Vec3{0, -1, 1}, Vec3{1, 1, 1}, Vec3{-1, 1, 1}, Vec3{1, -1, 1}, Vec3{-1, -1, 1}}) {
    const Vec3 unit = normalized(axis);
    double nearest = sphere.radius;
    for (const Vec3& p : samples) nearest = std::min(nearest, length(cross(p, unit)));
    if (nearest > farthest) farthest = nearest, best = unit;
  }
  const auto turned = [&](const Vec3& v) { return v.x * frame.x + v.y * frame.y + v.z * frame.z; };
  const Vec3 across = normalized(cross(best, std::abs(best.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  StepElementary out = sphere;
  out.frame = {frame.origin, turned(across), turned(cross(best, across)), turned(best)};
  return out;
}

}}  // namespace tessera::abi_0_1
