#include <algorithm>
#include <cmath>

#include "basis/bernstein_net.h"
#include "surface/net/homogeneous.h"
#include "tessera/guard.h"
#include "tessera/local_geometry.h"
#include "tessera/status.h"

// With r = A / w: w^2 r_u = A_u w - A w_u. Up to multiples of r_u and r_v, which do not change det(r_u, r_v, r_uv), w^2
// r_uv = A_uv w - A w_uv. So the numerators are polynomials, and the hulls of their Bernstein coefficients bound them.

namespace tessera { inline namespace abi_0_1 {
namespace {

using Scalars = BernsteinNet<double>;
using Vectors = BernsteinNet<Vec3>;

/// Numerators of the scaled net: w^2 r_u, w^2 r_v, and w^2 r_uv up to multiples of r_u and r_v.
struct Numerators {
  Vectors u, v, uv;
};

Numerators numerators(const BezierPatch& patch, const HomogeneousNet& net) {
  Vectors a(net.degree_u, net.degree_v);
  Scalars w(net.degree_u, net.degree_v);
  for (std::size_t k = 0; k < net.size(); ++k) {
    a.values[k] = net.points[k].vector();
    w.values[k] = net.points[k].w;
  }
  const Vectors au = derivative_u(a), av = derivative_v(a), auv = derivative_v(au);
  if (!patch.is_rational()) return {au, av, auv};
  const Scalars wu = derivative_u(w), wv = derivative_v(w), wuv = derivative_v(wu);
  return {w * au - wu * a, w * av - wv * a, w * auv - wuv * a};
}

double largest(const Vectors& net) {
  double value = 0;
  for (const Vec3& p : net.values) value = std::max(value, length(p));
  return value;
}
double largest(const Scalars& net) {
  double value = 0;
  for (const double x : net.values) value = std::max(value, std::abs(x));
  return value;
}

void add_bounds(const BezierPatch& patch, double tolerance, NetReport& report) {
  const HomogeneousNet net(patch, patch.point(0, 0));
  const Numerators n = numerators(patch, net);
  double min_weight = 1;
  for (std::size_t k = 0; k < net.size(); ++k) min_weight = std::min(min_weight, net.points[k].w);
  const auto inner = [](const Vec3& x, const Vec3& y) { return dot(x, y); };
  const auto outer = [](const Vec3& x, const Vec3& y) { return cross(x, y); };
  const double dots = largest(product(n.u, n.v, inner));
  const double volumes = largest(product(product(n.u, n.v, outer), n.uv, inner));
  const double size_u = largest(n.u), size_v = largest(n.v), size_uv = largest(n.uv);
  report.orthogonal = dots <= tolerance * size_u * size_v;
  // A translation surface has r_uv = 0 except for rounding, which is relative to r_u and r_v.
  report.conjugate = volumes <= tolerance * size_u * size_v * std::max({size_uv, size_u, size_v});
  report.dot_bound = dots / std::pow(min_weight, 4) * net.scale * net.scale;
  report.volume_bound = volumes / std::pow(min_weight, 6) * net.scale * net.scale * net.scale;
}

void add_sample(const BezierPatch& patch, double u, double v, NetReport& report) {
  const LocalGeometry at = local_geometry(patch, u, v);
  if (!at.defined) {
    ++report.undefined_samples;
    return;
  }
  const double lengths = std::sqrt(at.e) * std::sqrt(at.g);
  report.largest_cosine = std::max(report.largest_cosine, std::abs(at.f) / lengths);
  report.largest_mixed_curvature = std::max(report.largest_mixed_curvature, std::abs(at.m) / lengths);
}

}  // namespace

Result<NetReport> measure_net(const BezierPatch& patch, const NetOptions& options) {
  return guarded([&]() -> Result<NetReport> {
    if (options.samples < 2 || options.samples > 1000)
      return Status(StatusCode::invalid_argument, "a net must be sampled at 2 to 1000 points in each direction");
    if (!(options.tolerance >= 0))
      return Status(StatusCode::invalid_argument, "the tolerance of a net must not be negative");
    NetReport report;
    add_bounds(patch, options.tolerance, report);
    const double last = options.samples - 1;
    for (int i = 0; i < options.samples; ++i)
      for (int j = 0; j < options.samples; ++j) add_sample(patch, i / last, j / last, report);
    return report;
  });
}

}}  // namespace tessera::abi_0_1
