#include "io/step/step_offset.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "exact/spline_jets.h"
#include "tessera/convert.h"
#include "tessera/parametric_surface.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Inner knots at which the surface or its normal may have a corner.
std::vector<double> corners(std::span<const double> knots, int degree, double from, double to) {
  std::vector<double> out;
  for (const double knot : knots) {
    const bool is_inner = knot > from && knot < to && (out.empty() || knot > out.back());
    if (is_inner && static_cast<int>(std::ranges::count(knots, knot)) + 2 > degree) out.push_back(knot);
  }
  return out;
}

/// The patches of a grid, which have one degree, as one spline with knots as often as the degree.
Result<BSplineSurface> joined(const PatchGrid& grid) {
  const auto p = static_cast<std::size_t>(grid.patch(0, 0).degree_u()),
             q = static_cast<std::size_t>(grid.patch(0, 0).degree_v());
  const auto knots = [](std::span<const double> breaks, std::size_t degree) {
    std::vector<double> out{breaks.front()};
    for (const double value : breaks) out.insert(out.end(), degree, value);
    out.push_back(breaks.back());
    return out;
  };
  std::vector<Vec3> points;
  for (std::size_t i = 0; i <= p * grid.count_u(); ++i)
    for (std::size_t j = 0; j <= q * grid.count_v(); ++j) {
      const std::size_t a = std::min(i / p, grid.count_u() - 1), b = std::min(j / q, grid.count_v() - 1);
      points.push_back(grid.patch(a, b).point(static_cast<int>(i - a * p), static_cast<int>(j - b * q)));
    }
  return BSplineSurface::polynomial(static_cast<int>(p), knots(grid.breaks_u(), p), static_cast<int>(q),
                                    knots(grid.breaks_v(), q), std::move(points));
}

}  // namespace

Result<StepElementary> offset_by(const StepElementary& of, double distance) {
  StepElementary out = of;
  const Status too_far(StatusCode::unsupported, "lies beyond the axis or the centre of its basis surface");
  switch (of.kind) {
    case StepElementaryKind::plane:
      out.frame.origin += distance * of.frame.z;
      return out;
    case StepElementaryKind::cone:  // the normal is (cos, -sin) of the half angle, away from the axis
      out.radius += distance * std::cos(of.half_angle);
      out.frame.origin += -distance * std::sin(of.half_angle) * of.frame.z;
      return out.radius >= 0 ? Result<StepElementary>(out) : too_far;
    case StepElementaryKind::torus:
      out.minor += distance;
      return out.minor > 0 ? Result<StepElementary>(out) : too_far;
    case StepElementaryKind::cylinder:
    case StepElementaryKind::sphere:
      break;
  }
  out.radius += distance;
  return out.radius > 0 ? Result<StepElementary>(out) : too_far;
}

Result<FaceSurface> offset_by(const BSplineSurface& of, double distance, double tolerance) {
  const FastSurface basis(of);
  SurfaceFunctions functions;
  functions.position = [&](double u, double v) {
    const SurfacePlace place = basis(u, v);
    return place.point + distance * normalized(cross(place.du, place.dv));
  };
  const Domain& d = of.domain();
  const Result<ParametricSurface> surface = ParametricSurface::make(functions, d);
  if (!surface) return surface.status();
  FitOptions options;
  options.tolerance = tolerance;
  options.degree = 6;
  options.max_patches = 1U << 12;
  options.breaks_u = corners(of.knots_u(), of.degree_u(), d.u0, d.u1);
  options.breaks_v = corners(of.knots_v(), of.degree_v(), d.v0, d.v1);
  const Result<PatchGrid> grid = to_bezier(*surface, options);
  if (!grid) return grid.status();
  return with_parameters(joined(*grid), {}, grid->fit_error().distance);
}

}}  // namespace tessera::abi_0_1
