#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "surface/net/checks.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the interval that holds t. A breakpoint belongs to the interval on its right; the end, to the last one.
std::size_t interval(std::span<const double> breaks, double t) {
  const auto above = std::upper_bound(breaks.begin(), breaks.end(), t);
  return std::min<std::size_t>(static_cast<std::size_t>(above - breaks.begin()) - 1, breaks.size() - 2);
}

}  // namespace

Result<PatchGrid> PatchGrid::make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                  std::vector<BezierPatch> patches, FitError error) {
  Box3 box;
  for (const BezierPatch& patch : patches) box.extend(patch.hull_box());
  return make(std::move(breaks_u), std::move(breaks_v), std::move(patches), error, box);
}

Result<PatchGrid> PatchGrid::make(std::vector<double> breaks_u, std::vector<double> breaks_v,
                                  std::vector<BezierPatch> patches, FitError error, const Box3& box) {
  return guarded([&]() -> Result<PatchGrid> {
    if (Status status = check_increasing(breaks_u, "breakpoint", "u"); !status.ok()) return status;
    if (Status status = check_increasing(breaks_v, "breakpoint", "v"); !status.ok()) return status;
    const std::size_t wanted = (breaks_u.size() - 1) * (breaks_v.size() - 1);
    if (patches.size() != wanted)
      return Status(StatusCode::count_mismatch, "these breakpoints make " + counted(wanted, "patch", "patches") +
                                                    ", found " + std::to_string(patches.size()));
    if (!(error.distance >= 0) || !std::isfinite(error.distance))
      return Status(StatusCode::invalid_argument, "the fit error must be finite and not negative");
    PatchGrid grid;
    grid.breaks_u_ = std::move(breaks_u);
    grid.breaks_v_ = std::move(breaks_v);
    grid.patches_ = std::move(patches);
    grid.error_ = error;
    grid.box_ = box;
    return grid;
  });
}

Domain PatchGrid::patch_domain(std::size_t patch) const {
  const std::size_t a = patch / count_v(), b = patch % count_v();
  return {breaks_u_[a], breaks_u_[a + 1], breaks_v_[b], breaks_v_[b + 1]};
}

std::optional<PatchLocation> PatchGrid::locate(double u, double v) const {
  if (!domain().contains(u, v)) return std::nullopt;
  const std::size_t patch = interval(breaks_u_, u) * count_v() + interval(breaks_v_, v);
  const Domain d = patch_domain(patch);
  return PatchLocation{patch, d.local_u(u), d.local_v(v)};
}

std::optional<SurfaceJet> PatchGrid::evaluate_jet(double u, double v) const {
  const auto place = locate(u, v);
  if (!place) return std::nullopt;
  const Domain d = patch_domain(place->patch);
  const double a = 1 / (d.u1 - d.u0), b = 1 / (d.v1 - d.v0);  // chain rule
  SurfaceJet jet = tessera::evaluate_jet(patches_[place->patch], place->u, place->v);
  jet.du = a * jet.du;
  jet.dv = b * jet.dv;
  jet.duu = (a * a) * jet.duu;
  jet.duv = (a * b) * jet.duv;
  jet.dvv = (b * b) * jet.dvv;
  return jet;
}

Result<PatchGrid> transform(const PatchGrid& grid, const Affine& map) {
  return guarded([&]() -> Result<PatchGrid> {
    if (!is_finite(map)) return Status(StatusCode::non_finite, "an affine map must be finite");
    std::vector<BezierPatch> patches;
    patches.reserve(grid.patches().size());
    std::vector<Vec3> points;
    const auto& [x, y, z] = map.columns;
    double size = 0;  // bounds the terms of each coordinate's sum of products
    for (const BezierPatch& patch : grid.patches()) {
      points.clear();
      for (const Vec3& p : patch.points()) {
        points.push_back(map.point(p));
        size = std::max(size, std::abs(p.x) * max_abs(x) + std::abs(p.y) * max_abs(y) + std::abs(p.z) * max_abs(z));
      }
      Result<BezierPatch> image = patch.with_points(points);
      if (!image) {
        const std::size_t k = patches.size();
        return Status(image.status().code(), "patch " + std::to_string(k) + ", mapped: " + image.status().message(),
                      static_cast<std::ptrdiff_t>(k));
      }
      patches.push_back(*std::move(image));
    }
    const FitError& error = grid.fit_error();
    double distance = 0;  // an exact surface stays exact
    if (error.distance > 0) {
      // A coordinate is a sum of three rounded products and the translation: six roundings of 2^-53, in three
      // coordinates.
      const double rounding = 0x1p-49 * (size + max_abs(map.translation));
      distance = error.distance * map.norm_bound() * (1 + 0x1p-40) + rounding;
    }
    const auto copy = [](std::span<const double> breaks) { return std::vector<double>(breaks.begin(), breaks.end()); };
    return PatchGrid::make(copy(grid.breaks_u()), copy(grid.breaks_v()), std::move(patches),
                           {distance, error.certified});
  });
}

}}  // namespace tessera::abi_0_1
