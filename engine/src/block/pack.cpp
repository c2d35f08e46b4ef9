#include "block/pack.h"

#include <algorithm>

#include "convert/power_form.h"
#include "surface/homogeneous.h"

namespace tessera {

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
    const double scale = 1 / power_of_two_near(*std::max_element(weights.begin(), weights.end()));
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double w = scale * weights[k];
      const Vec3 q = w * (points[k] - origin + Vec3{}) + Vec3{};
      for (const double value : {q.x, q.y, q.z, w}) *to++ = value;
    }
  }
  if (representation == Representation::power)
    power_coefficients(patch.degree_u(), patch.degree_v(), coefficient_components(patch.is_rational()), net);
}

}  // namespace tessera
