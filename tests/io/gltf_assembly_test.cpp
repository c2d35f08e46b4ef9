// Assemblies as glTF: what is stored once, names, places, colours and the unit, read back by another reader and by this
// library's own.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/gltf_file.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/mesh_assembly.h"

namespace tessera { namespace {

using test::random_mesh;
using test::ScratchFolder;
using test::value_of;

constexpr Colour red{1, 0, 0}, glass{0.5f, 0.04f, 0, 0.25f}, green{0, 1, 0};

/// A mesh with unit normals and parts of these colours, of 10 triangles each.
Mesh coloured_mesh(const std::vector<std::optional<Colour>>& colours, const Vec3& origin = {}) {
  Mesh mesh = random_mesh(30, 10 * colours.size(), {true, true, false}, origin);
  for (std::size_t k = 0; k < mesh.normals.size(); k += 3)
    mesh.normals[k] = 0, mesh.normals[k + 1] = 0.6f, mesh.normals[k + 2] = 0.8f;
  for (std::size_t k = 0; k < colours.size(); ++k)
    mesh.parts.push_back({.name = "part", .first_triangle = 10 * k, .triangle_count = 10, .colour = colours[k]});
  return mesh;
}

class GltfAssembly : public testing::TestWithParam<const char*> {
 protected:
  std::string path() const { return folder_ / (std::string("a") + GetParam()); }

  tinygltf::Model written(const MeshAssembly& assembly) const {
    const Status status = write_assembly(assembly, path());
    EXPECT_TRUE(status.ok()) << status.message();
    return test::read_gltf(path());
  }

  ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Forms, GltfAssembly, testing::Values(".glb", ".gltf"),
                         [](const auto& form) { return std::string(form.param).substr(1); });

const tinygltf::Mesh& mesh_of(const tinygltf::Model& model, std::size_t node) {
  return model.meshes.at(static_cast<std::size_t>(model.nodes.at(node).mesh));
}
const tinygltf::Material& material_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  return model.materials.at(static_cast<std::size_t>(primitive.material));
}
/// The indices of a primitive, which must be 32-bit and packed.
std::vector<std::uint32_t> indices_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(primitive.indices));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  EXPECT_LE(accessor.byteOffset + 4 * accessor.count, view.byteLength);
  std::vector<std::uint32_t> indices(accessor.count);
  std::memcpy(indices.data(), &model.buffers.at(0).data.at(view.byteOffset + accessor.byteOffset), 4 * accessor.count);
  return indices;
}
std::vector<std::uint32_t> part_indices(const Mesh& mesh, std::initializer_list<std::size_t> parts) {
  std::vector<std::uint32_t> indices;
  for (const std::size_t part : parts)
    indices.insert(indices.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(30 * part),
                   mesh.indices.begin() + static_cast<std::ptrdiff_t>(30 * part + 30));
  return indices;
}

TEST_P(GltfAssembly, AShapeIsStoredOnceForAllItsInstances) {
  MeshAssembly assembly{.name = "thousand", .shapes = {{.name = "bolt", .mesh = coloured_mesh({{}})}}};
  const auto bytes = [&] { return written(assembly).buffers.at(0).data.size(); };
  assembly.instances.resize(1);
  const std::size_t one = bytes();
  EXPECT_EQ(one, 4 * (30 * 8 + 30));
  assembly.instances.resize(1000);
  for (std::size_t k = 0; k < 1000; ++k) assembly.instances[k].name = "bolt_" + std::to_string(k);
  EXPECT_EQ(bytes(), one);
  const tinygltf::Model model = written(assembly);
  EXPECT_EQ(model.meshes.size(), 1u);
  EXPECT_EQ(model.meshes[0].name, "bolt");
  EXPECT_EQ(model.accessors.size(), 4u);
  ASSERT_EQ(model.nodes.size(), 1001u);
  EXPECT_EQ(model.scenes.at(0).nodes, std::vector<int>{0});
  EXPECT_EQ(model.nodes[0].name, "thousand");
  EXPECT_EQ(model.nodes[0].children.size(), 1000u);
  EXPECT_EQ(model.nodes[1000].name, "bolt_999");
  EXPECT_EQ(model.nodes[1000].mesh, 0);
}

TEST_P(GltfAssembly, NamesAreUtf8WithQuotesAndControlCharacters) {
  MeshAssembly assembly{.shapes = {{.name = "shape", .mesh = coloured_mesh({{}})}},
                        .instances = {{.name = "3/8\" \\ \xc3\xa4\n\x01"}, {.name = "bad \xff"}, {}}};
  const tinygltf::Model model = written(assembly);
  EXPECT_EQ(model.nodes.at(1).name, "3/8\" \\ \xc3\xa4\n\x01");
  EXPECT_EQ(model.nodes.at(2).name, "bad \xef\xbf\xbd");
  EXPECT_EQ(model.nodes.at(3).name, "shape");  // an instance without a name has that of its shape
}

TEST_P(GltfAssembly, ColoursAreMaterialsInLinearLight) {
  const Mesh mesh = coloured_mesh({red, {}, glass, red});
  const tinygltf::Model model = written({.shapes = {{.mesh = mesh}}, .instances = {{}}});
  const std::vector<tinygltf::Primitive>& primitives = mesh_of(model, 1).primitives;
  ASSERT_EQ(primitives.size(), 3u);  // in the order of the first parts
  EXPECT_EQ(indices_of(model, primitives[0]), part_indices(mesh, {0, 3}));
  EXPECT_EQ(indices_of(model, primitives[1]), part_indices(mesh, {1}));
  EXPECT_EQ(indices_of(model, primitives[2]), part_indices(mesh, {2}));
  EXPECT_EQ(primitives[0].attributes, primitives[2].attributes);  // the vertices are shared
  EXPECT_EQ(material_of(model, primitives[0]).pbrMetallicRoughness.baseColorFactor, (std::vector<double>{1, 0, 0, 1}));
  EXPECT_EQ(material_of(model, primitives[0]).alphaMode, "OPAQUE");
  EXPECT_EQ(material_of(model, primitives[1]).pbrMetallicRoughness.baseColorFactor,
            (std::vector<double>{0.8, 0.8, 0.8, 1}));
  // Mid grey of sRGB is 21.4% of the light; below 0.04045 the curve is a line.
  const std::vector<double> seen = material_of(model, primitives[2]).pbrMetallicRoughness.baseColorFactor;
  EXPECT_NEAR(seen.at(0), 0.21404114048, 1e-9);
  EXPECT_NEAR(seen.at(1), 0.04 / 12.92, 1e-9);
  EXPECT_EQ(seen.at(3), 0.25);
  EXPECT_EQ(material_of(model, primitives[2]).alphaMode, "BLEND");
  EXPECT_EQ(model.materials.size(), 3u);
}

TEST_P(GltfAssembly, ColoursOfInstancesAreForFacesWithoutOne) {
  MeshAssembly assembly{.shapes = {{.mesh = coloured_mesh({red, {}})}, {.mesh = coloured_mesh({red})}},
                        .instances = {{.colour = green}, {}, {.colour = green}, {.shape = 1}, {.shape = 1}}};
  assembly.instances[4].colour = green;
  const tinygltf::Model model = written(assembly);
  EXPECT_EQ(model.meshes.size(), 3u);  // the first shape in green and in grey, the second one
  EXPECT_EQ(model.nodes.at(1).mesh, model.nodes.at(3).mesh);
  EXPECT_NE(model.nodes.at(1).mesh, model.nodes.at(2).mesh);
  EXPECT_EQ(model.nodes.at(4).mesh, model.nodes.at(5).mesh);
  const auto colour = [&](std::size_t node, std::size_t primitive) {
    return material_of(model, mesh_of(model, node).primitives.at(primitive)).pbrMetallicRoughness.baseColorFactor;
  };
  EXPECT_EQ(colour(1, 0), (std::vector<double>{1, 0, 0, 1}));
  EXPECT_EQ(colour(1, 1), (std::vector<double>{0, 1, 0, 1}));
  EXPECT_EQ(colour(2, 1), (std::vector<double>{0.8, 0.8, 0.8, 1}));
  // Both meshes of the first shape use the same numbers.
  EXPECT_EQ(mesh_of(model, 1).primitives[1].attributes, mesh_of(model, 2).primitives[1].attributes);
  EXPECT_EQ(mesh_of(model, 1).primitives[1].indices, mesh_of(model, 2).primitives[1].indices);
  EXPECT_EQ(model.buffers[0].data.size(), 4 * (2 * 30 * 8 + 90u));
}

TEST_P(GltfAssembly, PartsOfAMeshHaveColoursToo) {
  const Mesh mesh = coloured_mesh({glass, {}});
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  tinygltf::Model model;
  std::string error, warning;
  tinygltf::TinyGLTF reader;
  ASSERT_TRUE(path().ends_with(".glb") ? reader.LoadBinaryFromFile(&model, &error, &warning, path())
                                       : reader.LoadASCIIFromFile(&model, &error, &warning, path()));
  EXPECT_EQ(material_of(model, mesh_of(model, 1).primitives.at(0)).alphaMode, "BLEND");
  EXPECT_EQ(mesh_of(model, 2).primitives.at(0).material, 0);
}

/// The places of all corners, in the order of the triangles.
std::vector<Vec3> corners_of(const Mesh& mesh) {
  std::vector<Vec3> places;
  for (const std::uint32_t index : mesh.indices)
    places.push_back(mesh.origin +
                     Vec3{mesh.positions[3 * index], mesh.positions[3 * index + 1], mesh.positions[3 * index + 2]});
  return places;
}

TEST_P(GltfAssembly, EveryCornerIsReadBackWhereItStands) {
  // The third placement mirrors, and the fourth shears, which no node can.
  const Affine turned = Affine::translated({400, -50, 7}) * Affine::rotated({1, 2, 3}, 1.1);
  const Affine sheared{.columns = {Vec3{1, 0, 0}, Vec3{0.5, 1, 0}, Vec3{0, 0, 1}}, .translation = {0, 0, 900}};
  MeshAssembly assembly{.shapes = {{.name = "a", .mesh = coloured_mesh({{}}, {10, 20, 30})},
                                   {.name = "b", .mesh = coloured_mesh({red, green})},
                                   {.name = "nothing"}},
                        .instances = {{.name = "first"},
                                      {.name = "turned", .shape = 1, .placement = turned},
                                      {.name = "mirrored", .placement = turned * Affine::scaled({1, -3, 1})},
                                      {.name = "sheared", .shape = 1, .placement = sheared},
                                      {.name = "point", .shape = 2, .placement = turned}}};
  for (const auto& [unit, metre] :
       {std::pair{"", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"inch", 0.0254}, {"in", 0.0254}}) {
    assembly.unit = unit;
    const tinygltf::Model model = written(assembly);
    EXPECT_EQ(model.nodes.at(0).matrix,
              (std::vector<double>{metre, 0, 0, 0, 0, 0, -metre, 0, 0, metre, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(model.nodes.at(1).translation, (std::vector<double>{10, 20, 30}));
    EXPECT_EQ(model.nodes.at(2).matrix.size(), 16u);
    EXPECT_TRUE(model.nodes.at(4).matrix.empty());  // its mesh is sheared instead
    EXPECT_EQ(mesh_of(model, 4).name, "b");
    EXPECT_EQ(model.nodes.at(5).name, "point");
    EXPECT_EQ(model.nodes.at(5).mesh, -1);
    const Mesh back = value_of(read_mesh(path()));
    const std::vector<Vec3> found = corners_of(back), expected = corners_of(value_of(flatten(assembly)));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_LE(length(found[k] - metre * expected[k]), 2e-4 * metre) << unit << ", corner " << k;
    ASSERT_EQ(back.parts.size(), 4u);
    EXPECT_EQ(back.parts[2].name, "mirrored");
    EXPECT_EQ(back.parts[3].triangle_count, 20u);  // two primitives
  }
  assembly.unit = "cubit";
  const Status status = write_assembly(assembly, path());
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_NE(status.message().find("unit \"cubit\" is not known"), std::string::npos) << status.message();
}

TEST_P(GltfAssembly, FarPartsKeepTheirPrecision) {
  const Mesh mesh = coloured_mesh({{}}, {1e8 + 1.0 / 3, 0, 0});
  const Affine placement = Affine::translated({-2e9, 1.0 / 7, 5}) * Affine::rotated({0, 0, 1}, 0.3);
  const tinygltf::Model model = written({.shapes = {{.mesh = mesh}}, .instances = {{.placement = placement}}});
  const std::vector<double>& matrix = model.nodes.at(1).matrix;
  const Vec3 origin = placement.point(mesh.origin);
  EXPECT_EQ((std::vector<double>(matrix.begin() + 12, matrix.end())),
            (std::vector<double>{origin.x, origin.y, origin.z, 1}));
  const Mesh back = value_of(read_mesh(path()));
  EXPECT_EQ(back.origin, origin);
  EXPECT_NEAR(back.positions[0], placement.vector({mesh.positions[0], mesh.positions[1], mesh.positions[2]}).x, 1e-5);
}

TEST_P(GltfAssembly, QuadsAreSplit) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.quads = {0, 1, 2, 3};
  mesh.parts = {{.name = "q", .quad_count = 1, .colour = red}};
  const tinygltf::Model model = written({.shapes = {{.mesh = mesh}}, .instances = {{}}});
  const tinygltf::Primitive& primitive = mesh_of(model, 1).primitives.at(0);
  EXPECT_EQ(indices_of(model, primitive), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(material_of(model, primitive).pbrMetallicRoughness.baseColorFactor, (std::vector<double>{1, 0, 0, 1}));
}

TEST_P(GltfAssembly, WrongOnesAreRefused) {
  const MeshAssembly right{.shapes = {{.name = "a", .mesh = coloured_mesh({red})}}, .instances = {{.name = "one"}}};
  const auto refused = [&](const MeshAssembly& assembly, StatusCode code, const std::string& words) {
    const Status status = write_assembly(assembly, path());
    EXPECT_EQ(status.code(), code);
    EXPECT_EQ(status.message(), path() + ": " + words);
    EXPECT_TRUE(folder_.names().empty());
  };
  MeshAssembly wrong = right;
  wrong.instances[0].shape = 1;
  refused(wrong, StatusCode::invalid_argument, "instance 0 (one): it is of shape 1, there are 1");
  wrong = right;
  wrong.instances[0].placement.columns[1].y = std::numeric_limits<double>::quiet_NaN();
  refused(wrong, StatusCode::non_finite, "instance 0 (one): its placement is not finite");
  wrong = right;
  wrong.instances[0].colour = Colour{0, 0, 1.5f};
  refused(wrong, StatusCode::invalid_argument, "instance 0 (one): its colour is not within 0 to 1");
  wrong = right;
  wrong.shapes[0].mesh.parts[0].colour = Colour{0, std::numeric_limits<float>::quiet_NaN(), 0};
  refused(wrong, StatusCode::invalid_argument, "shape 0 (a): the colour of a part of the mesh is not within 0 to 1");
  wrong = right;
  wrong.shapes[0].mesh.indices[4] = 30;
  refused(wrong, StatusCode::invalid_argument, "shape 0 (a): an index of the mesh is beyond its vertices");
  wrong = right;
  wrong.instances.clear();
  refused(wrong, StatusCode::invalid_argument, "the mesh has no triangles, glTF needs at least one");
}

TEST(AssemblyFiles, OtherFormatsHoldOneMesh) {
  const ScratchFolder folder;
  const MeshAssembly assembly{.shapes = {{.mesh = coloured_mesh({{}, {}})}},
                              .instances = {{.name = "a"}, {.name = "b", .placement = Affine::translated({500, 0, 0})}},
                              .unit = "mm"};
  const Mesh flat = value_of(flatten(assembly));
  for (const char* const name : {"m.ply", "m.obj", "m.stl"}) {
    ASSERT_TRUE(write_assembly(assembly, folder / name).ok());
    const std::string whole = folder / ("flat" + std::string(name).substr(1));
    ASSERT_TRUE(write_mesh(flat, whole).ok());
    EXPECT_EQ(test::content_of(folder / name), test::content_of(whole));
  }
  EXPECT_EQ(write_assembly(assembly, folder / "m.step").code(), StatusCode::unsupported);
  EXPECT_EQ(write_assembly({}, folder / "m.ply").message(), (folder / "m.ply") + ": the mesh has no vertices");
}

}}  // namespace tessera
