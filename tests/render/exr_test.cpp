// Pictures of numbers: each pixel holds the hit of its ray, and comes back from OpenEXR's reader bit for bit.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/camera.h"
#include "render/hit_image.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::render { namespace {

using test::value_of;

Result<HitImage> cast_hits(const RayScene& scene, const Box3& box, const Model& model, const Settings& settings,
                           const Execution& execution = {}) {
  const ClosestHits closest = [&](std::span<const Ray> rays, std::span<Hit> hits, const Execution& how) {
    return scene.closest(rays, hits, how);
  };
  return render::cast_hits(closest, box, model, settings, execution);
}

Status write_exr(const HitImage& image, const std::string& path) {
  Result<OutputFile> out = OutputFile::make(path);
  if (!out) return out.status();
  Status status = render::write_exr(image, *out);
  return status.ok() ? out->commit() : status;
}

/// A model ready for rays.
struct Scene {
  explicit Scene(Model of)
      : model(std::move(of)), set(value_of(make_patch_set(model))), rays(value_of(RayScene::make(set))) {}
  static Scene of(const std::string& name) {
    return Scene(value_of(read_model(TESSERA_SOURCE_DIR "/tools/models/" + name + ".json")));
  }
  HitImage image(const Settings& settings) const { return value_of(cast_hits(rays, rays.box(), model, settings)); }

  Model model;
  PatchSet set;
  RayScene rays;
};

Settings size(int width, int height) {
  Settings settings;
  settings.width = width, settings.height = height;
  return settings;
}

/// A channel of a file.
template <class T>
std::vector<T> channel(const std::string& path, const char* name, Imf::PixelType type, int width, int height) {
  Imf::InputFile file(path.c_str());
  const Imf::Channel* const found = file.header().channels().findChannel(name);
  EXPECT_TRUE(found && found->type == type) << name;
  std::vector<T> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T),
                                 sizeof(T) * static_cast<std::size_t>(width)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, height - 1);
  return values;
}

TEST(HitImages, EachPixelIsWhatItsRayMeets) {
  for (const char* name : {"sphere_of_octants", "quadric_elliptic_cylinder", "torus"}) {
    const Scene scene = Scene::of(name);
    constexpr int width = 37, height = 23;
    const HitImage image = scene.image(size(width, height));
    const Camera camera = fit_camera(scene.rays.box(), width, height, Up::z);
    const PixelRays pixels(camera, width, height);
    std::size_t met = 0;
    for (std::size_t k = 0; k < image.depths.size(); ++k) {
      const Ray ray = pixels.through(static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5);
      if (image.surfaces[k] == HitImage::nothing) {
        EXPECT_EQ(scene.rays.closest(ray).kind, HitKind::miss);
        EXPECT_EQ(image.patches[k], HitImage::nothing);
        EXPECT_EQ(image.depths[k], std::numeric_limits<float>::infinity());
        EXPECT_EQ(image.normals[k], (std::array<float, 3>{}));
        continue;
      }
      ++met;
      // The surface itself, at the pixel's parameters, lies on the ray at the pixel's depth.
      const ModelSurface& surface = scene.model.surfaces.at(image.surfaces[k]);
      const SurfaceJet jet = value_of(evaluate_jet(surface, image.parameters[k][0], image.parameters[k][1]));
      const double scale = scene.rays.box().diagonal();
      EXPECT_LE(length(jet.position - (ray.origin + double{image.depths[k]} * ray.direction)), 2e-6 * scale) << name;
      const auto& n = image.normals[k];
      EXPECT_NEAR(std::abs(dot(normalized(cross(jet.du, jet.dv)), Vec3{n[0], n[1], n[2]})), 1, 1e-5) << name;
      EXPECT_LT(image.patches[k], scene.set.patch_count());
      EXPECT_EQ(scene.set.source(image.patches[k]).surface, image.surfaces[k]);
    }
    EXPECT_GT(met, image.depths.size() / 20) << name;
    EXPECT_LT(met, image.depths.size()) << name;
  }
}

TEST(HitImages, PicturesOfSeveralBandsHaveEveryRow) {
  const Scene scene = Scene::of("sphere_of_octants");
  Settings settings = size(600, 300);  // 180,000 rays
  settings.camera = Camera{{0, 0, 5}, {}, 10, {0, 1, 0}};
  const HitImage image = scene.image(settings);
  for (const float depth : image.depths) EXPECT_TRUE(depth > 3.9f && depth < 5.1f) << depth;
}

TEST(HitImages, WhatCannotBeCast) {
  const Scene scene = Scene::of("sphere_of_octants");
  EXPECT_EQ(cast_hits(scene.rays, scene.rays.box(), scene.model, size(0, 5)).status().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(cast_hits(scene.rays, {}, scene.model, size(5, 5)).status().code(), StatusCode::invalid_argument);
  const Status status = cast_hits(scene.rays, scene.rays.box(), Model{}, size(9, 9)).status();
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(cast_hits(scene.rays, scene.rays.box(), scene.model, size(9, 9), {.cancel = &cancel, .progress = {}})
                .status()
                .code(),
            StatusCode::cancelled);
}

TEST(ExrFiles, EveryBitComesBack) {
  const test::ScratchFolder folder;
  const std::string path = folder / "a.exr";
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{37, 23}, std::pair{130, 70}}) {
    const HitImage image = Scene::of("goblet").image(size(width, height));
    const Status status = write_exr(image, path);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(folder.names().size(), 1u);
    EXPECT_EQ(channel<float>(path, "Z", Imf::FLOAT, width, height), image.depths);
    EXPECT_EQ(channel<std::uint32_t>(path, "surface", Imf::UINT, width, height), image.surfaces);
    EXPECT_EQ(channel<std::uint32_t>(path, "patch", Imf::UINT, width, height), image.patches);
    const std::vector<float> z = channel<float>(path, "N.Z", Imf::FLOAT, width, height);
    const std::vector<float> y = channel<float>(path, "N.Y", Imf::FLOAT, width, height);
    const std::vector<float> x = channel<float>(path, "N.X", Imf::FLOAT, width, height);
    const std::vector<float> u = channel<float>(path, "UV.U", Imf::FLOAT, width, height);
    const std::vector<float> v = channel<float>(path, "UV.V", Imf::FLOAT, width, height);
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_EQ((std::array{x[k], y[k], z[k]}), image.normals[k]);
      EXPECT_EQ((std::array{u[k], v[k]}), image.parameters[k]);
    }
  }
}

TEST(ExrFiles, WhatCannotBeWritten) {
  const test::ScratchFolder folder;
  HitImage image = Scene::of("plane").image(size(8, 8));
  EXPECT_EQ(write_exr(image, folder / "none/a.exr").code(), StatusCode::io_error);
  EXPECT_EQ(write_exr(image, "/dev/full").code(), StatusCode::io_error);
  image.normals.pop_back();
  EXPECT_EQ(write_exr(image, folder / "a.exr").code(), StatusCode::invalid_argument);
  EXPECT_EQ(write_exr(HitImage{}, folder / "a.exr").code(), StatusCode::invalid_argument);
  EXPECT_TRUE(folder.names().empty());
}

}}  // namespace tessera::render
