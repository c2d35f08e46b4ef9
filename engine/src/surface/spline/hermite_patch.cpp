#include "tessera/hermite_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/text.h"
#include "surface/net/checks.h"
#include "surface/spline/hermite_nodes.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Cubic Hermite polynomials and their derivatives at one parameter, in the order position 0, tangent 0, tangent 1,
// position 1: H0 = 1-3t^2+2t^3, H1 = t-2t^2+t^3, H2 = -t^2+t^3, H3 = 3t^2-2t^3 (Farin, Curves and Surfaces for CAGD,
// 5th ed., sec. 7.5).

// All functions take any finite t. They use products, which do not cancel on [0,1].

/// Returns H_i(t), exactly 0 and 1 at t = 0 and t = 1.
inline std::array<double, 4> hermite_values(double t) {
  const double s = 1 - t;
  return {s * s * (1 + 2 * t), t * (s * s), -(t * t) * s, t * t * (3 - 2 * t)};
}

/// Returns H_i'(t).
inline std::array<double, 4> hermite_derivatives(double t) {
  const double s = 1 - t;
  return {-6 * (t * s), s * (1 - 3 * t), t * (3 * t - 2), 6 * (t * s)};
}

/// Returns H_i''(t).
inline std::array<double, 4> hermite_second_derivatives(double t) {
  return {12 * t - 6, 6 * t - 4, 6 * t - 2, 6 - 12 * t};
}

using Grid = HermitePatch::Grid;
using Matrix4 = double[4][4];

constexpr std::size_t at(int i, int j) { return static_cast<std::size_t>(4 * i + j); }

/// The index in order by_end of each row and column in order by_kind.
constexpr int by_kind_order[4] = {0, 3, 1, 2};

/// Power coefficients of H0 .. H3, one function per column, and the inverse of this matrix.
constexpr Matrix4 power_of_hermite = {{1, 0, 0, 0}, {0, 1, 0, 0}, {-3, -2, -1, 3}, {2, 1, 1, -2}};
constexpr Matrix4 hermite_of_power = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 1, 2, 3}, {1, 1, 1, 1}};

/// Returns M G M^T.
Grid transform(const Matrix4& m, const Grid& g) {
  Grid along, result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) along[at(i, j)] += m[i][k] * g[at(k, j)];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) result[at(i, j)] += m[j][k] * along[at(i, k)];
  return result;
}

bool is_tangent(int row) { return row == 1 || row == 2; }

/// Scales tangents along u by `along_u` and along v by `along_v`.
Grid scaled(const Grid& g, double along_u, double along_v) {
  Grid result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      Vec3 vector = g[at(i, j)];
      if (is_tangent(i)) vector = along_u * vector;
      if (is_tangent(j)) vector = along_v * vector;
      result[at(i, j)] = vector;
    }
  return result;
}

Status check_count(std::size_t count, const char* what) {
  if (count == 16) return {};
  return {StatusCode::count_mismatch,
          std::string("a bicubic patch has 4 x 4 ") + what + ", found " + std::to_string(count)};
}

/// Returns the four parameters of a direction as local parameters, which must be finite and distinct.
Result<std::array<double, 4>> local_parameters(std::span<const double> from, double start, double end,
                                               const char* name) {
  if (from.size() != 4)
    return Status(StatusCode::count_mismatch, std::string("a grid of 4 x 4 points has four parameters ") + name +
                                                  ", found " + std::to_string(from.size()));
  std::array<double, 4> local{};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto number = [&](std::size_t i) { return std::string(name) + "[" + std::to_string(i) + "]"; };
    local[k] = (from[k] - start) / (end - start);
    if (!std::isfinite(local[k]))
      return Status(StatusCode::non_finite, "parameter " + number(k) + " is " + text(from[k]) + ", it must be finite",
                    static_cast<std::ptrdiff_t>(k));
    for (std::size_t i = 0; i < k; ++i)
      if (local[i] == local[k])
        return Status(StatusCode::invalid_argument,
                      "the system of 16 points is singular: parameters " + number(i) + " = " + text(from[i]) + " and " +
                          number(k) + " = " + text(from[k]) + " are equal",
                      static_cast<std::ptrdiff_t>(k));
  }
  return local;
}

/// Computes in place the power coefficients of the cubic through values[0], values[step], .. at four parameters:
/// Newton's divided differences, then powers (Björck and Pereyra, Solution of Vandermonde systems of equations, 1970).
void solve_vandermonde(const std::array<double, 4>& t, Vec3* values, std::size_t step) {
  for (std::size_t order = 0; order < 3; ++order)
    for (std::size_t k = 3; k > order; --k)
      values[k * step] = (1 / (t[k] - t[k - order - 1])) * (values[k * step] - values[(k - 1) * step]);
  for (std::size_t order = 3; order-- > 0;)
    for (std::size_t k = order; k < 3; ++k) values[k * step] += -t[order] * values[(k + 1) * step];
}

}  // namespace

HermitePatch::HermitePatch(const Data& data) : data_(std::make_shared<const Data>(data)) {}

HermitePatch::Grid geometry_of(const HermitePatch::Corners& corners) {
  Grid g;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      const HermiteNode& corner = corners[static_cast<std::size_t>(2 * a + b)];
      g[at(3 * a, 3 * b)] = corner.position;
      g[at(1 + a, 3 * b)] = corner.du;
      g[at(3 * a, 1 + b)] = corner.dv;
      g[at(1 + a, 1 + b)] = corner.duv;
    }
  return g;
}

SurfaceJet hermite_jet(const Grid& g, double s, double t) {
  const std::array<double, 4> f[] = {hermite_values(s), hermite_derivatives(s), hermite_second_derivatives(s)};
  const std::array<double, 4> h[] = {hermite_values(t), hermite_derivatives(t), hermite_second_derivatives(t)};
  const auto sum = [&](std::size_t order_u, std::size_t order_v) {
    Vec3 total;
    for (std::size_t i = 0; i < 4; ++i) {
      Vec3 row;
      for (std::size_t j = 0; j < 4; ++j) row += h[order_v][j] * g[4 * i + j];
      total += f[order_u][i] * row;
    }
    return total;
  };
  return {sum(0, 0), sum(1, 0), sum(0, 1), sum(2, 0), sum(1, 1), sum(0, 2)};
}

Result<HermitePatch> HermitePatch::make(std::span<const Vec3> geometry, const Domain& domain, HermiteOrder order) {
  return guarded([&]() -> Result<HermitePatch> {
    if (Status status = check_count(geometry.size(), "vectors"); !status.ok()) return status;
    if (Status status = check_vectors(geometry, 4, "geometry element"); !status.ok()) return status;
    if (Status status = check_domain(domain); !status.ok()) return status;
    Grid by_end;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const bool keep = order == HermiteOrder::by_end;
        by_end[keep ? at(i, j) : at(by_kind_order[i], by_kind_order[j])] = geometry[at(i, j)];
      }
    return HermitePatch({by_end, domain});
  });
}

Result<HermitePatch> HermitePatch::from_corners(const Corners& corners, const Domain& domain) {
  return make(geometry_of(corners), domain);
}

Result<HermitePatch> HermitePatch::ferguson(const OpenCorners& corners, const Domain& domain) {
  Corners closed;
  for (std::size_t k = 0; k < 4; ++k) closed[k] = {corners[k].position, corners[k].du, corners[k].dv, {}};
  return from_corners(closed, domain);
}

Result<HermitePatch> HermitePatch::adini(const OpenCorners& corners, const Domain& domain) {
  return guarded([&]() -> Result<HermitePatch> {
    if (Status status = check_domain(domain); !status.ok()) return status;
    const double over_u = 1 / (domain.u1 - domain.u0), over_v = 1 / (domain.v1 - domain.v0);
    const Vec3 mixed = (corners[3].position - corners[1].position) - (corners[2].position - corners[0].position);
    Corners closed;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t column = k & 2, row = k & 1;  // corners with the same u, and with the same v
      const Vec3 along_v = over_v * (corners[column + 1].du - corners[column].du);
      const Vec3 along_u = over_u * (corners[2 + row].dv - corners[row].dv);
      closed[k] = {corners[k].position, corners[k].du, corners[k].dv, along_v + along_u - (over_u * over_v) * mixed};
    }
    return from_corners(closed, domain);
  });
}

Result<HermitePatch> HermitePatch::from_local(const Grid& local, const Domain& domain) {
  if (Status status = check_domain(domain); !status.ok()) return status;
  return make(scaled(local, 1 / (domain.u1 - domain.u0), 1 / (domain.v1 - domain.v0)), domain);
}

Result<HermitePatch> HermitePatch::from_algebraic(std::span<const Vec3> coefficients, const Domain& domain) {
  return guarded([&]() -> Result<HermitePatch> {
    if (Status status = check_count(coefficients.size(), "coefficients"); !status.ok()) return status;
    if (Status status = check_vectors(coefficients, 4, "coefficient"); !status.ok()) return status;
    Grid a;
    std::copy(coefficients.begin(), coefficients.end(), a.begin());
    return from_local(transform(hermite_of_power, a), domain);
  });
}

Result<HermitePatch> HermitePatch::through_points(std::span<const Vec3> points, std::span<const double> u,
                                                  std::span<const double> v, const Domain& domain) {
  return guarded([&]() -> Result<HermitePatch> {
    if (Status status = check_count(points.size(), "points"); !status.ok()) return status;
    if (Status status = check_vectors(points, 4, "point"); !status.ok()) return status;
    if (Status status = check_domain(domain); !status.ok()) return status;
    const auto s = local_parameters(u, domain.u0, domain.u1, "u"), t = local_parameters(v, domain.v0, domain.v1, "v");
    if (!s) return s.status();
    if (!t) return t.status();
    Grid a;
    std::copy(points.begin(), points.end(), a.begin());
    for (std::size_t k = 0; k < 4; ++k) solve_vandermonde(*s, &a[k], 4);
    for (std::size_t k = 0; k < 4; ++k) solve_vandermonde(*t, &a[4 * k], 1);
    for (const Vec3& coefficient : a)
      if (!is_finite(coefficient))
        return Status(StatusCode::non_finite, "the parameters of the 16 points are too close to each other");
    return from_local(transform(hermite_of_power, a), domain);
  });
}

// The corners' derivatives determine a bicubic; patches of degree below 3 are bicubics too.
Result<HermitePatch> HermitePatch::from_bezier(const BezierPatch& patch, const Domain& domain) {
  return guarded([&]() -> Result<HermitePatch> {
    if (patch.is_rational()) return Status(StatusCode::unsupported, "a rational patch has no bicubic Hermite form");
    if (patch.degree_u() > 3 || patch.degree_v() > 3)
      return Status(StatusCode::unsupported_degree, "a patch of degree (" + std::to_string(patch.degree_u()) + ", " +
                                                        std::to_string(patch.degree_v()) +
                                                        ") has no bicubic Hermite form");
    Corners corners;
    for (std::size_t k = 0; k < 4; ++k) {
      const SurfaceJet jet = tessera::evaluate_jet(patch, k & 2 ? 1 : 0, k & 1 ? 1 : 0);
      corners[k] = {jet.position, jet.du, jet.dv, jet.duv};
    }
    return from_local(geometry_of(corners), domain);
  });
}

HermitePatch::Grid HermitePatch::geometry(HermiteOrder order) const {
  const Grid& geometry = data_->geometry;
  if (order == HermiteOrder::by_end) return geometry;
  Grid by_kind;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) by_kind[at(i, j)] = geometry[at(by_kind_order[i], by_kind_order[j])];
  return by_kind;
}

HermiteNode HermitePatch::corner(int a, int b) const {
  const Grid& geometry = data_->geometry;
  return {geometry[at(3 * a, 3 * b)], geometry[at(1 + a, 3 * b)], geometry[at(3 * a, 1 + b)],
          geometry[at(1 + a, 1 + b)]};
}

HermitePatch::Grid HermitePatch::local_geometry() const {
  const Domain& d = domain();
  return scaled(data_->geometry, d.u1 - d.u0, d.v1 - d.v0);
}

HermitePatch::Grid HermitePatch::algebraic_form() const { return transform(power_of_hermite, local_geometry()); }

HermitePatch::Grid HermitePatch::points_at(const std::array<double, 4>& u, const std::array<double, 4>& v) const {
  Grid points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      points[at(i, j)] = evaluate_jet(*this, u[static_cast<std::size_t>(i)], v[static_cast<std::size_t>(j)]).position;
  return points;
}

Result<HermitePatch> HermitePatch::reparametrize(const Domain& domain) const {
  return guarded([&]() -> Result<HermitePatch> {
    if (Status status = check_domain(domain); !status.ok()) return status;
    const Domain& own = data_->domain;
    const double along_u = (own.u1 - own.u0) / (domain.u1 - domain.u0);
    const double along_v = (own.v1 - own.v0) / (domain.v1 - domain.v0);
    return make(scaled(data_->geometry, along_u, along_v), domain);
  });
}

SurfaceJet evaluate_jet(const HermitePatch& patch, double u, double v) {
  const Domain& d = patch.domain();
  const SurfaceJet jet = hermite_jet(patch.local_geometry(), d.local_u(u), d.local_v(v));
  const double a = 1 / (d.u1 - d.u0), b = 1 / (d.v1 - d.v0);  // chain rule
  return {jet.position, a * jet.du, b * jet.dv, (a * a) * jet.duu, (a * b) * jet.duv, (b * b) * jet.dvv};
}

}}  // namespace tessera::abi_0_1
