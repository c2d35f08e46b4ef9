// Meshes in pictures: the same outline and shade as their surfaces, lines along their edges.

#include "render/mesh_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/render.h"
#include "support/synthetic_sets.h"
#include "tessera/tessellation.h"

namespace tessera::render { namespace {

using test::value_of;

constexpr int picture_width = 90, picture_height = 60;

/// A square of two triangles or of one quad over [0,1]^2, with or without normals.
Mesh square(bool quad) {
  Mesh mesh;
  mesh.origin = {10, 0, 0};
  mesh.positions = {-10, 0, 0, -9, 0, 0, -9, 1, 0, -10, 1, 0};
  if (quad) {
    mesh.quads = {0, 1, 2, 3};
  } else {
    mesh.indices = {0, 1, 2, 0, 2, 3};
  }
  return mesh;
}

MeshPatches patches_of(const Mesh& mesh) {
  MeshPatches patches;
  const Status status = patches.add(mesh);
  EXPECT_TRUE(status.ok()) << status.message();
  return patches;
}

Image picture(const RayScene& scene, const Box3& box, const MeshPatches* mesh, bool edges) {
  Settings settings;
  settings.width = picture_width, settings.height = picture_height, settings.samples = 2,
  settings.shade = Shade::normals;
  if (mesh) settings.normal = [mesh](const Hit& hit) { return mesh->normal(hit); };
  if (edges) settings.nearest_edge = [mesh](const Hit& hit, double) { return mesh->nearest_edge(hit); };
  return value_of(render(scene, box, settings));
}

TEST(MeshPatches, APictureOfAMeshIsThatOfItsSurface) {
  const PatchSet set = value_of(PatchSet::make(test::sphere()));
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 1e-4, .relative = true}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  const MeshPatches patches = patches_of(mesh);
  const PatchSet triangles = value_of(patches.pack());
  EXPECT_EQ(triangles.patch_count(), patches.triangle_count());
  const Image expected = picture(value_of(RayScene::make(set)), set.box(), nullptr, false),
              found = picture(value_of(RayScene::make(triangles)), set.box(), &patches, false);
  std::size_t differing = 0;
  for (std::size_t k = 0; k < found.rgb.size(); ++k) differing += std::abs(found.rgb[k] - expected.rgb[k]) > 3;
  EXPECT_LT(differing, found.rgb.size() / 200);
}

TEST(MeshPatches, NormalsAreInterpolatedOrTheTriangles) {
  Mesh mesh = square(false);
  Hit hit;
  hit.patch = 0, hit.patch_u = 0.5, hit.patch_v = 0.25;
  EXPECT_EQ(patches_of(mesh).normal(hit), (Vec3{0, 0, 1}));
  mesh.normals = {0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  // Barycentric: A by 1 - u, B by u (1 - v), C by u v.
  const Vec3 expected = normalized({0.375, 0.125, 0.5}), found = patches_of(mesh).normal(hit);
  EXPECT_LT(length(found - expected), 1e-15);
}

TEST(MeshPatches, DiagonalsOfQuadsAreNoEdges) {
  Hit hit;
  hit.position = {0.5, 0.45, 0};
  for (const bool quad : {false, true}) {
    const Vec3 nearest = patches_of(square(quad)).nearest_edge(hit);
    const Vec3 expected = quad ? Vec3{0.5, 0, 0} : Vec3{0.475, 0.475, 0};
    EXPECT_LT(length(nearest - expected), 1e-12) << quad;
  }
}

TEST(MeshPatches, EdgesAreDark) {
  const MeshPatches patches = patches_of(square(false));
  const PatchSet set = value_of(patches.pack());
  const RayScene scene = value_of(RayScene::make(set));
  Settings settings;
  settings.width = picture_width, settings.height = picture_width, settings.samples = 2, settings.shade = Shade::clay;
  settings.camera = Camera{{0.5, 0.5, 2}, {0.5, 0.5, 0}, 40, {0, 1, 0}};
  settings.nearest_edge = [&](const Hit& hit, double) { return patches.nearest_edge(hit); };
  const Image image = value_of(render(scene, set.box(), settings));
  const auto red = [&](int x, int y) { return image.rgb[3 * static_cast<std::size_t>(y * picture_width + x)]; };
  EXPECT_LT(red(picture_width / 2, picture_width / 2), 100);       // on the diagonal
  EXPECT_GT(red(picture_width / 2 + 12, picture_width / 2), 140);  // beside it
}

TEST(MeshPatches, TrianglesKnowTheirPatches) {
  Mesh mesh = square(false);
  mesh.indices.insert(mesh.indices.begin(), {0, 1, 1});  // no area, and left out
  mesh.patches = {9, 5, 7};
  Hit hit;
  for (const std::uint32_t k : {0u, 1u}) {
    hit.patch = k;
    EXPECT_EQ(patches_of(mesh).patch(hit), mesh.patches[k + 1]);
  }
}

TEST(MeshPatches, ColoursAreShown) {
  const MeshPatches patches = patches_of(square(false));
  const PatchSet set = value_of(patches.pack());
  const RayScene scene = value_of(RayScene::make(set));
  for (const Shade shade : {Shade::clay, Shade::lambert}) {
    Settings settings;
    settings.width = picture_width, settings.height = picture_width, settings.samples = 2, settings.shade = shade;
    settings.up = Up::y;  // the square stands on the floor
    settings.camera = Camera{{0.5, 0.5, 2}, {0.5, 0.5, 0}, 40, {0, 1, 0}};
    settings.colour = [](const Hit& hit) {
      return hit.patch == 0 ? std::optional(Colour{0.9f, 0.1f, 0.1f}) : std::nullopt;
    };
    const Image image = value_of(render(scene, set.box(), settings));
    const auto at = [&](int x, int y) { return &image.rgb[3 * static_cast<std::size_t>(y * picture_width + x)]; };
    const std::uint8_t *const red = at(picture_width / 2 + 12, picture_width / 2 + 8), *const plain =
                                                                                           at(picture_width / 2 - 12,
                                                                                              picture_width / 2 - 8);
    EXPECT_GT(red[0], red[1] + 60);
    EXPECT_LT(std::abs(plain[0] - plain[1]), 30);
  }
}

TEST(MeshPatches, MeshesThatCannotBeDrawn) {
  Mesh mesh = square(false);
  mesh.indices[4] = 4;
  EXPECT_EQ(MeshPatches().add(mesh).code(), StatusCode::invalid_argument);
  mesh = square(false);
  mesh.positions[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(MeshPatches().add(mesh).code(), StatusCode::non_finite);
  mesh = square(false);
  mesh.indices = {0, 1, 1, 0, 0, 2};  // no area
  EXPECT_EQ(patches_of(mesh).pack().status().code(), StatusCode::invalid_argument);
}

}}  // namespace tessera::render
