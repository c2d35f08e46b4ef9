#include <algorithm>

#include "convert/fit/fit_surface.h"
#include "convert/kind/blended_line.h"
#include "convert/kind/surface_net.h"
#include "surface/callable/border_curve.h"
#include "tessera/coons_patch.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Converts exactly: over one denominator the points of both curves are the rows of a net of degree 1.
Result<PatchGrid> exact(const RuledSurface& surface) {
  const bool along_u = surface.straight() == Direction::v;
  const auto line =
      blended_line(std::get<Curve>(surface.first()), std::get<Curve>(surface.second()), nullptr, along_u ? "u" : "v");
  if (!line) return line.status();
  const Domain d = surface.domain();
  const std::vector<double> across = along_u ? std::vector{d.v0, d.v1} : std::vector{d.u0, d.u1};
  SurfaceNet net(line->degree, line->breaks, 1, across, !line->weights.empty());
  for (std::size_t i = 0; i < net.rows(); ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      net.points[net.index(i, j)] = line->curves[j][i];
      if (!net.weights.empty()) net.weights[net.index(i, j)] = line->weights[i];
    }
  return along_u ? net.patches() : transposed(net).patches();
}

/// Bounds the derivatives: along the curves by the larger of the two curves' bounds, across them by |C2 - C1| over the
/// length for the first derivative and by 0 for higher ones.
DerivativeBounds bounds_of(const RuledSurface& surface) {
  for (const BorderCurve* border : {&surface.first(), &surface.second()})
    if (!has_bounds(*border)) return {};
  return [&surface](const Domain& part, int k) -> std::array<double, 2> {
    const bool along_u = surface.straight() == Direction::v;
    const Interval along = along_u ? Interval{part.u0, part.u1} : Interval{part.v0, part.v1};
    const auto largest = [&](int order) {
      return std::max(derivative_bound(surface.first(), along, order),
                      derivative_bound(surface.second(), along, order));
    };
    const Domain d = surface.domain();
    const double length = along_u ? d.v1 - d.v0 : d.u1 - d.u0;
    const double across = k == 0 ? largest(0) : k == 1 ? 2 * largest(0) / length : 0;
    if (along_u) return {largest(k), across};
    return {across, largest(k)};
  };
}

}  // namespace

Result<PatchGrid> to_bezier(const RuledSurface& surface, const FitOptions& options) {
  return guarded([&] {
    if (surface.is_exact()) return exact(surface);
    FitOptions fit = options;
    std::vector<double>& breaks = surface.straight() == Direction::v ? fit.breaks_u : fit.breaks_v;
    for (const BorderCurve* border : {&surface.first(), &surface.second()}) add_breaks(breaks, *border, fit.degree);
    return fitted(surface, bounds_of(surface), fit);
  });
}

}}  // namespace tessera::abi_0_1
