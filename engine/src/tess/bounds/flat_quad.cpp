#include "tess/bounds/flat_quad.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Deviations up to this share of the longer diagonal count as rounding.
constexpr double tolerance = 0x1p-30;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  return length(p - (a + t * along));
}

}  // namespace

std::optional<double> flat_quad_deviation(const BezierPatch& patch) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const std::array<Vec3, 4> corner{patch.point(0, 0), patch.point(m, 0), patch.point(m, n), patch.point(0, n)};
  const Vec3 diagonals[2] = {corner[2] - corner[0], corner[3] - corner[1]};
  const Vec3 across = cross(diagonals[0], diagonals[1]);
  const double size = std::max(length(diagonals[0]), length(diagonals[1])), area = length(across);
  if (!(area > 0 && std::isfinite(area))) return {};
  const Vec3 normal = (1 / area) * across;
  const auto height = [&](const Vec3& p) { return std::abs(dot(p - corner[0], normal)); };
  // Most patches with corners in a plane bend away from it, and need no more than that.
  if (!std::ranges::all_of(patch.points(), [&](const Vec3& p) { return height(p) <= tolerance * size; })) return {};
  std::array<Vec3, 4> inward;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 side = corner[(k + 1) % 4] - corner[k];
    const double long_side = length(side);
    inward[k] = long_side > 0 ? (1 / long_side) * cross(normal, side) : Vec3{};
  }
  double most = 0;
  const auto add = [&](double off) { most = off > most || std::isnan(off) ? off : most; };
  for (int i = 0; i <= m && most <= tolerance * size; ++i)
    for (int j = 0; j <= n; ++j) {
      const Vec3& p = patch.point(i, j);
      double off = height(p);
      for (std::size_t k = 0; k < 4; ++k) off += std::max(0.0, -dot(p - corner[k], inward[k]));
      add(off);
      if (j == 0) add(distance_to_segment(p, corner[0], corner[1]));
      if (i == m) add(distance_to_segment(p, corner[1], corner[2]));
      if (j == n) add(distance_to_segment(p, corner[3], corner[2]));
      if (i == 0) add(distance_to_segment(p, corner[0], corner[3]));
    }
  if (!(most <= tolerance * size)) return {};
  // Sums and products of coordinates round by a few units of the largest one.
  const Box3 box = patch.hull_box();
  const double rounding = 0x1p-48 * (max_abs(box.lower) + max_abs(box.upper));
  return 4 * most + rounding;
}

}}  // namespace tessera::abi_0_1
