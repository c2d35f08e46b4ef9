#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/hermite_patch.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Vec3 divided(const Vec3& vector, double by) { return {vector.x / by, vector.y / by, vector.z / by}; }

/// Writes a corner's quarter of the Bezier net (M_B^{-1} M_H; Farin, Curves and Surfaces for CAGD, 5th ed., ch. 15).
/// With signs of the directions that lead into the patch, the points are r, r +- r_u / 3, r +- r_v / 3 and r +- r_u / 3
/// +- r_v / 3 +- r_uv / 9. Points on a border depend on the border's vectors alone, so neighbours in a network share
/// them by ==.
void set_quarter(std::vector<Vec3>& points, const HermitePatch::Grid& g, std::size_t a, std::size_t b) {
  const Vec3& r = g[4 * (3 * a) + 3 * b];
  const double sign_u = a == 0 ? 1 : -1, sign_v = b == 0 ? 1 : -1;
  const Vec3 along_u = sign_u * divided(g[4 * (1 + a) + 3 * b], 3),
             along_v = sign_v * divided(g[4 * (3 * a) + 1 + b], 3);
  const Vec3 twist = (sign_u * sign_v) * divided(g[4 * (1 + a) + 1 + b], 9);
  const auto at = [&](std::size_t i, std::size_t j) -> Vec3& { return points[4 * i + j]; };
  at(3 * a, 3 * b) = r;
  at(1 + a, 3 * b) = r + along_u;
  at(3 * a, 1 + b) = r + along_v;
  at(1 + a, 1 + b) = r + (along_u + along_v + twist);
}

/// Makes the patch from the geometry matrix by local parameters.
Result<BezierPatch> bezier_of(const HermitePatch::Grid& local) {
  std::vector<Vec3> points(16);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) set_quarter(points, local, a, b);
  return BezierPatch::polynomial(3, 3, points);
}

}  // namespace

Result<PatchGrid> to_bezier(const HermitePatch& patch) {
  return guarded([&]() -> Result<PatchGrid> {
    auto bezier = bezier_of(patch.local_geometry());
    if (!bezier) return bezier.status();
    const Domain& d = patch.domain();
    return PatchGrid::make({d.u0, d.u1}, {d.v0, d.v1}, {*std::move(bezier)});
  });
}

Result<PatchGrid> to_bezier(const HermiteNetwork& network) {
  return guarded([&]() -> Result<PatchGrid> {
    std::vector<BezierPatch> patches;
    patches.reserve((network.count_u() - 1) * (network.count_v() - 1));
    for (std::size_t i = 0; i + 1 < network.count_u(); ++i)
      for (std::size_t j = 0; j + 1 < network.count_v(); ++j) {
        const auto patch = network.patch(i, j);
        if (!patch) return patch.status();
        auto bezier = bezier_of(patch->geometry());
        if (!bezier) return bezier.status();
        patches.push_back(*std::move(bezier));
      }
    const auto u = network.knots_u(), v = network.knots_v();
    return PatchGrid::make({u.begin(), u.end()}, {v.begin(), v.end()}, std::move(patches));
  });
}

}}  // namespace tessera::abi_0_1
