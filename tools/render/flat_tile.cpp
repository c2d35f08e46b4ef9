// Shades that show numbers: normals, parameters, patches, errors, curvature, cost.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/colours.h"
#include "render/random.h"
#include "render/tile.h"

namespace tessera::render {
namespace {

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

Vec3 hit_curvature_colour(const RayScene& scene, double size, const Hit& hit) {
  const Result<LocalGeometry> geometry = scene.local_geometry(hit);
  if (!geometry || !geometry->defined) return {0.25, 0.25, 0.25};
  return curvature_colour(curvature_share(geometry->gaussian, size));
}

Vec3 surface_colour(const Hit& hit, const View& view) {
  const Settings& settings = view.settings;
  if (settings.shade == Shade::uv) return uv_colour(hit);
  if (settings.shade == Shade::curvature) return hit_curvature_colour(view.scene, view.size, hit);
  if (settings.shade != Shade::error) return patch_colour(hit.patch);
  const double share = settings.error(hit.position);
  return settings.signed_error ? deviation_colour(share) : error_colour(share);
}

/// Grey or the model's colour, by a light above the eye.
Vec3 clay_colour(const Vec3& normal, const Vec3& direction, const Vec3& up, const std::optional<Vec3>& colour) {
  const Vec3 towards = dot(normal, direction) > 0 ? -normal : normal;
  const double light = std::max(dot(towards, normalized(0.8 * up - direction)), 0.0);
  return (0.16 + 0.8 * light) * colour.value_or(Vec3{1, 0.98, 0.95});
}

Vec3 colour(const Hit& hit, const Vec3& direction, const View& view) {
  if (view.settings.shade == Shade::steps && hit.steps > 0) return cost_colour(hit.steps);
  if (hit.kind != HitKind::hit) return view.settings.background;
  const Vec3 normal = shading_normal(view.settings, hit);
  if (view.settings.shade == Shade::normals) return 0.5 * (normal + Vec3{1, 1, 1});
  if (view.settings.shade == Shade::clay)
    return clay_colour(normal, direction, view.environment.up(), srgb_colour(view.settings, hit));
  // Darker where the surface turns away, so that its shape is visible.
  const double facing = 0.62 + 0.38 * std::abs(dot(normal, direction));
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
