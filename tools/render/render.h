#pragma once
// Pictures of ray scenes: camera, shading, PNG.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/output_file.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera::render {

/// A pinhole. The field of view spans the picture's shorter side.
struct Camera {
  Vec3 eye, target;
  double fov_degrees = 40;
  Vec3 up{0, 0, 1};
};

enum class Shade : std::uint8_t {
  lambert,    ///< glazed porcelain on a floor under a sky: sun with soft shadow, ambient light, one reflection
  normals,    ///< the unit normal, (n + 1) / 2 as red, green, blue
  uv,         ///< patch parameters: u red, v green, a checkerboard of eighths
  patch,      ///< a colour a patch
  error,      ///< how far something lies from the surface, of which Settings tells: dark where near, red where furthest
  curvature,  ///< Gaussian: domes red, saddles blue, grey where it is zero
  steps,      ///< Hit::steps, the cost of each ray, hits and misses: blue at 1, red at max_steps_shown and more
};

inline constexpr double max_steps_shown = 256;

struct Settings {
  int width = 1280, height = 800;  ///< 1 to 32768
  Shade shade = Shade::lambert;
  std::optional<Camera> camera;  ///< one that fits the box to the picture if empty
  int samples = 4;               ///< samples x samples a pixel, 1 to 16
  /// For Shade::error: how far, at a point of the surface, as a share of the largest that is to be told apart; what is
  /// above 1 is magenta. Called from any number of threads.
  std::function<double(const Vec3&)> error = {};
};

/// Rows from the top, three bytes a pixel, sRGB.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// `box`: what is to be seen, RayScene::box() by default of the commands. The same bytes for any number of threads.
/// Errors: invalid_argument (an empty box, settings out of range, no error to shade), cancelled, and those of RayScene::closest.
Result<Image> render(const RayScene& scene, const Box3& box, const Settings& settings, const Execution& execution = {});

/// Keywords and what they say, as tEXt chunks in Latin-1 (PNG specification, 11.3.4.3): "Warning", for example.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The file appears whole or not at all: it is written beside its place, then renamed.
/// Errors: invalid_argument (an image whose bytes don't fit its size), io_error.
Status write_png(const Image& image, const std::filesystem::path& path);
/// Row by row into an open file; what is left to do is to commit it, which also says whether a write has failed.
/// Errors: invalid_argument, out_of_memory, internal (libpng).
Status write_png(const Image& image, OutputFile& out, const PngTexts& texts = {});

}  // namespace tessera::render
