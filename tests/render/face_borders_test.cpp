// Lines where the faces of a mesh end: not inside faces, not along seams.

#include "render/face_borders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace tessera::render { namespace {

/// The square [0,1]^2 of two triangles that share no vertices, with the diagonal from (0,0) to (1,1).
Mesh square_face() {
  Mesh mesh;
  mesh.origin = {3, 4, 5};
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2, 3, 4, 5};
  return mesh;
}

using Line = std::array<float, 4>;

/// The lines as x and y of both ends, the smaller end first.
std::multiset<Line> lines_of(const Mesh& borders) {
  std::multiset<Line> lines;
  for (std::size_t t = 0; t < borders.triangle_count(); ++t) {
    EXPECT_EQ(borders.indices[3 * t + 1], borders.indices[3 * t + 2]) << t;
    std::array<std::array<float, 2>, 2> ends;
    for (std::size_t c = 0; c < 2; ++c) {
      const float* const p = &borders.positions[3 * std::size_t{borders.indices[3 * t + c]}];
      ends[c] = {p[0], p[1]};
    }
    std::ranges::sort(ends);
    lines.insert({ends[0][0], ends[0][1], ends[1][0], ends[1][1]});
  }
  return lines;
}

const std::multiset<Line> sides{{0, 0, 1, 0}, {1, 0, 1, 1}, {0, 1, 1, 1}, {0, 0, 0, 1}};

TEST(FaceBorders, AreTheSidesOfAFace) {
  const Mesh borders = face_borders(square_face(), std::vector<std::uint32_t>{7, 7});
  EXPECT_EQ(borders.origin, (Vec3{3, 4, 5}));
  EXPECT_EQ(lines_of(borders), sides);
}

TEST(FaceBorders, LieWhereTwoFacesMeet) {
  std::multiset<Line> expected = sides;
  for (int k = 0; k < 2; ++k) expected.insert(Line{0, 0, 1, 1});
  EXPECT_EQ(lines_of(face_borders(square_face(), std::vector<std::uint32_t>{7, 2})), expected);
}

TEST(FaceBorders, IgnoreTrianglesWithoutArea) {
  Mesh mesh = square_face();
  mesh.indices.insert(mesh.indices.end(), {0, 3, 4});  // two corners in one place, on the diagonal
  EXPECT_EQ(lines_of(face_borders(mesh, std::vector<std::uint32_t>{7, 7, 7})), sides);
}

TEST(FaceBorders, AreNotAlongSeams) {
  // A tetrahedron without vertices in common is one closed face.
  constexpr float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr std::size_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  Mesh mesh;
  for (const auto& face : faces) {
    for (const std::size_t corner : face) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
      mesh.positions.insert(mesh.positions.end(), corners[corner], corners[corner] + 3);
    }
  }
  EXPECT_EQ(face_borders(mesh, std::vector<std::uint32_t>{0, 0, 0, 0}).triangle_count(), 0u);
  EXPECT_EQ(face_borders(mesh, std::vector<std::uint32_t>{0, 0, 0, 1}).triangle_count(), 6u);
  EXPECT_EQ(face_borders(Mesh(), {}).triangle_count(), 0u);
}

}}  // namespace tessera::render
