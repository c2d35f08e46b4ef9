// glTF meshes, read back by another reader: the result equals the mesh, and keeps the rules of the specification
// (sections 3.6 and 3.7: alignment, ranges, boxes of positions, unit normals).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/gltf_file.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace tessera { namespace {

using test::random_mesh;
using test::ScratchFolder;
using Floats = std::vector<float>;

class Gltf : public testing::TestWithParam<const char*> {
 protected:
  std::string path() const { return folder_ / (std::string("mesh") + GetParam()); }

  tinygltf::Model written(const Mesh& mesh) const {
    const Status status = write_mesh(mesh, path());
    EXPECT_TRUE(status.ok()) << status.message();
    return test::read_gltf(path());
  }

  ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Forms, Gltf, testing::Values(".glb", ".gltf"),
                         [](const auto& form) { return std::string(form.param).substr(1); });

std::size_t component_count(int type) {
  EXPECT_TRUE(type == TINYGLTF_TYPE_SCALAR || type == TINYGLTF_TYPE_VEC2 || type == TINYGLTF_TYPE_VEC3);
  return type == TINYGLTF_TYPE_SCALAR ? 1 : static_cast<std::size_t>(type);
}

/// The numbers that an accessor sees, which must lie within its view, and that within the buffer, aligned.
template <class T>
std::vector<T> values_of(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& a = model.accessors.at(static_cast<std::size_t>(accessor));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
  const auto& bytes = model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
  const std::size_t size = component_count(a.type), stride = view.byteStride == 0 ? size * sizeof(T) : view.byteStride;
  EXPECT_EQ(a.componentType,
            (std::is_same_v<T, float> ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT));
  EXPECT_EQ((view.byteOffset + a.byteOffset) % sizeof(T), 0u);
  EXPECT_GE(a.count, 1u);
  EXPECT_LE(a.byteOffset + (a.count - 1) * stride + size * sizeof(T), view.byteLength);
  EXPECT_LE(view.byteOffset + view.byteLength, bytes.size());
  std::vector<T> values(a.count * size);
  for (std::size_t k = 0; k < a.count; ++k)
    std::memcpy(&values[k * size], &bytes[view.byteOffset + a.byteOffset + k * stride], size * sizeof(T));
  return values;
}

/// One mesh of the file, and its name.
struct Part {
  std::string name;
  Floats positions, normals, parameters;
  std::vector<std::uint32_t> indices;
};

Part part_of(const tinygltf::Model& model, int node) {
  const tinygltf::Node& at = model.nodes.at(static_cast<std::size_t>(node));
  const tinygltf::Mesh& mesh = model.meshes.at(static_cast<std::size_t>(at.mesh));
  EXPECT_EQ(mesh.primitives.size(), 1u);
  EXPECT_EQ(at.name, mesh.name);
  const tinygltf::Primitive& primitive = mesh.primitives.at(0);
  EXPECT_EQ(primitive.mode, TINYGLTF_MODE_TRIANGLES);
  Part part{mesh.name,
            values_of<float>(model, primitive.attributes.at("POSITION")),
            {},
            {},
            values_of<std::uint32_t>(model, primitive.indices)};
  for (const auto& [name, values] : {std::pair{"NORMAL", &part.normals}, std::pair{"TEXCOORD_0", &part.parameters}})
    if (primitive.attributes.count(name) > 0) *values = values_of<float>(model, primitive.attributes.at(name));
  const auto& accessor = model.accessors.at(static_cast<std::size_t>(primitive.attributes.at("POSITION")));
  for (std::size_t c = 0; c < 3; ++c) {
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (std::size_t k = c; k < part.positions.size(); k += 3) {
      least = std::min(least, part.positions[k]);
      most = std::max(most, part.positions[k]);
    }
    EXPECT_EQ(accessor.minValues.at(c), double{least});
    EXPECT_EQ(accessor.maxValues.at(c), double{most});
  }
  for (const std::uint32_t index : part.indices) EXPECT_LT(index, part.positions.size() / 3);
  for (std::size_t k = 0; k < part.normals.size(); k += 3)
    EXPECT_NEAR(std::hypot(part.normals[k], part.normals[k + 1], part.normals[k + 2]), 1, 1e-3);
  return part;
}

/// The children of the one node of the scene.
std::vector<Part> parts_of(const tinygltf::Model& model) {
  EXPECT_EQ(model.asset.version, "2.0");
  EXPECT_EQ(model.scenes.at(0).nodes, std::vector<int>{0});
  std::vector<Part> parts;
  for (const int child : model.nodes.at(0).children) parts.push_back(part_of(model, child));
  return parts;
}

/// The values of `size` components at each corner.
Floats at_corners(const Floats& values, std::span<const std::uint32_t> indices, std::size_t size) {
  Floats corners;
  for (const std::uint32_t index : indices)
    corners.insert(corners.end(), &values[size * index], &values[size * index] + size);
  return corners;
}

void make_unit(Floats& normals) {
  for (std::size_t k = 0; k < normals.size(); k += 3) {
    const double size = std::hypot(normals[k], normals[k + 1], normals[k + 2]);
    for (std::size_t c = 0; c < 3; ++c) normals[k + c] = static_cast<float>(normals[k + c] / size);
  }
}

TEST_P(Gltf, EveryBitComesBack) {
  for (const bool attributes : {false, true}) {
    Mesh mesh = random_mesh(500, 800, {attributes, attributes, attributes});
    make_unit(mesh.normals);
    const std::vector<Part> parts = parts_of(written(mesh));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(at_corners(parts[0].positions, parts[0].indices, 3), at_corners(mesh.positions, mesh.indices, 3));
    EXPECT_EQ(parts[0].normals.empty(), !attributes);
    if (!attributes) continue;
    EXPECT_EQ(at_corners(parts[0].normals, parts[0].indices, 3), at_corners(mesh.normals, mesh.indices, 3));
    EXPECT_EQ(at_corners(parts[0].parameters, parts[0].indices, 2), at_corners(mesh.parameters, mesh.indices, 2));
  }
  EXPECT_EQ(folder_.names().size(), 1u);
}

TEST_P(Gltf, TheNodeTurnsTheModelUpAndAddsTheOriginInDouble) {
  const Vec3 origin{1000.1, -2e6 - 1.0 / 3, 1e-3};
  const Mesh mesh = random_mesh(20, 10, {}, origin);
  const tinygltf::Model model = written(mesh);
  EXPECT_EQ(model.nodes.at(0).matrix,
            (std::vector<double>{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, origin.x, origin.z, -origin.y, 1}));
  EXPECT_EQ(at_corners(parts_of(model).at(0).positions, parts_of(model).at(0).indices, 3),
            at_corners(mesh.positions, mesh.indices, 3));
  EXPECT_EQ(test::value_of(read_mesh(path())).origin, origin);
  ASSERT_TRUE(write_mesh(mesh, path(), {.up = UpAxis::y}).ok());
  const tinygltf::Model kept = test::read_gltf(path());
  EXPECT_EQ(kept.nodes.at(0).translation, (std::vector<double>{origin.x, origin.y, origin.z}));
  EXPECT_TRUE(kept.nodes.at(0).matrix.empty());
  EXPECT_EQ(test::value_of(read_mesh(path(), {.up = UpAxis::y})).origin, origin);
}

TEST_P(Gltf, PartsMayShareVerticesAndBeEmpty) {
  Mesh mesh = random_mesh(30, 20, {false, true, false});
  mesh.parts = {{"first", 0, 7}, {"none", 7, 0}, {"\"quoted\" and \xc3\xa4\nsecond \xff", 7, 1}, {"", 8, 12}};
  const std::vector<Part> parts = parts_of(written(mesh));
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "first");
  EXPECT_EQ(parts[1].name, "\"quoted\" and \xc3\xa4\nsecond \xef\xbf\xbd");  // U+FFFD for invalid UTF-8
  EXPECT_EQ(parts[2].name, "");
  std::size_t triangle = 0;
  for (const Part& part : parts) {
    const auto indices = std::span(mesh.indices).subspan(3 * triangle, part.indices.size());
    EXPECT_EQ(at_corners(part.positions, part.indices, 3), at_corners(mesh.positions, indices, 3));
    EXPECT_EQ(at_corners(part.parameters, part.indices, 2), at_corners(mesh.parameters, indices, 2));
    triangle += part.indices.size() / 3;
  }
  EXPECT_EQ(triangle, 20u);
}

TEST_P(Gltf, EachSurfaceOfAModelIsAMeshWithItsOwnVertices) {
  const Result<Model> model = read_model(TESSERA_SOURCE_DIR "/tools/models/sphere_of_octants.json");
  ASSERT_TRUE(model.ok());
  const PatchSet set = test::value_of(make_patch_set(*model));
  const Tessellation plan = test::value_of(Tessellation::make(set, {.rates = UniformRates{5, 4}}));
  Mesh mesh = test::value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  mesh.parts = test::value_of(parts_by_surface(mesh, set, *model));
  const std::vector<Part> parts = parts_of(written(mesh));
  ASSERT_EQ(parts.size(), model->surfaces.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    EXPECT_EQ(parts[k].name, model->surfaces[k].name);
    EXPECT_LE(parts[k].positions.size() / 3, 6u * 5u);
    EXPECT_FALSE(parts[k].normals.empty());
  }
}

TEST_P(Gltf, NormalsThatAreNotUnitAreMadeSo) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5};
  mesh.normals = {0, 0, 0, 0, 3, 4, 0, 0, -1, 0, 0, 0};
  mesh.indices = {0, 2, 1, 3, 3, 3};
  const std::vector<Part> parts = parts_of(written(mesh));
  EXPECT_EQ(parts.at(0).normals, (Floats{0, 0, -1, 0, 0.6f, 0.8f, 0, 0, -1, 0, 0, 1}));
}

TEST(GltfFiles, TheContainerIsWhatTheSpecificationSays) {  // section 4.4
  const ScratchFolder folder;
  for (std::size_t triangles = 1; triangles <= 4; ++triangles) {
    ASSERT_TRUE(write_mesh(random_mesh(5, triangles), folder / "m.glb").ok());
    const std::string bytes = test::content_of(folder / "m.glb");
    std::array<std::uint32_t, 5> header;
    ASSERT_GE(bytes.size(), sizeof header);
    std::memcpy(header.data(), bytes.data(), sizeof header);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(header[1], 2u);
    EXPECT_EQ(header[2], bytes.size());
    EXPECT_EQ(header[3] % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, header[3]));
    std::uint32_t body = 0;
    std::memcpy(&body, bytes.data() + 20 + header[3], 4);
    EXPECT_EQ(20 + header[3] + 8 + body, bytes.size());
    EXPECT_EQ(json["buffers"][0]["byteLength"], body);
    EXPECT_FALSE(json["buffers"][0].contains("uri"));
    for (const auto& view : json["bufferViews"])
      EXPECT_EQ(view.contains("byteStride"), view["target"] == TINYGLTF_TARGET_ARRAY_BUFFER);
  }
}

}}  // namespace tessera
