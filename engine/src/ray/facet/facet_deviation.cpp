#include "ray/facet/facet_deviation.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Bounds the distance of facets from a polynomial piece by (h^2 Muu + 2 h k Muv + k^2 Mvv) / 8, for triangles with
/// corners on the piece in a parameter box h x k. The proof is Taylor's theorem at the point and the variance of the
/// parameters over the corners (Filip, Magedson and Markot, Surface algorithms using bounds on derivatives, CAGD 3,
/// 1986, for one triangulation). The M bound second derivatives by second differences of the control net, `at(i, j)`,
/// measured by `norm`.
template <class At, class Norm>
double box_rule(int m, int n, double h, double k, At at, Norm norm) {
  double uu = 0, uv = 0, vv = 0;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      if (i + 2 <= m) uu = std::max(uu, norm(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j)));
      if (j + 2 <= n) vv = std::max(vv, norm(at(i, j + 2) - 2 * at(i, j + 1) + at(i, j)));
      if (i < m && j < n) uv = std::max(uv, norm(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
    }
  }
  return (h * h * m * (m - 1) * uu + 2 * h * k * m * n * uv + k * k * n * (n - 1) * vv) / 8;
}

double vector_norm(const Vec3& a) { return length(a); }
double scalar_norm(double a) { return std::abs(a); }

}  // namespace

double facet_deviation(const BezierPatch& patch, double h, double k) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const Box3 hull = patch.hull_box();
  const double farthest = hull.diagonal();  // facets and surface both lie in the hull
  if (!patch.is_rational()) {
    const double bound = box_rule(
        m, n, h, k, [&](int i, int j) { return patch.point(i, j); }, vector_norm);
    return std::min(bound, farthest);
  }
  // With the bounds e_P of w (P - c) and e_w of w, about the hull's centre c with radius R, the quotient has an error
  // of at most (e_P + R e_w) / min w.
  const Vec3 centre = hull.centre();
  const double points = box_rule(
      m, n, h, k, [&](int i, int j) { return patch.weight(i, j) * (patch.point(i, j) - centre); }, vector_norm);
  const double weights = box_rule(
      m, n, h, k, [&](int i, int j) { return patch.weight(i, j); }, scalar_norm);
  const double lightest = *std::min_element(patch.weights().begin(), patch.weights().end());
  return std::min((points + 0.5 * farthest * weights) / lightest, farthest);
}

}}  // namespace tessera::abi_0_1
