#include <algorithm>
#include <vector>

#include "convert/basis/polar_forms.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/tensor_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

double height(const ExplicitPolynomial& surface, const PolarForms& x, const PolarForms& y) {
  DoubleDouble sum;
  for (int i = 0; i <= surface.degree_x(); ++i) {
    DoubleDouble row;
    for (int j = 0; j <= surface.degree_y(); ++j)
      row = row + y[static_cast<std::size_t>(j)] * surface.coefficient(i, j);
    sum = sum + row * x[static_cast<std::size_t>(i)];
  }
  return sum.rounded();
}

}  // namespace

Result<PatchGrid> to_bezier(const ExplicitPolynomial& surface) {
  return guarded([&]() -> Result<PatchGrid> {
    const Domain& r = surface.rectangle();
    const int m = std::max(1, surface.degree_x()), n = std::max(1, surface.degree_y());
    std::vector<Vec3> points;
    for (int i = 0; i <= m; ++i) {
      const PolarForms x = polar_forms(m, i, r.u0, r.u1);
      for (int j = 0; j <= n; ++j)
        points.push_back(
            {r.u_at(double(i) / m), r.v_at(double(j) / n), height(surface, x, polar_forms(n, j, r.v0, r.v1))});
    }
    Result<BezierPatch> patch = BezierPatch::polynomial(m, n, points);
    if (!patch) return patch.status();
    std::vector<BezierPatch> patches;
    patches.push_back(*std::move(patch));
    return PatchGrid::make({r.u0, r.u1}, {r.v0, r.v1}, std::move(patches));
  });
}

}}  // namespace tessera::abi_0_1
