#pragma once
// Pictures of ray scenes: camera, shading, PNG.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/file/output_file.h"
#include "render/up_axis.h"
#include "tessera/colour.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera::render {

/// A pinhole camera. The field of view spans the picture's shorter side.
struct Camera {
  Vec3 eye, target;
  double fov_degrees = 40;
  Vec3 up{0, 0, 1};
};

enum class Shade : std::uint8_t {
  lambert,    ///< glazed porcelain, or Settings::colour, on a floor: sun, soft shadow, light of the sky, one reflection
  normals,    ///< the unit normal, (n + 1) / 2 as red, green, blue
  uv,         ///< patch parameters: u red, v green, a checkerboard of eighths
  patch,      ///< a colour per patch
  error,      ///< distance of the surface by Settings::error: dark where small, red where largest
  curvature,  ///< Gaussian: domes red, saddles blue, grey where it is zero
  clay,       ///< grey, or Settings::colour, lit from above the eye; no floor
  steps,      ///< Hit::steps, the cost of each ray, hits and misses: blue at 1, red from max_steps_shown on
};

inline constexpr double max_steps_shown = 256;

struct Settings {
  int width = 1280, height = 800;  ///< 1 to 32768
  Shade shade = Shade::lambert;
  std::optional<Camera> camera;         ///< if empty, one that fits the box to the picture
  Up up = Up::z;                        ///< for sky, floor and the camera that fits the box
  int samples = 4;                      ///< samples x samples per pixel, 1 to 16
  bool simple_light = false;            ///< for Shade::lambert: only the sun casts shadows, and nothing is reflected
  Vec3 background{0.955, 0.955, 0.96};  ///< of all shades but lambert, sRGB from 0 to 1
  /// For Shade::error: the distance at a point of the surface, as a share of the largest one that colours distinguish;
  /// above 1 is magenta. Called from any number of threads.
  std::function<double(const Vec3&)> error = {};
  bool signed_error = false;  ///< for Shade::error: whether shares run from -1 to 1, in the colours of deviations
  /// The unit normal to shade at a hit; empty: the surface's. Called from any number of threads.
  std::function<Vec3(const Hit&)> normal = {};
  /// The colour at a hit in sRGB, for Shade::lambert and Shade::clay; without a value: the shade's own. Called from any
  /// number of threads.
  std::function<std::optional<Colour>(const Hit&)> colour = {};
  /// The point nearest to a hit on the edges to draw as lines, if it is nearer than a distance; empty: no lines. Called
  /// from any number of threads.
  std::function<std::optional<Vec3>(const Hit&, double within)> nearest_edge = {};
};

/// Rows from the top, three bytes per pixel, sRGB.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Renders a picture of `box`, by default of the commands RayScene::box(). The result is the same for any number of
/// threads, byte for byte. Errors: invalid_argument (an empty box, settings out of range, no error to shade),
/// cancelled, and those of RayScene::closest.
Result<Image> render(const RayScene& scene, const Box3& box, const Settings& settings, const Execution& execution = {});

/// Height of the bands of render_bands(), in pixels.
inline constexpr int band_height = 8;

/// Renders the same picture as render(), as far as next_band() names its bands of rows, from 0 on from the top; until
/// it names one below the picture. Other pixels stay black. So several processes can share a picture. Errors: as
/// render(), and those of next_band(), which is called on this thread.
Result<Image> render_bands(const RayScene& scene, const Box3& box, const Settings& settings,
                           const std::function<Result<std::uint64_t>()>& next_band, const Execution& execution = {});

/// Keywords, such as "Warning", and their text: tEXt chunks in Latin-1 (PNG specification, 11.3.4.3).
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// Writes a file, which appears whole or not at all: it is written beside its place, then renamed. Errors:
/// invalid_argument (an image whose bytes don't fit its size), io_error.
Status write_png(const Image& image, const std::filesystem::path& path);
/// Writes row by row into an open file. The caller commits it, which also reports a failed write. Errors:
/// invalid_argument, out_of_memory, internal (libpng).
Status write_png(const Image& image, OutputFile& out, const PngTexts& texts = {});

}  // namespace tessera::render
