// glTF files of parts, opened by an independent reader: names, places, colours and nodes.

#ifdef TESSERA_HAS_ASSIMP
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/mesh_assembly.h"
#include "tessera/tessellation.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

class Assimp : public ToolTest {};

#ifdef TESSERA_HAS_ASSIMP

/// A mesh of the scene where it stands.
struct Found {
  std::string node;
  std::array<float, 4> colour;  ///< in linear light
  std::vector<Vec3> corners;
};

void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, std::vector<Found>& found) {
  const aiMatrix4x4 place = above * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[k]];
    aiColor4D colour;
    EXPECT_EQ(scene.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour), aiReturn_SUCCESS);
    Found& one = found.emplace_back(Found{node.mName.C_Str(), {colour.r, colour.g, colour.b, colour.a}, {}});
    for (unsigned face = 0; face < mesh.mNumFaces; ++face)
      for (unsigned corner = 0; corner < 3; ++corner) {
        const aiVector3D p = place * mesh.mVertices[mesh.mFaces[face].mIndices[corner]];
        one.corners.push_back({p.x, p.y, p.z});
      }
  }
  for (unsigned k = 0; k < node.mNumChildren; ++k) collect(scene, *node.mChildren[k], place, found);
}

TEST_F(Assimp, ReadsNamesPlacesAndColoursOfAnAssembly) {
  const PatchSet set = value_of(PatchSet::make(sphere()));
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.05}));
  Mesh ball = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, ball.views()).ok());
  ball.parts = {{.name = "cap", .triangle_count = 5, .colour = Colour{1, 0.5f, 0, 0.25f}},
                {.name = "rest", .first_triangle = 5, .triangle_count = ball.triangle_count() - 5}};
  const Affine sheared{.columns = {Vec3{1, 0, 0}, Vec3{0.5, 1, 0}, Vec3{0, 0, 1}}, .translation = {0, 9, 0}};
  const MeshAssembly assembly{
      .name = "assembly",
      .shapes = {{.name = "ball", .mesh = ball}},
      .instances = {{.name = "plain \"1\" \xc3\xa4"},
                    {.name = "turned", .placement = Affine::translated({3, 0, 0}) * Affine::rotated({1, 2, 3}, 1)},
                    {.name = "mirrored", .placement = Affine::scaled({1, -2, 1}), .colour = Colour{0, 0, 1}},
                    {.name = "sheared", .placement = sheared}},
      .unit = "cm"};
  const Mesh flat = value_of(flatten(assembly));
  for (const char* const name : {"a.glb", "a.gltf"}) {
    ASSERT_TRUE(write_assembly(assembly, folder_ / name).ok());
    ::Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder_ / name, aiProcess_ValidateDataStructure);
    ASSERT_TRUE(scene) << importer.GetErrorString();
    EXPECT_STREQ(scene->mRootNode->mName.C_Str(), "assembly");
    ASSERT_EQ(scene->mRootNode->mNumChildren, 4u);
    std::vector<Found> found;
    collect(*scene, *scene->mRootNode, {}, found);
    ASSERT_EQ(found.size(), 8u);  // two primitives each
    std::size_t corner = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_EQ(found[k].node, assembly.instances[k / 2].name);
      const std::array<float, 4> orange{1, 0.21404114f, 0, 0.25f}, grey{0.8f, 0.8f, 0.8f, 1}, blue{0, 0, 1, 1};
      EXPECT_EQ(found[k].colour, k % 2 == 0 ? orange : k / 2 == 2 ? blue : grey) << k;
      for (const Vec3& place : found[k].corners) {
        const std::size_t v = 3 * flat.indices.at(corner++);
        const Vec3 p = 0.01 * (flat.origin + Vec3{flat.positions[v], flat.positions[v + 1], flat.positions[v + 2]});
        const Vec3 expected{p.x, p.z, -p.y};  // +Y is up
        // The flat mesh turns mirrored faces around by their last two corners; all else is in the same order.
        if (k / 2 != 2 || (corner - 1) % 3 == 0) {
          EXPECT_LE(length(place - expected), 1e-6) << k;
        }
      }
    }
    EXPECT_EQ(corner, flat.indices.size());
  }
}

#ifdef TESSERA_HAS_CAD_READER

TEST_F(Assimp, ReadsTheColouredPartsOfARealAssembly) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::string path = (std::filesystem::path(data) / "step_cad/as1-oc-214.stp").string();
  output_of({"tessellate", path, "-o", "as1.glb"});
  ::Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(folder_ / "as1.glb", aiProcess_ValidateDataStructure);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  EXPECT_EQ(scene->mNumMeshes, 5u);
  EXPECT_EQ(scene->mRootNode->mNumChildren, 18u);
  std::vector<Found> found;
  collect(*scene, *scene->mRootNode, {}, found);
  ASSERT_EQ(found.size(), 18u);
  // The styled items of the file; 0.8 and 0.5 in linear light.
  const std::map<std::string, std::array<float, 4>> colours{{"nut", {1, 0, 0, 1}},
                                                            {"rod", {1, 0.21404114f, 0, 1}},
                                                            {"bolt", {0, 0, 1, 1}},
                                                            {"l-bracket", {0, 1, 0, 1}},
                                                            {"plate", {0.6038274f, 1, 0, 1}}};
  std::map<std::string, std::size_t> counts;
  Box3 box;
  for (const Found& one : found) {
    const std::string shape = one.node.substr(0, one.node.find('_'));
    ++counts[shape];
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(one.colour[c], colours.at(shape)[c], 1e-5) << one.node;
    for (const Vec3& corner : one.corners) box.extend(corner);
  }
  EXPECT_EQ(counts,
            (std::map<std::string, std::size_t>{{"nut", 8}, {"rod", 1}, {"bolt", 6}, {"l-bracket", 2}, {"plate", 1}}));
  // In metres, the box that info tells of the model in mm, turned up.
  EXPECT_LE(length(box.lower - Vec3{-0.01, -0.004, -0.15}), 1e-6);
  EXPECT_LE(length(box.upper - Vec3{0.19, 0.08, 0}), 1e-6);
}

#endif
#else

TEST_F(Assimp, IsNotHere) { GTEST_SKIP() << "assimp is not found: libassimp-dev (tools/setup.sh --for test)"; }

#endif

}}  // namespace tessera::test
