// STL meshes, binary and ascii: of other programs, and malformed ones.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "io/mesh/mesh_formats.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

using test::random_mesh;
using test::ScratchFolder;
using Indices = std::vector<std::uint32_t>;

/// The bytes that write_mesh makes of it.
std::string written(const Mesh& mesh) {
  const ScratchFolder folder;
  const Status status = write_mesh(mesh, folder / "m.stl");
  EXPECT_TRUE(status.ok()) << status.message();
  return test::content_of(folder / "m.stl");
}

Mesh parsed(const std::string& bytes) {
  const Result<Mesh> mesh = parse_stl(bytes, "m.stl");
  EXPECT_TRUE(mesh.ok()) << mesh.status().message();
  return mesh ? *mesh : Mesh{};
}

std::string stl_message(const std::string& bytes) {
  const Result<Mesh> mesh = parse_stl(bytes, "m.stl");
  EXPECT_FALSE(mesh.ok()) << bytes;
  return mesh.ok() ? "" : mesh.status().message();
}

/// The coordinates of all corners, one after the other.
std::vector<float> stl_corners(const Mesh& mesh) {
  std::vector<float> values;
  for (const std::uint32_t index : mesh.indices)
    values.insert(values.end(), &mesh.positions[3 * index], &mesh.positions[3 * index] + 3);
  return values;
}

std::array<float, 12> facet(const std::string& bytes, std::size_t triangle) {
  std::array<float, 12> values;
  std::memcpy(values.data(), bytes.data() + 84 + 50 * triangle, sizeof values);
  return values;
}

const std::string one_facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST(Stl, TheFileIsWhatTheFormatSays) {
  const Mesh mesh = random_mesh(50, 80);
  const std::string bytes = written(mesh);
  ASSERT_EQ(bytes.size(), 84 + 50 * 80u);
  EXPECT_NE(bytes.substr(0, 5), "solid");
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(count, 80u);
  const std::vector<float> expected = stl_corners(mesh);
  for (std::size_t k = 0; k < 80; ++k) {
    const std::array<float, 12> values = facet(bytes, k);
    EXPECT_TRUE(std::equal(values.begin() + 3, values.end(), expected.begin() + static_cast<std::ptrdiff_t>(9 * k)));
    EXPECT_EQ(bytes.substr(84 + 50 * k + 48, 2), std::string(2, '\0'));
  }
}

TEST(Stl, NormalsAreUnitAndSeeTheCornersCounterClockwise) {
  const Mesh mesh = random_mesh(50, 80);
  const std::string bytes = written(mesh);
  for (std::size_t k = 0; k < 80; ++k) {
    const std::array<float, 12> f = facet(bytes, k);
    const Vec3 n{f[0], f[1], f[2]}, a{f[3], f[4], f[5]}, b{f[6], f[7], f[8]}, c{f[9], f[10], f[11]};
    if (a == b || b == c || c == a) {
      EXPECT_EQ(n, Vec3{});
      continue;
    }
    EXPECT_NEAR(length(n), 1, 1e-6);
    EXPECT_NEAR(dot(n, b - a), 0, 1e-4);  // float's rounding of n times the size
    EXPECT_NEAR(dot(n, c - a), 0, 1e-4);
    EXPECT_GT(dot(n, cross(b - a, c - a)), 0);
  }
}

TEST(Stl, EveryCornerComesBackAndEqualOnesAreOneVertex) {
  for (const std::size_t vertices : {3u, 50u, 60000u}) {
    const Mesh mesh = random_mesh(vertices, 2 * vertices, {false, false, false});
    const Mesh read = parsed(written(mesh));
    EXPECT_EQ(stl_corners(read), stl_corners(mesh));
    EXPECT_LE(read.vertex_count(), vertices);  // vertices without a triangle do not come back
    EXPECT_GE(read.vertex_count(), vertices * 8 / 10);
  }
}

TEST(Stl, ThePatternOfAWeldedMeshIsKept) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const Mesh read = parsed(written(mesh));
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.indices, mesh.indices);
  mesh.positions[2] = -0.0f;
  mesh.positions.insert(mesh.positions.end(), {0, 0, 0});
  mesh.indices[3] = 4;  // the same place, but for the sign of a zero
  EXPECT_EQ(parsed(written(mesh)).indices, (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(Stl, TheOriginIsAddedInDouble) {
  Mesh mesh = random_mesh(3, 1, {false, false, false}, {1000.1, -2e6, 1e-3});
  mesh.indices = {0, 1, 2};
  const std::array<double, 3> origin{1000.1, -2e6, 1e-3};
  const Mesh read = parsed(written(mesh));
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_EQ(read.positions[k], static_cast<float>(origin[k % 3] + static_cast<double>(mesh.positions[k])));
}

TEST(Stl, TheFileIsTheSameAtEverySize) {  // of pieces, and of the buffer
  const Mesh mesh = random_mesh(1000, 200000, {false, false, false});
  const std::string bytes = written(mesh);
  const std::vector<float> expected = stl_corners(mesh);
  for (std::size_t k = 0; k < 200000; ++k)
    ASSERT_EQ(std::memcmp(bytes.data() + 84 + 50 * k + 12, expected.data() + 9 * k, 36), 0) << k;
}

TEST(Stl, AsciiIsRead) {
  const std::string text =
      "\xef\xbb\xbf solid a cube of solids\r\n  FACET NORMAL 0 0 -1.0e0\n outer\tloop vertex 0 0 0 vertex 0 1 0\n"
      "vertex 1 0 nan endloop endfacet\nendsolid a cube\nsolid\n" +
      one_facet + "endsolid";
  const Mesh mesh = parsed(text);
  EXPECT_EQ(mesh.triangle_count(), 2u);
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 3, 1}));
  EXPECT_TRUE(std::isnan(mesh.positions[8]));
}

TEST(Stl, BinaryFilesMayBeginWithSolid) {
  std::string bytes = written(random_mesh(4, 3));
  bytes.replace(0, 6, "solid ");
  EXPECT_EQ(parsed(bytes).triangle_count(), 3u);
}

TEST(Stl, TruncatedAtEveryByte) {
  const std::string bytes = written(random_mesh(6, 5));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_stl(std::string_view(bytes).substr(0, size), "cut").ok()) << size;
  const std::string text = "solid s\n" + one_facet + one_facet + "endsolid";
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_FALSE(parse_stl(std::string_view(text).substr(0, size), "cut").ok()) << size;
}

TEST(Stl, ErrorsNameThePlace) {
  EXPECT_EQ(stl_message("solid s\nendsolid s\n"), "m.stl:2: there are no triangles");
  EXPECT_EQ(stl_message("x"),
            "m.stl: the file does not begin with solid, and with 1 bytes it is too short for a binary STL file");
  std::string huge(84 + 50, 'x');
  EXPECT_EQ(stl_message(huge),
            "m.stl: the header states 2021161080 triangles; the file has room for 1 and 0 bytes more");
  huge.replace(80, 4, 4, '\0');
  EXPECT_EQ(stl_message(huge), "m.stl: the header states 0 triangles; the file has room for 1 and 0 bytes more");
  EXPECT_EQ(stl_message(huge.substr(0, 84)), "m.stl: there are no triangles");
  EXPECT_EQ(stl_message("solid s\nfacet normal 0 0\n"),
            "m.stl:2: expected 3 numbers after normal, found the end of the line");
  EXPECT_EQ(stl_message("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
            "m.stl:6: expected 3 lines of vertex, found \"endloop\"");
  EXPECT_EQ(stl_message("solid s\n" + one_facet), "m.stl:8: expected facet or endsolid, found the end of the file");
  EXPECT_EQ(stl_message("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0,5\n"),
            "m.stl:4: expected 3 numbers after vertex, found \"0,5\"");
}

}}  // namespace tessera
