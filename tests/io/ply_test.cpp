// PLY meshes of other programs, and PLY files that state more than they hold.

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "io/mesh/mesh_formats.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

using Indices = std::vector<std::uint32_t>;

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string vertex3 = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string face1 = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ply_error(const std::string& text) {
  const Result<Mesh> mesh = parse_ply(text, "m.ply");
  EXPECT_FALSE(mesh.ok()) << text;
  return mesh.ok() ? "" : mesh.status().message();
}

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

TEST(Ply, AsciiIsRead) {
  const Result<Mesh> mesh = parse_ply(
      ascii + "comment by hand\n" + vertex3 + face1 + "end_header\n0 0 0\n1 0 0.5\n0 1 nan\n3 0 1 2", "m.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->vertex_count(), 3u);
  EXPECT_EQ(mesh->positions[5], 0.5f);
  EXPECT_EQ(mesh->indices, (Indices{0, 1, 2}));
}

TEST(Ply, AnyOrderAndTypesOfPropertiesAreRead) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 4\r\nproperty uchar red\r\nproperty double z\r\n"
      "property list uchar short neighbours\r\nproperty float y\r\nproperty short x\r\nproperty float32 u\r\n"
      "property float32 v\r\nelement edge 2\r\nproperty int a\r\nelement face 1\r\nproperty uint patch\r\n"
      "property float quality\r\nproperty list uint ushort vertex_index\r\nend_header\r\n";
  for (int k = 0; k < 4; ++k) {
    put<std::uint8_t>(bytes, 255);
    put<double>(bytes, 0.25 * k);
    put<std::uint8_t>(bytes, static_cast<std::uint8_t>(k));
    for (int n = 0; n < k; ++n) put<std::int16_t>(bytes, -1);
    put<float>(bytes, -1.5f);
    put<std::int16_t>(bytes, static_cast<std::int16_t>(-300 * k));
    put<float>(bytes, 0.5f);
    put<float>(bytes, static_cast<float>(k));
  }
  put<std::int32_t>(bytes, 1);
  put<std::int32_t>(bytes, 2);
  put<std::uint32_t>(bytes, 77);
  put<float>(bytes, 1);
  put<std::uint32_t>(bytes, 4);
  for (const int corner : {3, 2, 1, 0}) put(bytes, static_cast<std::uint16_t>(corner));
  const Result<Mesh> mesh = parse_ply(bytes, "m.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->positions,
            (std::vector<float>{0, -1.5f, 0, -300, -1.5f, 0.25f, -600, -1.5f, 0.5f, -900, -1.5f, 0.75f}));
  EXPECT_EQ(mesh->parameters, (std::vector<float>{0.5f, 0, 0.5f, 1, 0.5f, 2, 0.5f, 3}));
  EXPECT_TRUE(mesh->normals.empty());
  EXPECT_EQ(mesh->indices, (Indices{3, 2, 1, 3, 1, 0}));
  EXPECT_EQ(mesh->patches, (Indices{77, 77}));
}

TEST(Ply, PatchesOfTrianglesComeBack) {
  const test::ScratchFolder folder;
  const Mesh mesh = test::random_mesh(10, 20);
  ASSERT_TRUE(write_mesh(mesh, folder / "m.ply").ok());
  const Result<Mesh> read = read_mesh(folder / "m.ply");
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->patches, mesh.patches);
}

TEST(Ply, TheFileIsAsLongAsItsHeaderSays) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_mesh(test::random_mesh(10, 20), folder / "m.ply").ok());
  const std::string bytes = test::content_of(folder / "m.ply");
  const std::size_t header = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.size(), header + 10 * 8 * sizeof(float) + 20 * (1 + 3 * 4 + 4));
}

TEST(Ply, HugeCountsAllocateNothing) {
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    const std::string begin = "ply\nformat " + format + " 1.0\n";
    const std::string message = ply_error(begin +
                                          "element vertex 4000000000000\nproperty float x\nproperty float y\n"
                                          "property float z\nend_header\n1 2 3\n");
    EXPECT_NE(message.find("the header states 4000000000000 vertex records; the file is too short"), std::string::npos)
        << message;
    const std::string faces =
        ply_error(begin + "element face 9223372036854775807\nproperty list uchar int vertex_indices\nend_header\n");
    EXPECT_NE(faces.find("too short"), std::string::npos) << faces;
  }
  std::string list =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
  put<std::uint32_t>(list, 4000000000u);
  EXPECT_EQ(ply_error(list), "m.ply: the file ends in face 1 of 1");
}

TEST(Ply, ErrorsNameThePlace) {
  EXPECT_EQ(ply_error("plx\n"), "m.ply:1: expected ply, found \"plx\"");
  EXPECT_EQ(ply_error("ply\nend_header\n"), "m.ply:2: expected format, before end_header, found \"end_header\"");
  EXPECT_EQ(ply_error("ply\nformat binary_big_endian 1.0\n"), "m.ply:2: unsupported format binary_big_endian");
  EXPECT_EQ(ply_error("ply\nformat ascii 2.0\n"), "m.ply:2: expected the format's version 1.0, found \"2.0\"");
  EXPECT_EQ(ply_error(ascii + "element vertex -1\n"),
            "m.ply:3: expected how many vertex records there are, found \"-1\"");
  EXPECT_EQ(ply_error(ascii + "property float x\n"), "m.ply:3: expected element before the first property");
  EXPECT_EQ(ply_error(ascii + "element vertex 1\nproperty half x\n"),
            "m.ply:4: expected a type (char, uchar, short, ushort, int, uint, float, double), found \"half\"");
  EXPECT_EQ(ply_error(ascii + vertex3),
            "m.ply:6: expected format, element, property, comment or end_header, found the end of the file");
  EXPECT_EQ(ply_error(ascii + vertex3 + "end_header\n0 0 0\n1 x 0\n0 1 0\n"),
            "m.ply:9: expected a number of vertex 2 of 3, found \"x\"");
  EXPECT_EQ(ply_error(ascii + vertex3 + face1 + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "m.ply:13: a face has the vertex index 3, but there are 3 vertices");
  EXPECT_EQ(ply_error(ascii + vertex3 + face1 + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
            "m.ply:13: face 1 of 1 has a corner that is no index");
  EXPECT_EQ(ply_error(ascii + vertex3 + face1 + "end_header\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
            "m.ply:13: face 1 of 1 has fewer than 3 corners");
  EXPECT_EQ(ply_error(ascii + vertex3 + "end_header\n0 0 0\n1 0 0\n0 1 0\n7\n"),
            "m.ply:11: there is data after the last element");
  EXPECT_EQ(ply_error(ascii + "element vertex 1\nproperty float x\nend_header\n0\n"),
            "m.ply:6: vertices have no x, y, z");
}

TEST(Ply, WhatIsDeclaredTwiceIsRefused) {
  EXPECT_EQ(ply_error(ascii + "format ascii 1.0\n" + vertex3 + "end_header\n0 0 0\n1 0 0\n0 1 0\n"),
            "m.ply:3: the format is stated a second time");
  EXPECT_EQ(ply_error(ascii + vertex3 + vertex3 + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 0\n1 0 0\n0 1 0\n"),
            "m.ply:7: there is a second element \"vertex\"");
  EXPECT_EQ(ply_error(ascii + vertex3 + face1 + face1 + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
            "m.ply:9: there is a second element \"face\"");
  EXPECT_EQ(ply_error(ascii + vertex3 + face1 +
                      "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n"),
            "m.ply:9: there is a second list of indices");
  EXPECT_EQ(ply_error(ascii + vertex3 + "property float x\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n"),
            "m.ply:7: there is a second property \"x\" of vertex");
}

TEST(Ply, SpoiledBytesNeverCrash) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_mesh(test::random_mesh(10, 20), folder / "m.ply").ok());
  const std::string bytes = test::content_of(folder / "m.ply");
  std::mt19937 random(5);
  for (int k = 0; k < 5000; ++k) {
    std::string spoiled = bytes;
    for (int n = 0; n < 3; ++n) spoiled[random() % spoiled.size()] = static_cast<char>(random());
    const Result<Mesh> mesh = parse_ply(spoiled, "m.ply");
    if (mesh.ok()) {
      for (const std::uint32_t index : mesh->indices) ASSERT_LT(index, mesh->vertex_count());
    }
  }
}

}}  // namespace tessera
