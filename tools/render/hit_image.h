#pragma once
// Pictures of numbers: what the ray through the middle of each pixel hits.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/render.h"
#include "tessera/model.h"

namespace tessera::render {

/// One value per pixel, rows from the top. For a miss: an infinite depth, zeros, and `nothing`.
struct HitImage {
  static constexpr std::uint32_t nothing = ~std::uint32_t{0};

  int width = 0, height = 0;
  std::vector<float> depths;                     ///< distance from the eye
  std::vector<std::array<float, 3>> normals;     ///< unit, along r_u x r_v; zero where undefined
  std::vector<std::array<float, 2>> parameters;  ///< (u,v) in the surface's own parameters
  std::vector<std::uint32_t> surfaces, patches;  ///< counted from 0
};

/// Finds the closest hits of rays, as RayScene::closest() does.
using ClosestHits = std::function<Status(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution)>;

/// Casts a ray per pixel. `closest` is called on this thread, with a band of rows at a time. Uses only size and camera
/// of the settings. `model` is the one that the scene was made of. The result is the same for any number of threads,
/// byte for byte. Memory: 40 bytes per pixel. Errors: those of render, and invalid_argument (the scene has more
/// surfaces than the model).
Result<HitImage> cast_hits(const ClosestHits& closest, const Box3& box, const Model& model, const Settings& settings,
                           const Execution& execution = {});

/// Writes OpenEXR, lossless (ZIP): 32-bit floats Z (depth), N.X N.Y N.Z, UV.U UV.V, and 32-bit integers surface and
/// patch. The file is open; the caller commits it. Memory: the compressed file. Errors: invalid_argument (lengths that
/// don't fit the size), out_of_memory, internal (OpenEXR).
Status write_exr(const HitImage& image, OutputFile& out);

}  // namespace tessera::render
