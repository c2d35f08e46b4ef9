// glTF meshes that are read: those of this library, those of tinygltf, and files that exist to be refused.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/mesh/mesh_formats.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera { namespace {

using nlohmann::json;
using test::random_mesh;
using test::ScratchFolder;
using Floats = std::vector<float>;

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A file of one square: four positions, and six indices of type U. The buffer lies in the file "square.bin".
template <class Index = std::uint8_t>
json gltf_square(int index_type = 5121) {
  const std::size_t indices = 6 * sizeof(Index);
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {{{"mesh", 0}, {"name", "square"}}}},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
          {"accessors",
           {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
            {{"bufferView", 1}, {"componentType", index_type}, {"count", 6}, {"type", "SCALAR"}}}},
          {"bufferViews",
           {{{"buffer", 0}, {"byteLength", 48}}, {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", indices}}}},
          {"buffers", {{{"uri", "square.bin"}, {"byteLength", 48 + indices}}}}};
}
const Floats corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
template <class Index = std::uint8_t>
std::string square_bytes() {
  return bytes_of(corners) + bytes_of(std::vector<Index>{0, 1, 2, 0, 2, 3});
}

/// A .glb file of these chunks.
std::string glb(std::string text, std::string binary) {
  while (text.size() % 4 != 0) text += ' ';
  while (binary.size() % 4 != 0) binary += '\0';
  const auto number = [](std::size_t value) { return bytes_of(std::vector{static_cast<std::uint32_t>(value)}); };
  return "glTF" + number(2) + number(28 + text.size() + binary.size()) + number(text.size()) + "JSON" + text +
         number(binary.size()) + std::string("BIN\0", 4) + binary;
}

class GltfReading : public testing::Test {
 protected:
  GltfReading() { folder_.file("square.bin", square_bytes()); }

  Result<Mesh> read(const json& file) {
    warnings_.clear();
    return parse_gltf(file.dump(), folder_ / "m.gltf", {.up = UpAxis::y, .warnings = &warnings_});
  }
  Mesh mesh_of(const json& file) { return test::value_of(read(file)); }
  /// Expects that the message is "m.gltf:1: " and then these words.
  void expect_refused(const json& file, const std::string& words, StatusCode code = StatusCode::parse_error) {
    const Result<Mesh> mesh = read(file);
    EXPECT_EQ(mesh.status().code(), code) << mesh.status().message();
    EXPECT_TRUE(mesh.status().message().find("m.gltf:1: " + words) != std::string::npos) << mesh.status().message();
  }

  ScratchFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(GltfReading, MeshesOfThisLibraryComeBack) {
  for (const char* const extension : {".glb", ".gltf"}) {
    Mesh mesh = random_mesh(300, 500, {true, true, false}, {1000.1, -2e6 - 1.0 / 3, 1e-3});
    for (std::size_t k = 0; k < mesh.normals.size(); k += 3) {
      mesh.normals[k] = 0, mesh.normals[k + 1] = 0.6f, mesh.normals[k + 2] = 0.8f;
    }
    mesh.parts = {{"first", 0, 200}, {"second", 200, 300}};
    ASSERT_TRUE(write_mesh(mesh, folder_ / std::string("m") + extension).ok());
    const Mesh back = test::value_of(read_mesh(folder_ / std::string("m") + extension));
    EXPECT_EQ(back.origin, mesh.origin);
    ASSERT_EQ(back.indices.size(), mesh.indices.size());
    for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(back.positions[3 * back.indices[k] + c], mesh.positions[3 * mesh.indices[k] + c]);
        EXPECT_EQ(back.normals[3 * back.indices[k] + c], mesh.normals[3 * mesh.indices[k] + c]);
      }
      for (std::size_t c = 0; c < 2; ++c)
        EXPECT_EQ(back.parameters[2 * back.indices[k] + c], mesh.parameters[2 * mesh.indices[k] + c]);
    }
    ASSERT_EQ(back.parts.size(), 2u);
    EXPECT_EQ(back.parts[1].name, "second");
    EXPECT_EQ(back.parts[1].first_triangle, 200u);
    EXPECT_EQ(test::value_of(check(back)).closed(), test::value_of(check(mesh)).closed());
  }
}

/// A triangle with 16-bit indices and normals, by tinygltf's own structures.
tinygltf::Model triangle_of_tinygltf() {
  tinygltf::Model model;
  const std::string bytes = bytes_of(Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytes_of(Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}) +
                            bytes_of(std::vector<std::uint16_t>{2, 0, 1});
  model.asset.version = "2.0";
  model.buffers.resize(1);
  model.buffers[0].data.assign(bytes.begin(), bytes.end());
  for (const auto& [offset, length] : {std::pair{0u, 36u}, {36u, 36u}, {72u, 6u}}) {
    tinygltf::BufferView& view = model.bufferViews.emplace_back();
    view.buffer = 0, view.byteOffset = offset, view.byteLength = length;
    tinygltf::Accessor& accessor = model.accessors.emplace_back();
    accessor.bufferView = static_cast<int>(model.accessors.size()) - 1, accessor.count = 3;
    accessor.componentType = offset < 72 ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    accessor.type = offset < 72 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
  }
  tinygltf::Primitive& primitive = model.meshes.emplace_back().primitives.emplace_back();
  primitive.attributes = {{"POSITION", 0}, {"NORMAL", 1}};
  primitive.indices = 2, primitive.mode = TINYGLTF_MODE_TRIANGLES;
  model.nodes.resize(2);
  model.nodes[0].children = {1};
  model.nodes[0].translation = {10, 20, 30};
  model.nodes[1].mesh = 0;
  model.nodes[1].rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // a quarter around z
  model.nodes[1].scale = {2, 2, -2};
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;
  return model;
}

TEST_F(GltfReading, FilesOfTinygltfAreReadInEveryForm) {
  const tinygltf::Model model = triangle_of_tinygltf();
  struct Form {
    const char* name;
    bool embedded, binary;
  };
  for (const Form& form : {Form{"outside.gltf", false, false}, {"inside.gltf", true, false}, {"m.glb", true, true}}) {
    tinygltf::TinyGLTF writer;
    ASSERT_TRUE(writer.WriteGltfSceneToFile(&model, folder_ / form.name, false, form.embedded, true, form.binary));
    const Mesh mesh = test::value_of(read_mesh(folder_ / form.name, {.up = UpAxis::y}));
    EXPECT_EQ(mesh.origin, (Vec3{10, 20, 30})) << form.name;
    ASSERT_EQ(mesh.vertex_count(), 3u);
    const Floats expected{0, 0, 0, 0, 2, 0, -2, 0, 0};
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(mesh.positions[k], expected[k], 1e-6) << form.name << k;
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(mesh.normals[k], k % 3 == 2 ? -1 : 0, 1e-6) << form.name << k;
    // The scale mirrors, so the triangle runs the other way and still faces along its normal.
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{2, 1, 0})) << form.name;
    EXPECT_EQ(test::value_of(check(mesh)).flipped_triangles, 0u);
  }
}

TEST_F(GltfReading, IndicesAreOfThreeTypesOrMissing) {
  const std::vector<std::uint32_t> expected{0, 1, 2, 0, 2, 3};
  EXPECT_EQ(mesh_of(gltf_square()).indices, expected);
  EXPECT_EQ(mesh_of(gltf_square()).positions, corners);
  folder_.file("square.bin", square_bytes<std::uint16_t>());
  EXPECT_EQ(mesh_of(gltf_square<std::uint16_t>(5123)).indices, expected);
  folder_.file("square.bin", square_bytes<std::uint32_t>());
  EXPECT_EQ(mesh_of(gltf_square<std::uint32_t>(5125)).indices, expected);
  expect_refused(gltf_square<std::uint32_t>(5126),
                 "/meshes/0/primitives/0/indices: expected indices of component type");
  json none = gltf_square();
  none["meshes"][0]["primitives"][0].erase("indices");
  none["accessors"][0]["count"] = 3;
  EXPECT_EQ(mesh_of(none).indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_F(GltfReading, StripsAndFansBecomeTriangles) {
  json file = gltf_square();
  json& primitive = file["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["mode"] = 5;
  EXPECT_EQ(mesh_of(file).indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  primitive["mode"] = 6;
  EXPECT_EQ(mesh_of(file).indices, (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
  primitive["mode"] = 7;
  expect_refused(file, "/meshes/0/primitives/0/mode: expected a mode of primitives from 0 to 6, found 7");
  primitive["mode"] = 4;
  expect_refused(file, "/meshes/0/primitives/0: expected 3 corners for each triangle, found 4");
}

TEST_F(GltfReading, TransformsMultiplyAlongTheTree) {
  json file = gltf_square();
  const double turn = std::sqrt(0.5);
  file["nodes"] = {{{"children", {1, 2}}, {"translation", {100, 0, 0}}, {"rotation", {turn, 0, 0, turn}}},
                   {{"mesh", 0}, {"matrix", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1}}},
                   {{"mesh", 0}, {"scale", {1, 2, 1}}}};
  const Mesh mesh = mesh_of(file);
  ASSERT_EQ(mesh.vertex_count(), 8u);
  EXPECT_EQ(mesh.parts.size(), 2u);
  const auto at = [&](std::size_t k) {
    return mesh.origin + Vec3{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
  };
  // A quarter around x takes y to z: the corner (1, 1, 0) goes to (2, 8, 0), then to (102, 0, 8).
  EXPECT_LT(length(at(2) - Vec3{102, 0, 8}), 1e-5);
  EXPECT_LT(length(at(6) - Vec3{101, 0, 2}), 1e-5);
}

TEST_F(GltfReading, NumbersMayBeInterleavedAndOfIntegers) {
  const std::vector<std::int16_t> values{0, 0, 0, 9, 32767, 0, 0, 9, 32767, 32767, 0, 9, 0, -32768, 0, 9};
  folder_.file("square.bin", bytes_of(values) + std::string({0, 1, 2, 0, 2, 3}));
  json file = gltf_square();
  file["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_unlit"};
  file["buffers"][0]["byteLength"] = 38;
  file["bufferViews"] = {{{"buffer", 0}, {"byteLength", 32}, {"byteStride", 8}},
                         {{"buffer", 0}, {"byteOffset", 32}, {"byteLength", 6}}};
  file["accessors"][0]["componentType"] = 5122;
  file["accessors"][0]["normalized"] = true;
  EXPECT_EQ(mesh_of(file).positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, -1, 0}));
  file["accessors"][0]["normalized"] = false;
  EXPECT_EQ(mesh_of(file).positions[3], 32767.f);
  file["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  expect_refused(file, "/extensionsRequired/0: the file needs the extension \"KHR_draco_mesh_compression\"",
                 StatusCode::unsupported);
}

TEST_F(GltfReading, PartsThatAreSkippedAreNamed) {
  json file = gltf_square();
  json& primitives = file["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  primitives.push_back({{"attributes", {{"_WEIGHT", 0}}}});
  primitives[0]["targets"] = json::array();
  file["nodes"][0]["skin"] = 0;
  file["animations"] = json::array();
  EXPECT_EQ(mesh_of(file).triangle_count(), 2u);
  const std::string name = folder_ / "m.gltf";
  EXPECT_EQ(warnings_, (std::vector<std::string>{
                           name + ": animations are not read", name + ": morph targets are not read",
                           name + ": primitives of points or lines are not read",
                           name + ": primitives without positions are not read", name + ": skins are not read"}));
}

TEST_F(GltfReading, OtherFilesMustLieBesideOrBelow) {
  json file = gltf_square();
  std::filesystem::create_directory(folder_ / "a b");
  folder_.file("a b/square.bin", square_bytes());
  json& uri = file["buffers"][0]["uri"];
  uri = "./a%20b/square.bin";
  EXPECT_TRUE(read(file).ok()) << read(file).status().message();
  for (const char* const outside : {"../square.bin", "/etc/passwd", "a/../../x", "%2e%2e/x", "http://host/x", "%2Fx"}) {
    uri = outside;
    const Status status = read(file).status();
    EXPECT_EQ(status.code(), StatusCode::unsupported) << outside;
    EXPECT_NE(status.message().find("must be relative to this file, without .."), std::string::npos) << outside;
  }
  const ScratchFolder elsewhere;
  std::filesystem::create_symlink(elsewhere.file("square.bin", square_bytes()), folder_ / "link.bin");
  uri = "link.bin";
  EXPECT_EQ(read(file).status().code(), StatusCode::unsupported);
  EXPECT_NE(read(file).status().message().find("it is a link to "), std::string::npos);
  for (const char* const bad : {"", "%", "%2", "%zz", "a%00b", "data:,x", "data:application/octet-stream;base64,"}) {
    uri = bad;
    expect_refused(file, "/buffers/0/uri: expected");
  }
  uri = "missing.bin";
  expect_refused(file, "/buffers/0/uri: " + (folder_ / "missing.bin") + ": cannot be opened", StatusCode::io_error);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);  // would never end
  uri = "pipe";
  expect_refused(file, "/buffers/0/uri: " + (folder_ / "pipe") + ": is not a regular file", StatusCode::io_error);
}

TEST_F(GltfReading, NumbersOutsideTheirBufferAreRefused) {
  const auto refused = [&](const char* place, json value, const std::string& words) {
    json file = gltf_square();
    file[json::json_pointer(place)] = std::move(value);
    expect_refused(file, words);
  };
  refused("/buffers/0/byteLength", 55, "/buffers/0: expected 55 bytes (byteLength), found 54");
  refused("/bufferViews/1/byteLength", 7, "/bufferViews/1: 7 bytes from byte 48 on are not in a buffer of 54 bytes");
  refused("/bufferViews/1/byteOffset", 9007199254740991, "/bufferViews/1: 6 bytes from byte 9007199254740991 on");
  refused("/accessors/0/count", 5, "/accessors/0: 5 elements of 12 bytes, every 12 bytes from byte 0 on, are not in");
  refused("/accessors/0/count", 0, "/accessors/0: 0 elements");
  refused("/accessors/0/count", 4000000000000000, "/accessors/0: 4000000000000000 elements");
  refused("/accessors/0/count", -1, "/accessors/0/count: expected a whole number, 0 or above, found -1");
  refused("/accessors/0/byteOffset", 1, "/accessors/0: 4 elements");
  refused("/accessors/0/bufferView", 2, "/accessors/0/bufferView: the index 2 is beyond the 2 elements of bufferViews");
  refused("/accessors/0/componentType", 5124, "/accessors/0/componentType: expected a type of component");
  refused("/accessors/0/type", "VEC4", "/accessors/0/type: expected \"VEC3\", found \"VEC4\"");
  refused("/bufferViews/0/byteStride", 4, "/accessors/0: an element takes 12 bytes, the view's byteStride is 4");
  refused("/meshes/0/primitives/0/indices", 9, "/meshes/0/primitives/0/indices: the index 9 is beyond the 2 elements");
  refused("/meshes/0/primitives/0/attributes/NORMAL", 1, "/accessors/1/type: expected \"VEC3\"");
  refused("/nodes/0/mesh", 1, "/nodes/0/mesh: the index 1 is beyond the 1 elements of meshes");
  refused("/nodes/0/rotation", {0, 0, 0, 0}, "/nodes/0/rotation: expected a quaternion of length 1");
  refused("/nodes/0/scale", {1, 1}, "/nodes/0/scale: expected an array of 3 numbers, found an array of 2");
  refused("/nodes/0/scale", {"1", 1, 1}, "/nodes/0/scale/0: expected a number, found \"1\"");
  refused("/nodes/0/children", {0}, "/nodes/0: the node is a child of two nodes, or of itself");
  refused("/scenes/0/nodes", json::array({0, 0}), "/nodes/0: the node is a child of two nodes, or of itself");
  refused("/nodes", {{{"name", "empty"}}}, "there are no triangles");
  folder_.file("square.bin", bytes_of(corners) + std::string({0, 1, 2, 0, 2, 4}));
  expect_refused(gltf_square(), "/meshes/0/primitives/0: index 5 is 4, but there are 4 vertices");
}

TEST_F(GltfReading, FormsThatAreNotReadAreNamed) {
  json file = gltf_square();
  file["accessors"][0]["sparse"] = json::object();
  expect_refused(file, "/accessors/0/sparse: sparse accessors are not read", StatusCode::unsupported);
  file = gltf_square();
  file["accessors"][0].erase("bufferView");
  expect_refused(file, "/accessors/0: \"bufferView\" is missing", StatusCode::unsupported);
  file = gltf_square();
  file["asset"]["version"] = "1.0";
  expect_refused(file, "/asset/version: found version \"1.0\"", StatusCode::unsupported);
  expect_refused(json::object(), "\"asset\" is missing");
  expect_refused(json::array(), "expected an object");
}

TEST_F(GltfReading, CopiesOfAMeshAreLimited) {
  json file = gltf_square();
  file["nodes"] = json::array({{{"children", json::array()}}});
  const auto add = [&](std::size_t copies) {
    for (std::size_t k = 0; k < copies; ++k) {
      file["nodes"][0]["children"].push_back(file["nodes"].size());
      file["nodes"].push_back({{"mesh", 0}});
    }
  };
  add(1000);
  EXPECT_EQ(mesh_of(file).triangle_count(), 2000u);
  // 64 kB of positions, placed 1,000 times by 20 kB.
  folder_.file("square.bin", bytes_of(Floats(16500, 1)));
  file["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 5499}, {"type", "VEC3"}}};
  file["bufferViews"] = {{{"buffer", 0}, {"byteLength", 66000}}};
  file["buffers"][0]["byteLength"] = 66000;
  file["meshes"][0]["primitives"][0].erase("indices");
  expect_refused(file, "/meshes/0/primitives/0: the copies of the meshes take more than 64 times",
                 StatusCode::unsupported);
}

TEST_F(GltfReading, ContainersMustBeWhole) {
  json file = gltf_square();
  file["buffers"][0].erase("uri");
  const std::string whole = glb(file.dump(), square_bytes());
  const auto parse = [](const std::string& bytes) { return parse_gltf(bytes, "m", {.up = UpAxis::y}); };
  ASSERT_TRUE(parse(whole).ok()) << parse(whole).status().message();
  EXPECT_EQ(parse(whole)->positions, corners);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const Result<Mesh> mesh = parse_gltf({cut.data(), cut.size()}, "m");
    ASSERT_FALSE(mesh.ok()) << size;
    EXPECT_TRUE(mesh.status().message().starts_with("m:")) << mesh.status().message();
  }
  const std::string size = std::to_string(whole.size());
  EXPECT_EQ(parse(whole + "x").status().message(),
            "m: the header states " + size + " bytes, the file has " + std::to_string(whole.size() + 1));
  const auto changed = [&](std::size_t at, char value) {
    std::string bytes = whole;
    bytes[at] = value;
    return parse(bytes).status().message();
  };
  EXPECT_EQ(changed(4, 1), "m: found version 1 of the container, this reader knows version 2");
  EXPECT_EQ(changed(16, 'j'), "m: expected one chunk of JSON, as the first one");
  EXPECT_TRUE(changed(14, 1).starts_with("m: chunk 1 is longer than the file")) << changed(14, 1);
  file["buffers"][0]["byteLength"] = 100;
  EXPECT_EQ(parse(glb(file.dump(), square_bytes())).status().message(),
            "m:1: /buffers/0: expected 100 bytes (byteLength), found 56");
}

}}  // namespace tessera
