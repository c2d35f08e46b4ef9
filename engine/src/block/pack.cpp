#include "block/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convert/power_form.h"
#include "surface/homogeneous.h"

namespace tessera {
namespace {

/// Whether all rows or all columns of the net are the same: then r_u or r_v is zero everywhere.
bool is_curve(const BezierPatch& patch) {
  bool equal_rows = true, equal_columns = true;
  for (int i = 0; i <= patch.degree_u(); ++i)
    for (int j = 0; j <= patch.degree_v(); ++j) {
      equal_rows = equal_rows && patch.point(i, j) == patch.point(0, j);
      equal_columns = equal_columns && patch.point(i, j) == patch.point(i, 0);
    }
  return patch.is_rational() ? equal_rows && equal_columns : equal_rows || equal_columns;
}

double weight_scale(const BezierPatch& patch) {
  return patch.is_rational() ? 1 / power_of_two_near(std::ranges::max(patch.weights())) : 1;
}

}  // namespace

void relative_coefficients(const BezierPatch& patch, const Vec3& origin, Representation representation,
                           std::vector<double>& net) {
  const auto points = patch.points();
  const auto weights = patch.weights();
  const std::size_t components = static_cast<std::size_t>(coefficient_components(patch.is_rational()));
  net.resize(points.size() * components);
  double* to = net.data();
  // Adding +0 turns -0 into +0, so that equal control points are equal bits.
  if (weights.empty()) {
    for (const Vec3& point : points) {
      to[0] = point.x - origin.x + 0.0;
      to[1] = point.y - origin.y + 0.0;
      to[2] = point.z - origin.z + 0.0;
      to += components;
    }
  } else {
    const double scale = weight_scale(patch);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double w = scale * weights[k];
      const Vec3 q = w * (points[k] - origin + Vec3{}) + Vec3{};
      for (const double value : {q.x, q.y, q.z, w}) *to++ = value;
    }
  }
  if (representation == Representation::power)
    power_coefficients(patch.degree_u(), patch.degree_v(), coefficient_components(patch.is_rational()), net);
}

NormalDoubt normal_doubt(const BezierPatch& patch, std::span<const double> net, double unit) {
  if (is_curve(patch)) return {.squared_length = std::numeric_limits<double>::infinity(), .noise = -1};
  const auto components = static_cast<std::size_t>(coefficient_components(patch.is_rational()));
  double largest = 0;
  for (std::size_t k = 0; k < net.size(); k += components)
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(net[k + c]));
  const double degree = std::max(patch.degree_u(), patch.degree_v());
  const double noise = 6 * degree * unit * largest;
  double lightest = 1, spread = 1;
  if (patch.is_rational()) {
    const auto [low, high] = std::ranges::minmax(patch.weights());
    lightest = weight_scale(patch) * low;
    spread = high / low;
  }
  const double longest = degree * spread * patch.hull_box().diagonal();
  const double length = 4 * (noise / lightest) * longest;  // 2 sqrt(3) noise |r_u|
  return {.squared_length = length * length, .noise = noise};
}

}  // namespace tessera
