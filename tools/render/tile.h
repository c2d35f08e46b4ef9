#pragma once
// A rectangle of pixels: what it is traced with, and the two ways to colour it.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/camera.h"
#include "render/environment.h"
#include "render/render.h"

namespace tessera::render {

/// The whole picture's.
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

/// One camera ray; several make a pixel.
struct Sample {
  std::uint32_t pixel = 0;  ///< y * picture width + x
  int index = 0;            ///< 0 .. samples * samples - 1
};

/// A point to be lit.
struct Point {
  std::size_t sample = 0;  ///< in the tile
  Vec3 position;
  Vec3 normal;     ///< towards the viewer
  Vec3 direction;  ///< of the ray that came here
  bool on_model = false;
};

/// What one tile needs, kept from tile to tile. Nothing in it carries over but memory.
struct Workspace {
  std::vector<Sample> samples;  ///< pixel by pixel, row by row
  std::vector<Ray> rays;        ///< one a sample
  std::vector<Hit> hits;        ///< and what it meets
  std::vector<Vec3> colours;    ///< of each sample: linear radiances for lit tiles, as on the screen for flat ones

  std::vector<Point> points, mirrored_points;
  std::vector<Vec3> light, mirrored, mirrored_light;
  std::vector<std::size_t> mirrors, mirrored_by;
  std::vector<Ray> secondary_rays;
  std::vector<Hit> secondary_hits;
  std::vector<std::uint8_t> occluded;
};

/// Whether a picture of the box can be drawn.
Status check(const Settings& settings, const Box3& box);

/// Fills samples, rays and hits.
Status trace(const View& view, const Tile& tile, Workspace& work);

/// Fill colours from them.
Status shade_lit(const View& view, Workspace& work);
void shade_flat(const View& view, Workspace& work);

}  // namespace tessera::render
