#pragma once
// A rectangle of pixels: the memory to trace it with, and two ways to colour it.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/camera.h"
#include "render/environment.h"
#include "render/render.h"

namespace tessera::render {

/// Data that all tiles of a picture share.
struct View {
  const RayScene& scene;
  const Environment& environment;
  const PixelRays& camera;
  const Settings& settings;
  double size = 0;  ///< of the model
  const std::atomic<bool>* cancel = nullptr;
};

struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
};

/// One camera ray; a pixel has several.
struct Sample {
  std::uint32_t pixel = 0;  ///< y * picture width + x
  int index = 0;            ///< 0 .. samples * samples - 1
};

/// A point to be lit.
struct Point {
  std::size_t sample = 0;  ///< in the tile
  Vec3 position;
  Vec3 normal;     ///< towards the viewer
  Vec3 direction;  ///< of the ray that arrived here
  Vec3 albedo;     ///< reflected shares of red, green and blue, linear
  bool on_model = false;
};

/// The memory of one tile, used again for the next. No values carry over.
struct Workspace {
  std::vector<Sample> samples;  ///< pixel by pixel, row by row
  std::vector<Ray> rays;        ///< one per sample
  std::vector<Hit> hits;        ///< and their hits
  std::vector<Vec3> colours;    ///< one per sample: linear radiances for lit tiles, screen values for flat ones

  std::vector<Point> points, mirrored_points;
  std::vector<Vec3> light, mirrored, mirrored_light;
  std::vector<std::size_t> mirrors, mirrored_by;
  std::vector<Ray> secondary_rays;
  std::vector<Hit> secondary_hits;
  std::vector<std::uint8_t> occluded;
};

/// Checks that a picture of the box can be drawn.
Status check(const Settings& settings, const Box3& box);

/// Fills samples, rays and hits.
Status trace(const View& view, const Tile& tile, Workspace& work);

/// The normal that is shaded at a hit: the surface's, or that of Settings::normal.
inline Vec3 shading_normal(const Settings& settings, const Hit& hit) {
  return settings.normal ? settings.normal(hit) : hit.normal;
}

/// The colour at a hit, if the settings have one there.
inline std::optional<Vec3> srgb_colour(const Settings& settings, const Hit& hit) {
  const std::optional<Colour> colour = settings.colour ? settings.colour(hit) : std::nullopt;
  return colour ? std::optional<Vec3>({colour->red, colour->green, colour->blue}) : std::nullopt;
}

/// Fill colours from samples, rays and hits.
Status shade_lit(const View& view, Workspace& work);
void shade_flat(const View& view, Workspace& work);

}  // namespace tessera::render
