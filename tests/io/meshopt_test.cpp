// glTF packed by EXT_meshopt_compression: what is read back has the bits that were written, and what is damaged is
// refused.

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "io/mesh/meshopt.h"
#include "io/mesh_samples.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/mesh_assembly.h"
#include "tessera/tessellation.h"

namespace tessera { namespace {

using nlohmann::json;
using test::random_mesh;
using test::ScratchFolder;
using test::value_of;

/// The corners of triangles, each begun at the corner that makes the least list.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    const std::uint32_t a = mesh.indices[k], b = mesh.indices[k + 1], c = mesh.indices[k + 2];
    triangles.push_back(std::min({std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}}));
  }
  return triangles;
}

void expect_same(const Mesh& plain, const Mesh& packed) {
  EXPECT_EQ(plain.positions, packed.positions);
  EXPECT_EQ(plain.normals, packed.normals);
  EXPECT_EQ(plain.parameters, packed.parameters);
  EXPECT_EQ(plain.origin, packed.origin);
  EXPECT_TRUE(triangles_of(plain) == triangles_of(packed));
  ASSERT_EQ(plain.parts.size(), packed.parts.size());
  for (std::size_t k = 0; k < plain.parts.size(); ++k) {
    EXPECT_EQ(plain.parts[k].name, packed.parts[k].name);
    EXPECT_EQ(plain.parts[k].triangle_count, packed.parts[k].triangle_count);
  }
}

Mesh teapot(double tolerance) {
  const Model model = value_of(read_model(TESSERA_SOURCE_DIR "/tools/models/teapot.bpt"));
  const PatchSet set = value_of(make_patch_set(model));
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance}));
  Mesh mesh = value_of(plan.run(set));
  mesh.parts = value_of(parts_by_surface(mesh, set, model));
  return mesh;
}

std::string content(const std::string& path) { return value_of(read_file(path)); }

/// The JSON of a .glb file, and its second chunk.
std::pair<json, std::string> chunks_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, &glb[12], sizeof size);
  return {json::parse(glb.substr(20, size)), glb.substr(28 + size)};
}

TEST(Meshopt, BitsAreKept) {
  const ScratchFolder folder;
  for (const char* const name : {"mesh.glb", "mesh.gltf"})
    for (const Mesh& mesh : {random_mesh(300, 800), random_mesh(5, 1, {false, false, false}),
                             random_mesh(700, 2000, {true, false, true}, {1e6, 2, 3}), teapot(0.01)}) {
      ASSERT_TRUE(write_mesh(mesh, folder / name).ok());
      const Mesh plain = value_of(read_mesh(folder / name));
      const Status status = write_mesh(mesh, folder / name, {.packed = true});
      ASSERT_TRUE(status.ok()) << status.message();
      expect_same(plain, value_of(read_mesh(folder / name)));
    }
}

TEST(Meshopt, FilesAreSmallAndSayWhatTheyNeed) {
  const ScratchFolder folder;
  const Mesh mesh = teapot(0.001);
  ASSERT_TRUE(write_mesh(mesh, folder / "plain.glb").ok());
  ASSERT_TRUE(write_mesh(mesh, folder / "packed.glb", {.packed = true}).ok());
  const std::string plain = content(folder / "plain.glb"), packed = content(folder / "packed.glb");
  std::cout << plain.size() << " bytes, packed " << packed.size() << '\n';
  EXPECT_LT(packed.size(), plain.size() / 2);
  const auto [file, bytes] = chunks_of(packed);
  EXPECT_EQ(file["extensionsRequired"], json({"EXT_meshopt_compression"}));
  EXPECT_EQ(file["extensionsUsed"], json({"EXT_meshopt_compression"}));
  ASSERT_EQ(file["buffers"].size(), 2u);
  EXPECT_EQ(file["buffers"][0]["byteLength"], bytes.size());
  EXPECT_EQ(file["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"], true);
  EXPECT_EQ(file["buffers"][1]["byteLength"], chunks_of(plain).second.size());
  for (const json& view : file["bufferViews"]) {
    const json& of = view["extensions"]["EXT_meshopt_compression"];
    EXPECT_EQ(view["buffer"], 1);
    EXPECT_EQ(of["count"].get<std::size_t>() * of["byteStride"].get<std::size_t>(), view["byteLength"]);
    // The versions that the extension names.
    const auto first = static_cast<unsigned char>(bytes[of["byteOffset"].get<std::size_t>()]);
    EXPECT_EQ(first, of["mode"] == "ATTRIBUTES" ? 0xa0 : 0xe1);
  }
}

TEST(Meshopt, InstancesShareTheirNumbers) {
  const ScratchFolder folder;
  MeshAssembly assembly;
  assembly.unit = "mm";
  assembly.shapes = {{"a", random_mesh(40, 90)}, {"b", random_mesh(60, 70)}};
  for (std::size_t k = 0; k < 6; ++k)
    assembly.instances.push_back(
        {.name = "i" + std::to_string(k), .shape = k % 2, .placement = Affine::translated({double(k), 0, 0})});
  ASSERT_TRUE(write_assembly(assembly, folder / "plain.glb").ok());
  ASSERT_TRUE(write_assembly(assembly, folder / "packed.glb", {.packed = true}).ok());
  expect_same(value_of(read_mesh(folder / "plain.glb")), value_of(read_mesh(folder / "packed.glb")));
  EXPECT_EQ(chunks_of(content(folder / "packed.glb")).first["bufferViews"].size(), 8u);
}

/// A .glb file of this JSON and these bytes.
std::string glb(const json& file, const std::string& bytes) {
  std::string text = file.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    std::string number(4, '\0');
    const auto bits = static_cast<std::uint32_t>(value);
    std::memcpy(number.data(), &bits, sizeof bits);
    return number;
  };
  return "glTF" + word(2) + word(28 + text.size() + bytes.size()) + word(text.size()) + "JSON" + text +
         word(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

class PackedFile : public testing::Test {
 protected:
  PackedFile() {
    EXPECT_TRUE(write_mesh(random_mesh(100, 200), folder_ / "a.glb", {.packed = true}).ok());
    std::tie(file_, bytes_) = chunks_of(content(folder_ / "a.glb"));
  }
  json& packed(std::size_t view) { return file_["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]; }
  std::string error() {
    const Result<Mesh> mesh = read_mesh(folder_.file("b.glb", glb(file_, bytes_)));
    return mesh.status().message();
  }

  ScratchFolder folder_;
  json file_;
  std::string bytes_;
};

TEST_F(PackedFile, FalseStatementsAreErrors) {
  ASSERT_EQ(error(), "");
  const auto with = [&](std::size_t view, const char* key, const json& value) {
    const json before = file_;
    packed(view)[key] = value;
    const std::string message = error();
    file_ = before;
    return message;
  };
  EXPECT_NE(with(0, "mode", "POINTS").find("\"POINTS\", which the extension does not have"), std::string::npos);
  EXPECT_NE(with(0, "filter", "HALF").find("\"HALF\", which the extension does not have"), std::string::npos);
  EXPECT_NE(with(3, "filter", "EXPONENTIAL").find("of this mode and filter"), std::string::npos);
  EXPECT_NE(with(0, "filter", "OCTAHEDRAL").find("of this mode and filter cannot be 100 of 12"), std::string::npos);
  EXPECT_NE(with(0, "byteStride", 6).find("of this mode and filter"), std::string::npos);
  EXPECT_NE(with(0, "byteStride", 0).find("of this mode and filter"), std::string::npos);
  EXPECT_NE(with(0, "byteStride", 260).find("of this mode and filter"), std::string::npos);
  EXPECT_NE(with(3, "count", 599).find("of this mode and filter"), std::string::npos);
  EXPECT_NE(with(0, "count", 99).find("expected the view's 1200 bytes (byteLength), found 99 elements of 12"),
            std::string::npos);
  EXPECT_NE(with(0, "count", 4503599627370495).find("elements of 12"), std::string::npos);
  EXPECT_NE(with(0, "byteLength", 5).find("the packed bytes are damaged"), std::string::npos);
  EXPECT_NE(with(0, "byteLength", 1 << 30).find("are not in a buffer"), std::string::npos);
  EXPECT_NE(with(0, "buffer", 1).find("no binary chunk"), std::string::npos);
  file_["bufferViews"][0]["byteLength"] = packed(0)["count"] = 1 << 24;
  packed(0)["byteStride"] = 4;
  file_["bufferViews"][0]["byteLength"] = 1 << 26;
  EXPECT_NE(error().find("more than 64 times its buffers and 16 MiB"), std::string::npos);
}

TEST_F(PackedFile, ViewsThatShareTheirBytesTakeNoMoreMemoryThanIsStated) {
  constexpr std::size_t bytes = std::size_t{12} << 20;
  const std::string zeros = pack_attributes(std::string(bytes, '\0'), 12);
  packed(0)["byteOffset"] = bytes_.size();
  packed(0)["byteLength"] = zeros.size();
  packed(0)["count"] = bytes / 12;
  file_["bufferViews"][0]["byteLength"] = bytes;
  bytes_ += zeros;
  file_["buffers"][0]["byteLength"] = bytes_.size();
  const std::size_t allowed = (64 * bytes_.size() + (std::size_t{16} << 20)) / bytes;
  const json accessor = file_["accessors"][0], primitive = file_["meshes"][0]["primitives"][0];
  for (std::size_t views = 1; views <= allowed; ++views) {
    EXPECT_EQ(error().find("packed numbers"), std::string::npos) << views;
    file_["accessors"].push_back(accessor);
    file_["accessors"].back()["bufferView"] = file_["bufferViews"].size();
    file_["meshes"][0]["primitives"].push_back(primitive);
    file_["meshes"][0]["primitives"].back()["attributes"] = {{"POSITION", file_["accessors"].size() - 1}};
    file_["bufferViews"].push_back(file_["bufferViews"][0]);
  }
  EXPECT_NE(error().find("packed numbers take more than 64 times its buffers and 16 MiB"), std::string::npos);
}

TEST_F(PackedFile, DamagedBytesAreErrorsOrOtherNumbers) {
  std::mt19937 random(7);
  const std::string whole = bytes_;
  std::size_t errors = 0;
  for (int k = 0; k < 2000; ++k) {
    bytes_ = whole;
    for (int change = 0; change < 1 + k % 3; ++change) bytes_[random() % bytes_.size()] = static_cast<char>(random());
    errors += error().empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 100u);  // by the decoder, or by what its numbers are
}

TEST_F(PackedFile, OtherModesAndFiltersAreRead) {
  const Mesh plain = value_of(read_mesh(folder_ / "a.glb"));
  // Indices in a sequence, of 16 bits; positions with an exponent; normals as octahedra of 8 bits.
  const std::vector<std::uint16_t> shorts(plain.indices.begin(), plain.indices.end());
  std::string indices(meshopt_encodeIndexSequenceBound(shorts.size(), 100), '\0');
  indices.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(indices.data()), indices.size(),
                                             plain.indices.data(), plain.indices.size()));
  std::vector<float> positions(plain.positions.size());
  meshopt_encodeFilterExp(positions.data(), 100, 12, 24, plain.positions.data());
  std::vector<float> vectors(400);
  for (std::size_t k = 0; k < 300; ++k) vectors[k / 3 * 4 + k % 3] = plain.normals[k];
  std::string normals(400, '\0');
  meshopt_encodeFilterOct(normals.data(), 100, 4, 8, vectors.data());
  const std::string parts[] = {pack_attributes({reinterpret_cast<const char*>(positions.data()), 1200}, 12),
                               pack_attributes(normals, 4),
                               bytes_.substr(packed(2)["byteOffset"], packed(2)["byteLength"]), indices};
  bytes_.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    packed(k)["byteOffset"] = bytes_.size();
    packed(k)["byteLength"] = parts[k].size();
    bytes_ += parts[k];
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
  }
  packed(0)["filter"] = "EXPONENTIAL";
  packed(1)["filter"] = "OCTAHEDRAL";
  packed(1)["byteStride"] = file_["bufferViews"][1]["byteStride"] = 4;
  file_["bufferViews"][1]["byteLength"] = 400;
  packed(3)["mode"] = "INDICES";
  packed(3)["byteStride"] = 2;
  file_["bufferViews"][3]["byteLength"] = 2 * shorts.size();
  file_["buffers"][0]["byteLength"] = bytes_.size();
  for (json& accessor : file_["accessors"]) {
    if (accessor["type"] == "SCALAR") accessor["componentType"] = 5123;
    if (accessor["bufferView"] == 1) accessor["componentType"] = 5120, accessor["normalized"] = true;
  }
  const Result<Mesh> read = read_mesh(folder_.file("c.glb", glb(file_, bytes_)));
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->indices, plain.indices);
  ASSERT_EQ(read->positions.size(), plain.positions.size());
  for (std::size_t k = 0; k < 300; ++k) {
    EXPECT_NEAR(read->positions[k], plain.positions[k], 1e-4);
    EXPECT_NEAR(read->normals[k], plain.normals[k], 0.02);
  }
}

}}  // namespace tessera
