#pragma once
// Adapters that present surfaces of other kinds to the fit as functions of (u, v).

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "basis/knots.h"
#include "tessera/convert.h"
#include "tessera/parametric_surface.h"

namespace tessera { inline namespace abi_0_1 {

/// Bounds of derivatives, as in SurfaceFunctions; empty if there are none.
using DerivativeBounds = std::function<std::array<double, 2>(const Domain& part, int k)>;

/// Adds the inner knots at which a border has fewer continuous derivatives than patches of this degree need.
inline void add_breaks(std::vector<double>& breaks, const BorderCurve& border, int degree) {
  const auto* curve = std::get_if<Curve>(&border);
  if (curve == nullptr) return;
  for (const double knot : curve->knots()) {
    const bool inner = knot > curve->domain().from && knot < curve->domain().to;
    if (!inner || curve->degree() - static_cast<int>(multiplicity(curve->knots(), knot)) >= degree) continue;
    const auto place = std::find_if(breaks.begin(), breaks.end(), [&](double t) { return t >= knot; });
    if (place == breaks.end() || *place != knot) breaks.insert(place, knot);
  }
}

/// Fits patches to a surface with position(surface, u, v) and evaluate_jet(surface, u, v). Either may fail; the fit
/// then fails with the same Status.
template <class Surface>
Result<PatchGrid> fitted(const Surface& surface, DerivativeBounds bounds, const FitOptions& options) {
  Status failure;
  const auto value = [&failure](auto result) {
    if (!result) {
      failure = result.status();
      throw std::runtime_error(failure.message());  // a function's only way out of a fit
    }
    return *std::move(result);
  };
  SurfaceFunctions functions;
  functions.position = [&](double u, double v) { return value(position(surface, u, v)); };
  functions.jet = [&](double u, double v) { return value(evaluate_jet(surface, u, v)); };
  functions.derivative_bounds = std::move(bounds);
  const auto parametric = ParametricSurface::make(std::move(functions), surface.domain());
  if (!parametric) return failure.ok() ? parametric.status() : failure;
  auto grid = to_bezier(*parametric, options);
  if (!grid && !failure.ok()) return failure;
  return grid;
}

}}  // namespace tessera::abi_0_1
