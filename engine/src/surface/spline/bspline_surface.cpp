#include "tessera/nurbs_surface.h"

#include <algorithm>
#include <string>

#include "surface/net/validate.h"
#include "surface/spline/spline_lines.h"
#include "surface/spline/spline_window.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check_count(std::size_t count_u, std::size_t count_v, std::size_t count, const char* what) {
  if (count / count_u == count_v && count % count_u == 0) return {};
  return {StatusCode::count_mismatch, "these knots and degrees need " + std::to_string(count_u) + " x " +
                                          std::to_string(count_v) + " " + what + ", found " + std::to_string(count)};
}

/// Checks the requirements of both kinds, and sets an empty domain to that of the knots.
Status check_polynomial(int degree_u, std::span<const double> knots_u, int degree_v, std::span<const double> knots_v,
                        std::span<const Vec3> points, std::optional<Domain>& domain) {
  if (Status status = check_degree(degree_u, "degree u"); !status.ok()) return status;
  if (Status status = check_degree(degree_v, "degree v"); !status.ok()) return status;
  if (Status status = check_knots(degree_u, knots_u, "knots u"); !status.ok()) return status;
  if (Status status = check_knots(degree_v, knots_v, "knots v"); !status.ok()) return status;
  const std::size_t p = static_cast<std::size_t>(degree_u), q = static_cast<std::size_t>(degree_v);
  const std::size_t count_u = knots_u.size() - p - 1, count_v = knots_v.size() - q - 1;
  if (Status status = check_count(count_u, count_v, points.size(), "control points"); !status.ok()) return status;
  const auto place = [&](std::size_t k) { return place_in_rows(k, count_v); };
  if (Status status = check_points(points, place); !status.ok()) return status;
  if (!domain) domain = Domain{knots_u[p], knots_u[count_u], knots_v[q], knots_v[count_v]};
  if (Status status = check_range(degree_u, knots_u, domain->u0, domain->u1, "the domain in u"); !status.ok())
    return status;
  return check_range(degree_v, knots_v, domain->v0, domain->v1, "the domain in v");
}

}  // namespace

BSplineSurface::BSplineSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<BSplineSurface> BSplineSurface::polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                                  std::span<const double> knots_v, std::span<const Vec3> points,
                                                  std::optional<Domain> domain) {
  return guarded([&] { return polynomial(degree_u, knots_u, degree_v, knots_v, copied(points), domain); });
}

Result<BSplineSurface> BSplineSurface::polynomial(int degree_u, std::span<const double> knots_u, int degree_v,
                                                  std::span<const double> knots_v, std::vector<Vec3>&& points,
                                                  std::optional<Domain> domain) {
  return guarded([&]() -> Result<BSplineSurface> {
    if (Status status = check_polynomial(degree_u, knots_u, degree_v, knots_v, points, domain); !status.ok())
      return status;
    return BSplineSurface({degree_u, degree_v, copied(knots_u), copied(knots_v), {}, std::move(points), *domain});
  });
}

Result<BSplineSurface> BSplineSurface::rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                                std::span<const double> knots_v, std::span<const Vec3> points,
                                                std::span<const double> weights, std::optional<Domain> domain) {
  return guarded(
      [&] { return rational(degree_u, knots_u, degree_v, knots_v, copied(points), copied(weights), domain); });
}

Result<BSplineSurface> BSplineSurface::rational(int degree_u, std::span<const double> knots_u, int degree_v,
                                                std::span<const double> knots_v, std::vector<Vec3>&& points,
                                                std::vector<double>&& weights, std::optional<Domain> domain) {
  return guarded([&]() -> Result<BSplineSurface> {
    if (Status status = check_polynomial(degree_u, knots_u, degree_v, knots_v, points, domain); !status.ok())
      return status;
    const std::size_t count_v = knots_v.size() - static_cast<std::size_t>(degree_v) - 1;
    if (Status status = check_count(points.size() / count_v, count_v, weights.size(), "weights"); !status.ok())
      return status;
    const auto place = [&](std::size_t k) { return place_in_rows(k, count_v); };
    if (Status status = check_weights(weights, place); !status.ok()) return status;
    if (all_equal(weights)) weights = std::vector<double>();
    return BSplineSurface(
        {degree_u, degree_v, copied(knots_u), copied(knots_v), std::move(weights), std::move(points), *domain});
  });
}

SurfaceJet evaluate_jet(const BSplineSurface& surface, double u, double v) {
  const KnotLine lu = line_u(surface), lv = line_v(surface);
  const std::size_t span_u = find_span(lu, u), span_v = find_span(lv, v);
  const double *knot_u = &lu.knots[span_u], *knot_v = &lv.knots[span_v];
  const std::size_t p = lu.order() - 1, q = lv.order() - 1, i0 = span_u - p, j0 = span_v - q;

  const bool rational = surface.is_rational();
  double largest = 0, largest_weight = 0;
  for (std::size_t i = i0; i <= span_u; ++i)
    for (std::size_t j = j0; j <= span_v; ++j) {
      largest = std::max(largest, max_abs(surface.point(i, j)));
      if (rational) largest_weight = std::max(largest_weight, surface.weight(i, j));
    }
  const Vec3 corner = surface.point(i0 + nearer_end(lu.degree, knot_u, u), j0 + nearer_end(lv.degree, knot_v, v));
  const WindowFrame frame(largest, largest_weight, rational ? corner : Vec3{});

  // Evaluate each row along v; the rows' values and derivatives are then windows along u.
  std::array<SplineWindow, 3> across;
  for (std::size_t i = 0; i <= p; ++i) {
    SplineWindow row;
    for (std::size_t j = 0; j <= q; ++j)
      row[j] = frame.homogeneous(surface.point(i0 + i, j0 + j), surface.weight(i0 + i, j0 + j));
    const SplineJet along = spline_jet(lv.degree, knot_v, v, row);
    for (std::size_t order = 0; order < 3; ++order) across[order][i] = along[order];
  }
  const SplineJet a = spline_jet(lu.degree, knot_u, u, across[0]), av = spline_jet(lu.degree, knot_u, u, across[1]);
  const Homogeneous avv = de_boor(lu.degree, knot_u, u, across[2]);

  SurfaceJet jet{a[0].vector(), a[1].vector(), av[0].vector(), a[2].vector(), av[1].vector(), avv.vector()};
  if (rational) jet = project(a[0], a[1], av[0], a[2], av[1], avv);
  return {frame.position(jet.position), frame.vector(jet.du),  frame.vector(jet.dv),
          frame.vector(jet.duu),        frame.vector(jet.duv), frame.vector(jet.dvv)};
}

}}  // namespace tessera::abi_0_1
