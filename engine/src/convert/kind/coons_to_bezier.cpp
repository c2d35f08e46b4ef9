#include <algorithm>
#include <cmath>

#include "convert/basis/polar_forms.h"
#include "convert/fit/fit_surface.h"
#include "convert/kind/blended_line.h"
#include "convert/kind/surface_net.h"
#include "surface/callable/border_curve.h"
#include "tessera/coons_patch.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double Vec3::*components[] = {&Vec3::x, &Vec3::y, &Vec3::z};

/// Returns the net over the common denominator W(u) w(v) of all borders. Point [i][j] is
///   sum_b C_b[i] g_b[j] + sum_a f_a[i] (D_a[j] - sum_b r_ab g_b[j]),
/// since the formula is a sum of products of one direction each. Where borders meet without a gap, the net's first and
/// last column are the points of C1 and C2, and its first and last row those of D1 and D2.
SurfaceNet blended_net(const CoonsPatch& patch, const BlendedLine& u, const BlendedLine& v) {
  const bool rational = !u.weights.empty() || !v.weights.empty();
  SurfaceNet net(u.degree, u.breaks, v.degree, v.breaks, rational);
  const std::size_t rows = net.rows(), columns = net.columns();
  for (double Vec3::*component : components) {
    std::array<std::vector<long double>, 2> correction;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t j = 0; j < columns; ++j) {
        const int corner = static_cast<int>(a);
        correction[a].push_back(v.curves[a][j].*component - v.blends[0][j] * (patch.corner(corner, 0).*component) -
                                v.blends[1][j] * (patch.corner(corner, 1).*component));
      }
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) {
        long double sum = 0;
        for (std::size_t a = 0; a < 2; ++a)
          sum += v.blends[a][j] * (u.curves[a][i].*component) + u.blends[a][i] * correction[a][j];
        net.points[net.index(i, j)].*component = static_cast<double>(sum);
      }
  }
  for (std::size_t j = 0; j < columns; ++j) {
    net.points[net.index(0, j)] = v.curves[0][j];
    net.points[net.index(rows - 1, j)] = v.curves[1][j];
  }
  for (std::size_t i = 0; rational && i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      net.weights[net.index(i, j)] = (u.weights.empty() ? 1 : u.weights[i]) * (v.weights.empty() ? 1 : v.weights[j]);
  return net;
}

Result<PatchGrid> exact(const CoonsPatch& patch) {
  const auto curve = [](const BorderCurve& border) -> const Curve& { return std::get<Curve>(border); };
  const CoonsBorders& b = patch.borders();
  const auto u = blended_line(curve(b.c1), curve(b.c2), &patch.f(), "u");
  if (!u) return u.status();
  const auto v = blended_line(curve(b.d1), curve(b.d2), &patch.g(), "v");
  if (!v) return v.status();
  return blended_net(patch, *u, *v).patches();
}

/// A direction of the patch: its own curves and blend.
struct BlendedCurves {
  std::array<const BorderCurve*, 2> curves;
  const Blend* blend;
  Interval interval;
};

/// Bounds |d^k f_a / dt^k| over the part, by the curve's parameter: the hull of its Bernstein coefficients.
double largest_derivative(const BlendedCurves& side, std::size_t a, const Interval& part, int k) {
  const std::span<const double> f = a == 0 ? side.blend->first() : side.blend->second();
  std::vector<double> derivative(f.begin(), f.end());
  const double length = side.interval.to - side.interval.from;
  for (int order = 0; order < k && !derivative.empty(); ++order) {
    for (std::size_t i = 1; i < derivative.size(); ++i)
      derivative[i - 1] = static_cast<double>(i) * derivative[i] / length;
    derivative.pop_back();
  }
  if (derivative.empty()) return 0;
  const Domain domain{side.interval.from, side.interval.to, 0, 1};
  long double largest = 0;
  for (const long double c : bernstein_coefficients(derivative, domain.local_u(part.from), domain.local_u(part.to)))
    largest = std::max(largest, std::abs(c));
  return static_cast<double>(largest) * (1 + 0x1p-40);
}

/// Bounds |d^k r| along `along`: sum_b |g_b| |X_b^(k)| + sum_a |f_a^(k)| (|Y_a| + sum_b |r_ab| |g_b|). X_b are the
/// curves of `along`, blended by g_b across; f_a is its blend, which weights the curves Y_a across.
double bound_along(const BlendedCurves& along, const Interval& part_along, const BlendedCurves& across,
                   const Interval& part_across, const std::array<std::array<double, 2>, 2>& corners, int k) {
  double bound = 0;
  for (std::size_t b = 0; b < 2; ++b)
    bound += largest_derivative(across, b, part_across, 0) * derivative_bound(*along.curves[b], part_along, k);
  for (std::size_t a = 0; a < 2; ++a) {
    const double blend = largest_derivative(along, a, part_along, k);
    if (blend == 0) continue;
    double size = derivative_bound(*across.curves[a], part_across, 0);
    for (std::size_t b = 0; b < 2; ++b) size += corners[a][b] * largest_derivative(across, b, part_across, 0);
    bound += blend * size;
  }
  return std::isnan(bound) ? std::numeric_limits<double>::infinity() : bound;
}

DerivativeBounds bounds_of(const CoonsPatch& patch) {
  const CoonsBorders& b = patch.borders();
  for (const BorderCurve* border : {&b.c1, &b.c2, &b.d1, &b.d2})
    if (!has_bounds(*border)) return {};
  if (!patch.f().is_polynomial() || !patch.g().is_polynomial()) return {};
  return [&patch, &b](const Domain& part, int k) -> std::array<double, 2> {
    const BlendedCurves u{{&b.c1, &b.c2}, &patch.f(), domain(b.c1)}, v{{&b.d1, &b.d2}, &patch.g(), domain(b.d1)};
    const auto corner = [&](int a, int c) { return length(patch.corner(a, c)); };
    const Interval part_u{part.u0, part.u1}, part_v{part.v0, part.v1};
    return {bound_along(u, part_u, v, part_v, {{{corner(0, 0), corner(0, 1)}, {corner(1, 0), corner(1, 1)}}}, k),
            bound_along(v, part_v, u, part_u, {{{corner(0, 0), corner(1, 0)}, {corner(0, 1), corner(1, 1)}}}, k)};
  };
}

}  // namespace

Result<PatchGrid> to_bezier(const CoonsPatch& patch, const FitOptions& options) {
  return guarded([&] {
    if (patch.is_exact()) return exact(patch);
    const CoonsBorders& b = patch.borders();
    FitOptions fit = options;
    for (const BorderCurve* border : {&b.c1, &b.c2}) add_breaks(fit.breaks_u, *border, fit.degree);
    for (const BorderCurve* border : {&b.d1, &b.d2}) add_breaks(fit.breaks_v, *border, fit.degree);
    return fitted(patch, bounds_of(patch), fit);
  });
}

}}  // namespace tessera::abi_0_1
