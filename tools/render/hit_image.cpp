#include "render/hit_image.h"

#include <algorithm>
#include <string>

#include "render/camera.h"
#include "render/tile.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::render {
namespace {

constexpr std::size_t rays_per_band = std::size_t{1} << 16;

HitImage empty_image(int width, int height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  HitImage image{width, height, {}, {}, {}, {}, {}};
  image.depths.resize(pixels);
  image.normals.resize(pixels);
  image.parameters.resize(pixels);
  image.surfaces.resize(pixels);
  image.patches.resize(pixels);
  return image;
}

void set_pixel(HitImage& image, std::size_t pixel, const Hit& hit, const Model& model) {
  image.depths[pixel] = static_cast<float>(hit.t);
  const bool met = hit.kind == HitKind::hit;
  image.surfaces[pixel] = met ? hit.surface : HitImage::nothing;
  image.patches[pixel] = met ? hit.patch : HitImage::nothing;
  if (!met) return;
  image.normals[pixel] = {static_cast<float>(hit.normal.x), static_cast<float>(hit.normal.y),
                          static_cast<float>(hit.normal.z)};
  const auto own = own_parameters(model.surfaces[hit.surface].surface, hit.u, hit.v);
  image.parameters[pixel] = {static_cast<float>(own[0]), static_cast<float>(own[1])};
}

Status check_surfaces(std::span<const Hit> hits, const Model& model) {
  for (const Hit& hit : hits)
    if (hit.kind == HitKind::hit && hit.surface >= model.surfaces.size())
      return {StatusCode::invalid_argument, "a ray meets surface " + std::to_string(hit.surface) + ", the model has " +
                                                std::to_string(model.surfaces.size())};
  return {};
}

Result<HitImage> cast(const ClosestHits& closest, const Box3& box, const Model& model, const Settings& settings,
                      const Execution& execution) {
  if (Status status = check(settings, box); !status.ok()) return status;
  HitImage image = empty_image(settings.width, settings.height);
  const PixelRays pixels(choose_camera(settings, box), settings.width, settings.height);
  const std::size_t count = image.depths.size(), width = static_cast<std::size_t>(settings.width);
  std::vector<Ray> rays;
  std::vector<Hit> hits(std::min(count, rays_per_band));
  for (std::size_t first = 0; first < count; first += rays.size()) {
    rays.clear();
    for (std::size_t k = first; k < std::min(count, first + rays_per_band); ++k)
      rays.push_back(pixels.through(static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5));
    const std::span<Hit> met = std::span(hits).first(rays.size());
    Status status = closest(rays, met, Execution{.cancel = execution.cancel, .progress = {}});
    if (status.ok()) status = check_surfaces(met, model);
    if (!status.ok()) return status;
    for (std::size_t k = 0; k < met.size(); ++k) set_pixel(image, first + k, met[k], model);
    if (execution.progress) execution.progress(static_cast<double>(first + rays.size()) / static_cast<double>(count));
  }
  return image;
}

}  // namespace

Result<HitImage> cast_hits(const ClosestHits& closest, const Box3& box, const Model& model, const Settings& settings,
                           const Execution& execution) {
  return guarded([&] { return cast(closest, box, model, settings, execution); });
}

}  // namespace tessera::render
