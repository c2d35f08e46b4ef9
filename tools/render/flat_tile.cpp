// Shades that show numbers: normals, parameters, patches.

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

Vec3 colour(const Hit& hit, const Vec3& direction, Shade shade) {
  if (hit.kind != HitKind::hit) return background;
  if (shade == Shade::normals) return 0.5 * (hit.normal + Vec3{1, 1, 1});
  // Darker where the surface turns away: the shape stays readable.
  const double facing = 0.62 + 0.38 * std::abs(dot(hit.normal, direction));
  return facing * (shade == Shade::uv ? uv_colour(hit) : patch_colour(hit.patch));
}

}  // namespace

void shade_flat(const View& view, Workspace& work) {
  work.colours.resize(work.rays.size());
  for (std::size_t k = 0; k < work.colours.size(); ++k) {
    work.colours[k] = colour(work.hits[k], work.rays[k].direction, view.settings.shade);
  }
}

}  // namespace tessera::render
