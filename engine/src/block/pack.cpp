#include "block/pack.h"

#include "convert/power_form.h"

namespace tessera {

void relative_coefficients(const BezierPatch& patch, const Vec3& origin, Representation representation,
                           std::vector<double>& net) {
  const auto points = patch.points();
  const auto weights = patch.weights();
  net.clear();
  for (std::size_t k = 0; k < points.size(); ++k) {
    // Adding +0 turns -0 into +0, so that equal control points are equal bits.
    const Vec3 p = points[k] - origin + Vec3{};
    if (weights.empty()) {
      net.insert(net.end(), {p.x, p.y, p.z});
    } else {
      const Vec3 q = weights[k] * p + Vec3{};
      net.insert(net.end(), {q.x, q.y, q.z, weights[k]});
    }
  }
  if (representation == Representation::power)
    power_coefficients(patch.degree_u(), patch.degree_v(), coefficient_components(patch.is_rational()), net);
}

}  // namespace tessera
