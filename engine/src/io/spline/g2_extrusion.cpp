// Surfaces of linear extrusion in .g2 files. GoTools writes the dimension, a spline curve, the direction, the range of
// the parameters, and whether the two are swapped.

#include <array>

#include "io/spline/g2.h"
#include "tessera/nurbs_surface.h"

namespace tessera { inline namespace abi_0_1 {

Result<G2Extrusion> read_g2_extrusion(G2Numbers& numbers) {
  numbers.integer("the dimension 3", 3, 3);
  Result<Curve> profile = read_g2_curve(numbers, 3);
  if (!profile) return profile.status();
  G2Extrusion extrusion{*std::move(profile), numbers.vector("the direction")};
  const bool bounded = numbers.integer("the flag of a bounded surface", 0, 1) == 1;
  for (int limits = bounded ? 4 : 2; limits > 0; --limits) numbers.number("a limit of the parameters");
  extrusion.swapped = numbers.integer("the flag of swapped parameters", 0, 1) == 1;
  if (!numbers.ok()) return numbers.status();
  return extrusion;
}

Result<Surface> make_g2_extrusion(const G2Extrusion& extrusion, const Interval& range) {
  const Curve& profile = extrusion.profile;
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < profile.points().size(); ++k)
    for (const double v : {range.from, range.to}) {
      points.push_back(profile.points()[k] + v * extrusion.direction);
      weights.push_back(profile.weight(k));
    }
  const std::array knots_v{range.from, range.from, range.to, range.to};
  Result<BSplineSurface> surface =
      profile.is_rational() ? BSplineSurface::rational(profile.degree(), profile.knots(), 1, knots_v, points, weights)
                            : BSplineSurface::polynomial(profile.degree(), profile.knots(), 1, knots_v, points);
  if (!surface) return surface.status();
  return Surface(*std::move(surface));
}

}}  // namespace tessera::abi_0_1
