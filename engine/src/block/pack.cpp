#include "block/pack.h"

#include <algorithm>

#include "convert/power_form.h"
#include "surface/homogeneous.h"

namespace tessera {

void relative_coefficients(const BezierPatch& patch, const Vec3& origin, Representation representation,
                           std::vector<double>& net) {
  const auto points = patch.points();
  const auto weights = patch.weights();
  net.clear();
  const double scale = weights.empty() ? 1 : 1 / power_of_two_near(*std::max_element(weights.begin(), weights.end()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    // Adding +0 turns -0 into +0, so that equal control points are equal bits.
    const Vec3 p = points[k] - origin + Vec3{};
    if (weights.empty()) {
      net.insert(net.end(), {p.x, p.y, p.z});
    } else {
      const double w = scale * weights[k];
      const Vec3 q = w * p + Vec3{};
      net.insert(net.end(), {q.x, q.y, q.z, w});
    }
  }
  if (representation == Representation::power)
    power_coefficients(patch.degree_u(), patch.degree_v(), coefficient_components(patch.is_rational()), net);
}

}  // namespace tessera
