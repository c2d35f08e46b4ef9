// Shades that show numbers: normals, parameters, patches, errors, curvature, cost.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/random.h"
#include "render/tile.h"

namespace tessera::render {
namespace {

const Vec3 background{0.955, 0.955, 0.96};

/// Hues by the golden ratio, so that neighbours in number differ well.
Vec3 patch_colour(std::uint32_t patch) {
  const double hue = std::fmod(patch * std::numbers::phi, 1.0) * 2 * std::numbers::pi;
  const double light = patch % 3 == 0 ? 0.62 : patch % 3 == 1 ? 0.72 : 0.54;
  constexpr double third = 2 * std::numbers::pi / 3;
  return {light + 0.24 * std::cos(hue), light + 0.24 * std::cos(hue - third), light + 0.24 * std::cos(hue + third)};
}

Vec3 uv_colour(const Hit& hit) {
  const auto cell = [](double t) { return std::min(static_cast<int>(t * 8), 7); };
  const double check = (cell(hit.patch_u) + cell(hit.patch_v)) % 2 == 0 ? 1 : 0.84;
  return check * Vec3{0.12 + 0.85 * hit.patch_u, 0.12 + 0.85 * hit.patch_v, 0.42};
}

/// From deep blue over green and yellow to red: each is lighter or warmer than the one before, so that the order is
/// visible.
Vec3 error_colour(double share) {
  constexpr std::array<Vec3, 5> stops{
      Vec3{0.10, 0.14, 0.38}, {0.13, 0.45, 0.60}, {0.36, 0.72, 0.42}, {0.96, 0.83, 0.28}, {0.80, 0.16, 0.12}};
  if (!(share <= 1)) return {0.93, 0.20, 0.85};
  const double at = std::max(share, 0.0) * (stops.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(before);
  return (1 - t) * stops[before] + t * stops[before + 1];
}

/// Gaussian curvature: domes red, saddles blue, developable surfaces grey. Half of full colour at a bend of a sixteenth
/// of the model's size.
Vec3 curvature_colour(const RayScene& scene, double size, const Hit& hit) {
  const Vec3 flat{0.86, 0.86, 0.84}, dome{0.78, 0.13, 0.10}, saddle{0.09, 0.25, 0.66};
  const Result<LocalGeometry> geometry = scene.local_geometry(hit);
  if (!geometry || !geometry->defined) return {0.25, 0.25, 0.25};
  const double bend = std::sqrt(std::abs(geometry->gaussian)) * size / 16, share = bend / (1 + bend);
  return (1 - share) * flat + share * (geometry->gaussian > 0 ? dome : saddle);
}

/// The cost of a ray, hit or not, in the colours of errors; each colour stands for four times the one before.
Vec3 cost_colour(const Hit& hit) {
  return error_colour(std::min(1.0, std::log(std::max<double>(hit.steps, 1)) / std::log(max_steps_shown)));
}

Vec3 surface_colour(const Hit& hit, const View& view) {
  const Settings& settings = view.settings;
  if (settings.shade == Shade::uv) return uv_colour(hit);
  if (settings.shade == Shade::curvature) return curvature_colour(view.scene, view.size, hit);
  return settings.shade == Shade::error ? error_colour(settings.error(hit.position)) : patch_colour(hit.patch);
}

Vec3 colour(const Hit& hit, const Vec3& direction, const View& view) {
  if (view.settings.shade == Shade::steps && hit.steps > 0) return cost_colour(hit);
  if (hit.kind != HitKind::hit) return background;
  if (view.settings.shade == Shade::normals) return 0.5 * (hit.normal + Vec3{1, 1, 1});
  // Darker where the surface turns away, so that its shape is visible.
  const double facing = 0.62 + 0.38 * std::abs(dot(hit.normal, direction));
  return facing * surface_colour(hit, view);
}

}  // namespace

void shade_flat(const View& view, Workspace& work) {
  work.colours.resize(work.rays.size());
  for (std::size_t k = 0; k < work.colours.size(); ++k) {
    work.colours[k] = colour(work.hits[k], work.rays[k].direction, view);
  }
}

}  // namespace tessera::render
