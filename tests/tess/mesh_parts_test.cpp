// The parts of a mesh are its surfaces.

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/mesh_assembly.h"
#include "tessera/model.h"
#include "tessera/tessellate.h"
#include "tessera/topology.h"

namespace tessera { namespace {

using test::value_of;

/// Four surfaces of one patch each; the third is a segment, which has no triangles.
Model model() {
  Model model;
  for (const char* name : {"front", "", "edge", "back"}) {
    std::vector<Vec3> points{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}};
    if (model.surfaces.size() == 2) points = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    model.surfaces.push_back({name, value_of(BezierPatch::polynomial(1, 1, points))});
  }
  return model;
}

Mesh mesh_of(const PatchSet& set) {
  const Tessellation plan = value_of(Tessellation::make(set, {.rates = UniformRates{3, 2}}));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  return mesh;
}

TEST(MeshParts, EachSurfaceThatHasTrianglesIsOne) {
  const Model surfaces = model();
  const PatchSet set = value_of(make_patch_set(surfaces));
  const Mesh mesh = mesh_of(set);
  const std::vector<MeshPart> parts = value_of(parts_by_surface(mesh, set, surfaces));
  ASSERT_EQ(parts.size(), 3u);
  const std::vector<const char*> names{"front", "surface 1", "back"};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(parts[k].name, names[k]);
    EXPECT_EQ(parts[k].first_triangle, 12 * k);
    EXPECT_EQ(parts[k].triangle_count, 12u);
  }
}

TEST(Tessellate, OfAModelIsThePlansMeshWithItsParts) {
  const Model surfaces = model();
  const PatchSet set = value_of(make_patch_set(surfaces));
  const TessellationOptions options{.tolerance = 1e-3};
  const Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh wanted = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, wanted.views()).ok());
  for (const Mesh& mesh :
       {value_of(tessera::tessellate(set, options)), value_of(tessera::tessellate(surfaces, options))}) {
    EXPECT_EQ(mesh.positions, wanted.positions);
    EXPECT_EQ(mesh.normals, wanted.normals);
    EXPECT_EQ(mesh.indices, wanted.indices);
  }
  EXPECT_TRUE(value_of(tessera::tessellate(set, options)).parts.empty());
  const std::vector<MeshPart> parts = value_of(tessera::tessellate(surfaces, options)).parts;
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[2].name, "back");
}

TEST(Tessellate, OfASurfaceIsThatOfItsPatches) {
  const Surface surface = model().surfaces[0].surface;
  const PatchSet set = value_of(make_patch_set(value_of(to_bezier(ModelSurface{{}, surface}, {}))));
  const TessellationOptions options{.tolerance = 1e-3};
  EXPECT_EQ(value_of(tessera::tessellate(surface, options)).positions,
            value_of(tessera::tessellate(set, options)).positions);
  EXPECT_EQ(tessera::tessellate(surface, {}).status().code(), StatusCode::invalid_argument);
}

TEST(Tessellate, PassesErrorsOn) {
  EXPECT_EQ(tessera::tessellate(model(), {}).status().code(), StatusCode::invalid_argument);
  EXPECT_FALSE(tessera::tessellate(Model{}, {.tolerance = 1e-3}).ok());
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_EQ(tessera::tessellate(model(), {.tolerance = 1e-3}, execution).status().code(), StatusCode::cancelled);
}

TEST(MeshParts, PatchesOfOneSurfaceAreOnePart) {
  const Model surfaces = model();
  const std::vector<BezierPatch> patches = test::wavy_field(2, 3);
  std::vector<PatchSource> sources(6);
  for (std::size_t k : {2, 3, 4}) sources[k].surface = 3;
  const PatchSet set = value_of(PatchSet::make(patches, {.sources = sources}));
  const std::vector<MeshPart> parts = value_of(parts_by_surface(mesh_of(set), set, surfaces));
  ASSERT_EQ(parts.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(parts[k].name, k == 1 ? "back" : "front");
  EXPECT_EQ(parts[1].first_triangle, 2 * 12u);
  EXPECT_EQ(parts[1].triangle_count, 3 * 12u);
}

TEST(MeshParts, QuadsGoWithTheTrianglesOfTheirPatch) {
  const Model surfaces = model();
  // Patches 0 to 3 belong to surface 0, 4 to 7 to surface 3.
  std::vector<PatchSource> sources(8);
  for (std::size_t k = 4; k < 8; ++k) sources[k].surface = 3;
  const PatchSet two = value_of(PatchSet::make(test::sphere(), {.sources = sources}));
  const Tessellation plan = value_of(Tessellation::make(two, {.rates = UniformRates{3, 2}, .quads = true}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(two, mesh.views()).ok());
  ASSERT_GT(mesh.triangle_count(), 0u);  // at the poles
  const std::vector<MeshPart> parts = value_of(parts_by_surface(mesh, two, surfaces));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[1].name, "back");
  EXPECT_EQ(parts[0].triangle_count, mesh.triangle_count() / 2);
  EXPECT_EQ(parts[1].first_triangle, mesh.triangle_count() / 2);
  EXPECT_EQ(parts[0].quad_count, mesh.quad_count() / 2);
  EXPECT_EQ(parts[1].first_quad, mesh.quad_count() / 2);
  EXPECT_EQ(parts[1].quad_count, mesh.quad_count() / 2);
  mesh.quad_patches[2] = 9;
  EXPECT_EQ(parts_by_surface(mesh, two, surfaces).status().message(), "quad 2 is of patch 9, there are 8");
  mesh.quad_patches.pop_back();
  EXPECT_EQ(parts_by_surface(mesh, two, surfaces).status().code(), StatusCode::count_mismatch);
}

TEST(MeshParts, WhatDoesNotBelongTogetherIsRefused) {
  Model surfaces = model();
  const PatchSet set = value_of(make_patch_set(surfaces));
  Mesh mesh = mesh_of(set);
  mesh.patches[17] = 4;
  const Status no_patch = parts_by_surface(mesh, set, surfaces).status();
  EXPECT_EQ(no_patch.code(), StatusCode::invalid_argument);
  EXPECT_EQ(no_patch.message(), "triangle 17 is of patch 4, there are 4");
  EXPECT_EQ(no_patch.index(), 17);
  mesh.patches.pop_back();
  EXPECT_EQ(parts_by_surface(mesh, set, surfaces).status().message(), "35 patches for 36 triangles");
  mesh = mesh_of(set);
  surfaces.surfaces.pop_back();
  EXPECT_EQ(parts_by_surface(mesh, set, surfaces).status().message(), "triangle 24 is of surface 3, there are 3");
  EXPECT_TRUE(value_of(parts_by_surface(Mesh{}, set, surfaces)).empty());
}

TEST(MeshParts, FacesOfAShapeHaveTheirNamesAndColours) {
  const Colour red{1, 0, 0}, blue{0, 0, 1};
  const Model surfaces = model();
  Model part;
  Shape& shape = part.shapes.emplace_back();
  for (const ModelSurface& surface : surfaces.surfaces) shape.faces.push_back({surface});
  shape.faces[3].colour = red;
  const PatchSet set = value_of(make_patch_set(shape));
  Mesh mesh = mesh_of(set);
  const std::vector<MeshPart> faces = value_of(parts_by_face(mesh, set, shape));
  ASSERT_EQ(faces.size(), 3u);
  EXPECT_EQ(faces[0].name, "front");
  EXPECT_EQ(faces[1].name, "face 1");
  EXPECT_EQ(faces[1].colour, std::nullopt);
  EXPECT_EQ(faces[2].colour, red);
  EXPECT_EQ(faces[2].first_triangle, 24u);
  // In a model, the colour of an instance is for faces without one.
  part.instances = {{}, {.first_surface = 4, .colour = blue}};
  part.surfaces = value_of(placed_faces(part.shapes, part.instances));
  const PatchSet both = value_of(make_patch_set(part));
  const std::vector<MeshPart> parts = value_of(parts_by_surface(mesh_of(both), both, part));
  ASSERT_EQ(parts.size(), 6u);
  const std::optional<Colour> colours[] = {{}, {}, red, blue, blue, red};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(parts[k].colour, colours[k]) << k;
  mesh.patches[17] = 4;
  EXPECT_EQ(parts_by_face(mesh, set, shape).status().message(), "triangle 17 is of patch 4, there are 4");
  shape.faces.pop_back();
  EXPECT_EQ(parts_by_face(mesh_of(set), set, shape).status().message(), "triangle 24 is of face 3, there are 3");
}

}}  // namespace tessera
