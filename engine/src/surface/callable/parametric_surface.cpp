#include "tessera/parametric_surface.h"

#include <limits>
#include <utility>

#include "surface/callable/callables.h"
#include "surface/callable/differences.h"
#include "surface/net/checks.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

auto place_at(double u, double v) {
  return [u, v] { return "the surface" + text_at(u, v); };
}

using Points = std::array<Vec3, DifferenceStencil::size>;

/// Returns the points at (u[k], v) or (u, v[k]).
template <class Parameters>
Result<Points> points_along(const ParametricSurface& surface, const Parameters& parameters) {
  Points points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [u, v] = parameters(k);
    const auto point = surface.position(u, v);
    if (!point) return point.status();
    points[k] = *point;
  }
  return points;
}

using Parameters = std::pair<double, double>;

Result<SurfaceJet> jet_by_differences(const ParametricSurface& surface, double u, double v) {
  const Domain& domain = surface.domain();
  const DifferenceStencil along_u(u, domain.u0, domain.u1), along_v(v, domain.v0, domain.v1);
  const auto middle = surface.position(u, v);
  if (!middle) return middle.status();
  const auto u_line = points_along(surface, [&](std::size_t k) { return Parameters(along_u.at[k], v); });
  if (!u_line) return u_line.status();
  const auto v_line = points_along(surface, [&](std::size_t k) { return Parameters(u, along_v.at[k]); });
  if (!v_line) return v_line.status();
  Points slopes;  // p_v at (u[i], v)
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const auto line = points_along(surface, [&](std::size_t k) { return Parameters(along_u.at[i], along_v.at[k]); });
    if (!line) return line.status();
    slopes[i] = DifferenceStencil::derivative(along_v.first, *line, (*u_line)[i]);
  }
  SurfaceJet jet;
  jet.position = *middle;
  jet.du = DifferenceStencil::derivative(along_u.first, *u_line, *middle);
  jet.dv = DifferenceStencil::derivative(along_v.first, *v_line, *middle);
  jet.duu = DifferenceStencil::derivative(along_u.second, *u_line, *middle);
  jet.duv = DifferenceStencil::derivative(along_u.first, slopes, jet.dv);
  jet.dvv = DifferenceStencil::derivative(along_v.second, *v_line, *middle);
  return jet;
}

double bound_or_infinity(double bound) { return bound >= 0 ? bound : std::numeric_limits<double>::infinity(); }

}  // namespace

ParametricSurface::ParametricSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<ParametricSurface> ParametricSurface::make(SurfaceFunctions functions, const Domain& domain) {
  return guarded([&]() -> Result<ParametricSurface> {
    if (!functions.position)
      return Status(StatusCode::invalid_argument, "the surface has no function for its position");
    if (Status status = check_domain(domain); !status.ok()) return status;
    ParametricSurface surface({std::move(functions), domain});
    for (const double u : {domain.u0, domain.u1})
      for (const double v : {domain.v0, domain.v1})
        if (const auto corner = surface.position(u, v); !corner) return corner.status();
    return surface;
  });
}

Result<ParametricSurface> ParametricSurface::over_disc(SurfaceFunctions functions, const Disc& disc) {
  return guarded([&]() -> Result<ParametricSurface> {
    const auto map = PolarMap::make(disc);
    if (!map) return map.status();
    SurfaceFunctions polar;
    if (functions.position)
      polar.position = [map = *map, position = std::move(functions.position)](double rho, double theta) {
        const auto [x, y] = map(rho, theta);
        return position(x, y);
      };
    if (functions.jet)
      polar.jet = [map = *map, jet = std::move(functions.jet)](double rho, double theta) {
        const auto [x, y] = map(rho, theta);
        return map.chain_rule(jet(x, y), rho, theta);
      };
    return make(std::move(polar), map->domain());
  });
}

Result<Vec3> ParametricSurface::position(double u, double v) const {
  return guarded([&]() -> Result<Vec3> {
    Result<Vec3> point = called([&] { return data_->functions.position(u, v); }, place_at(u, v));
    if (!point) return point;
    if (Status status = check_finite(*point, u, v); !status.ok()) return status;
    return point;
  });
}

std::array<double, 2> ParametricSurface::derivative_bounds(const Domain& part, int k) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!has_bounds()) return {none, none};
  try {
    const auto [along_u, along_v] = data_->functions.derivative_bounds(part, k);
    return {bound_or_infinity(along_u), bound_or_infinity(along_v)};
  } catch (...) {  // a bound is optional: without one a fit is sampled
    return {none, none};
  }
}

Result<SurfaceJet> evaluate_jet(const ParametricSurface& surface, double u, double v) {
  return guarded([&]() -> Result<SurfaceJet> {
    Result<SurfaceJet> jet = surface.has_derivatives()
                                 ? called([&] { return surface.data_->functions.jet(u, v); }, place_at(u, v))
                                 : jet_by_differences(surface, u, v);
    if (!jet) return jet;
    if (Status status = check_finite(*jet, u, v); !status.ok()) return status;
    return jet;
  });
}

}}  // namespace tessera::abi_0_1
