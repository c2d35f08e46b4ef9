#include "measure/face_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "base/impl_access.h"
#include "base/text.h"
#include "measure/kept_strips.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// How far points of a placed or converted surface may be off by rounding, as a share of the largest coordinate.
constexpr double conversion_rounding = 16 * 0x1p-53;
/// How far grid_trims() may move a loop, as a share of the ranges.
constexpr double loop_share = 1e-9;

bool is_exact(const ModelSurface& surface) {
  return std::holds_alternative<BezierPatch>(surface.surface) && surface.placement == Affine{};
}

/// Bounds on the lengths of a patch along u and along v.
std::array<double, 2> net_lengths(const BezierPatch& patch) {
  const int m = patch.degree_u(), n = patch.degree_v();
  std::array<double, 2> lengths{};
  for (int i = 0; i < m; ++i) {
    double longest = 0;
    for (int j = 0; j <= n; ++j) longest = std::max(longest, length(patch.point(i + 1, j) - patch.point(i, j)));
    lengths[0] += longest;
  }
  for (int j = 0; j < n; ++j) {
    double longest = 0;
    for (int i = 0; i <= m; ++i) longest = std::max(longest, length(patch.point(i, j + 1) - patch.point(i, j)));
    lengths[1] += longest;
  }
  return lengths;
}

/// Adds an estimate of the error of an area by a surface's fit, whose slopes may differ from the surface's too. For
/// that, the error is taken for a polynomial of the patch's degree n: over [0,1], its derivative is at most 2 n^2 times
/// as large (A. A. Markov's inequality).
void add_fit_error(const FitError& fit, const BezierPatch& patch, double reach, ExactSums& area) {
  if (!(fit.distance > 0)) return;
  const auto slope_error = [&](int degree) { return 2.0 * degree * degree * fit.distance; };
  const double error_u = slope_error(patch.degree_u()), error_v = slope_error(patch.degree_v());
  const auto [along_u, along_v] = net_lengths(patch);
  Integrals all;
  for (std::size_t k = 0; k < 4; ++k)
    all.error[k] = (error_u * along_v + error_v * along_u + error_u * error_v) *
                   std::pow(reach, moment_degree(static_cast<int>(k)));
  area.add(all, 1);
}

/// Adds the error of a flux by a surface's fit: the volume between the surface and its patches.
void add_fit_error(const FitError& fit, const Integrals& area, double reach, ExactSums& flux) {
  if (!(fit.distance > 0)) return;
  Integrals all;
  const double volume = 3 * fit.distance * (area.value[0] + area.error[0]);
  for (int k = 0; k < 10; ++k) all.error[static_cast<std::size_t>(k)] = 2 * volume * std::pow(reach, moment_degree(k));
  flux.add(all, 1);
}

double reach_of(const Box3& box, const Vec3& centre) { return length(box.centre() - centre) + 0.5 * box.diagonal(); }

}  // namespace

Status check_options(const MeasureOptions& options) {
  if (!(options.accuracy >= 1e-14 && options.accuracy <= 1e-2))
    return Status(StatusCode::invalid_argument,
                  "the accuracy must be from 1e-14 to 1e-2, found " + text(options.accuracy));
  if (options.max_cells == 0) return Status(StatusCode::invalid_argument, "max_cells must be at least 1, found 0");
  return {};
}

Result<MeasuredFace> make_face(const ModelSurface& surface, const std::vector<TrimLoop>& loops) {
  Result<PatchGrid> grid = to_bezier(surface);
  if (!grid) return grid.status();
  MeasuredFace face{*std::move(grid)};
  const Box3& box = face.grid.box();
  face.data_error = is_exact(surface) ? 0 : conversion_rounding * std::max(max_abs(box.lower), max_abs(box.upper));
  face.proven = face.grid.fit_error().distance == 0;
  if (loops.empty()) return face;
  ModelSurface trimmed = surface;
  trimmed.trims = loops;
  const Result<Shared<std::vector<TrimLoop>>> mapped = grid_trims(trimmed);
  const Result<TrimRegion> region =
      mapped ? TrimRegion::Impl::make(**mapped, face.grid, TrimRegion::Impl::Use::patches) : mapped.status();
  if (!region && region.status().code() == StatusCode::out_of_memory) return region.status();
  if (region) {
    face.region = *region;
  } else {
    face.fault = region.status();
    face.proven = false;
  }
  if (region && std::holds_alternative<QuadricPiece>(surface.surface) && **mapped != loops) {
    const Domain range = face.grid.domain();
    face.loop_error = {loop_share * (range.u1 - range.u0), loop_share * (range.v1 - range.v0)};
    for (const TrimPiece& piece : impl_of(*region).pieces)
      if (piece.start().u != piece.end().u && piece.start().v != piece.end().v) face.proven = false;
  }
  return face;
}

FaceIntegrals integrate(const MeasuredFace& face, const Vec3& centre, bool area, bool flux,
                        const MeasureOptions& options) {
  FaceIntegrals all;
  all.proven = face.proven;
  const StripLimits limits{options.accuracy, options.max_cells};
  const double reach = reach_of(face.grid.box(), centre);
  const auto add = [&](std::size_t place, std::span<const CurveStrip> strips) {
    const BezierPatch& patch = face.grid.patches()[place];
    if (area) add_fit_error(face.grid.fit_error(), patch, reach, all.area);
    const Vec3 middle = patch.hull_box().centre();
    const StripPatch local{LocalNet(patch, middle, face.data_error), middle - centre};
    for (const CurveStrip& strip : strips) {
      if (area) add_strip(local, strip, Integrand::area, limits, all.area);
      if (area) add_band(local, strip, Integrand::area, all.area);
      if (flux) add_strip(local, strip, Integrand::flux, limits, all.flux);
      if (flux) add_band(local, strip, Integrand::flux, all.flux);
    }
  };
  if (face.region && !face.region->is_whole()) {
    const KeptStrips kept = kept_strips(impl_of(*face.region), face.loop_error);
    all.proven = all.proven && kept.is_certain;
    for (const PatchStrips& patch : kept.patches) add(patch.place, patch.strips);
  } else {
    const CurveStrip whole = whole_strip();
    for (std::size_t place = 0; place < face.grid.patches().size(); ++place) add(place, std::span(&whole, 1));
  }
  if (area && flux) add_fit_error(face.grid.fit_error(), all.area.sums(), reach, all.flux);
  return all;
}

}}  // namespace tessera::abi_0_1
