#pragma once
// A rectangle of pixels: what it is traced with, and the two ways to colour it.

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
  double size = 0;                            ///< of the model
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

/// A tile's rays, and what they meet.
struct TracedTile {
  std::vector<Sample> samples;  ///< pixel by pixel, row by row
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};
Status trace(const View& view, const Tile& tile, TracedTile& out);

/// A colour a sample: linear radiances, and colours for the screen as they are.
Status shade_lit(const View& view, const TracedTile& traced, std::vector<Vec3>& colours);
void shade_flat(const View& view, const TracedTile& traced, std::vector<Vec3>& colours);

}  // namespace tessera::render
