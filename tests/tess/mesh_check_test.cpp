// check() on meshes made by hand, each with one defect.

#include <limits>

#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  return mesh;
}

MeshReport report_of(const Mesh& mesh) { return good(check(mesh)); }

void expect_error(const Mesh& mesh, const char* message, std::ptrdiff_t index = Status::no_index) {
  const Result<MeshReport> result = check(mesh);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(result.status().message(), message);
  EXPECT_EQ(result.status().index(), index);
}

TEST(MeshCheck, SoundTetrahedron) {
  const MeshReport report = report_of(tetrahedron());
  EXPECT_EQ(report.vertices, 4u);
  EXPECT_EQ(report.distinct_positions, 4u);
  EXPECT_EQ(report.triangles, 4u);
  EXPECT_EQ(report.open_edges, 0u);
  EXPECT_EQ(report.non_manifold_edges, 0u);
  EXPECT_EQ(report.inconsistent_edges, 0u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_EQ(report.non_finite_vertices, 0u);
  EXPECT_TRUE(report.closed());
}

TEST(MeshCheck, EmptyMesh) {
  const MeshReport report = report_of({});
  EXPECT_EQ(report.triangles, 0u);
  EXPECT_FALSE(report.closed());
}

TEST(MeshCheck, DuplicatedVerticesAreWelded) {
  const Mesh shared = tetrahedron();
  Mesh mesh;
  for (const std::uint32_t k : shared.indices) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float x = shared.positions[3 * k + c];
      mesh.positions.push_back(x == 0 && mesh.indices.size() % 2 ? -0.0f : x);  // 0 and -0 are one place
    }
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
  }
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.vertices, 12u);
  EXPECT_EQ(report.distinct_positions, 4u);
  EXPECT_TRUE(report.closed());
  mesh.positions[0] = std::nextafter(mesh.positions[0], 1.0f);  // bits decide, not distance
  EXPECT_EQ(report_of(mesh).distinct_positions, 5u);
  EXPECT_EQ(report_of(mesh).open_edges, 4u);
}

TEST(MeshCheck, OpenEdges) {
  Mesh mesh = tetrahedron();
  mesh.indices.resize(9);
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.open_edges, 3u);
  EXPECT_EQ(report.inconsistent_edges, 0u);
  EXPECT_FALSE(report.closed());
}

TEST(MeshCheck, NonManifoldEdge) {
  Mesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {-1, -1, -1});
  mesh.indices.insert(mesh.indices.end(), {0, 1, 4});
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_EQ(report.open_edges, 2u);
  EXPECT_FALSE(report.closed());
}

TEST(MeshCheck, InconsistentEdges) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.indices[0], mesh.indices[1]);
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.inconsistent_edges, 3u);
  EXPECT_TRUE(report.closed());
}

TEST(MeshCheck, DegenerateTrianglesAndTheirEdges) {
  Mesh mesh = tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {0, 0, 0, 0.5, 0, 0, 2, 0, 0});
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1});           // one vertex twice
  mesh.indices.insert(mesh.indices.end(), {0, 4, 1});           // two vertices in one place
  mesh.indices.insert(mesh.indices.end(), {0, 5, 6, 6, 5, 0});  // on one line, both ways
  const MeshReport report = report_of(mesh);
  EXPECT_EQ(report.degenerate_triangles, 4u);
  EXPECT_EQ(report.open_edges, 0u);
  EXPECT_TRUE(report.closed());
}

/// A square of two triangles, beside it one of three whose border has a vertex more.
TEST(MeshCheck, TJunctions) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 1, 0.25f, 0};
  mesh.indices = {0, 1, 2, 0, 2, 3, 1, 4, 6, 6, 4, 5, 6, 5, 2};
  EXPECT_EQ(report_of(mesh).t_junctions, 1u);
  EXPECT_EQ(report_of(mesh).open_edges, 9u);
  mesh.indices.insert(mesh.indices.end(), {2, 1, 6});  // a line that closes the gap
  EXPECT_EQ(report_of(mesh).t_junctions, 0u);
  EXPECT_EQ(report_of(mesh).open_edges, 6u);
  EXPECT_EQ(report_of(mesh).degenerate_triangles, 1u);
  mesh.positions[18] = 1.001f;  // a crack, seen as open edges
  EXPECT_EQ(report_of(mesh).t_junctions, 0u);
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(report_of(mesh).t_junctions, 0u);
}

TEST(MeshCheck, TJunctionsAmongManyEdges) {
  // Separate triangles in a row along x; each has a corner in the middle of the next one's long edge.
  Mesh mesh;
  for (std::uint32_t k = 0; k < 2000; ++k) {
    const float x = static_cast<float>(k);
    mesh.positions.insert(mesh.positions.end(), {x, -1, 0, x + 1, 0, 0, x, 1, 0});
    mesh.indices.insert(mesh.indices.end(), {3 * k, 3 * k + 1, 3 * k + 2});
  }
  EXPECT_EQ(report_of(mesh).t_junctions, 1999u);
}

TEST(MeshCheck, FlippedTriangles) {
  Mesh mesh = tetrahedron();
  mesh.normals = {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(report_of(mesh).flipped_triangles, 0u);
  std::swap(mesh.indices[0], mesh.indices[1]);
  EXPECT_EQ(report_of(mesh).flipped_triangles, 1u);
}

TEST(MeshCheck, TinyTrianglesAreNotDegenerate) {
  Mesh mesh;
  mesh.positions = {1, 1, 1, 1 + 0x1p-23f, 1, 1, 1, 1 + 0x1p-23f, 1};
  mesh.indices = {0, 1, 2};
  EXPECT_EQ(report_of(mesh).degenerate_triangles, 0u);
  mesh.positions = {0, 0, 0, 1e-30f, 0, 0, 0, 1e-30f, 0};
  EXPECT_EQ(report_of(mesh).degenerate_triangles, 0u);
}

TEST(MeshCheck, NonFiniteVertices) {
  Mesh mesh = tetrahedron();
  mesh.normals.assign(12, 0.0f);
  mesh.positions[4] = std::numeric_limits<float>::quiet_NaN();
  mesh.normals[5] = std::numeric_limits<float>::infinity();  // of the same vertex
  mesh.normals[9] = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(report_of(mesh).non_finite_vertices, 2u);
  EXPECT_EQ(report_of(mesh).distinct_positions, 4u);
  EXPECT_TRUE(report_of(mesh).closed());
}

TEST(MeshCheck, RefusesIndicesOutOfRange) {
  Mesh mesh = tetrahedron();
  mesh.indices[7] = 4;
  expect_error(mesh, "corner 1 of triangle 2 is vertex 4, the mesh has 4", 7);
  mesh.indices[7] = 0xFFFFFFFF;
  expect_error(mesh, "corner 1 of triangle 2 is vertex 4294967295, the mesh has 4", 7);
}

TEST(MeshCheck, RefusesCountsThatDontFit) {
  Mesh mesh = tetrahedron();
  mesh.positions.pop_back();
  expect_error(mesh, "11 numbers in positions are not three per vertex");
  mesh = tetrahedron();
  mesh.indices.push_back(0);
  expect_error(mesh, "13 indices are not three per triangle");
  mesh = tetrahedron();
  mesh.normals.resize(9);
  expect_error(mesh, "9 numbers in normals, 12 in positions");
  mesh = tetrahedron();
  mesh.parameters.resize(9);
  expect_error(mesh, "9 numbers in parameters for 4 vertices");
  mesh = tetrahedron();
  mesh.patches.resize(3);
  expect_error(mesh, "3 patches for 4 triangles");
}

TEST(MeshCheck, TorusGridIsClosed) {
  constexpr std::uint32_t n = 120, m = 70;
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double a = 6.283185307179586 * i / n, b = 6.283185307179586 * j / m, r = 2 + std::cos(b);
      for (const double x : {r * std::cos(a), r * std::sin(a), std::sin(b)})
        mesh.positions.push_back(static_cast<float>(x));
      const std::uint32_t k = i * m + j, right = (i + 1) % n * m + j, up = i * m + (j + 1) % m,
                          both = (i + 1) % n * m + (j + 1) % m;
      mesh.indices.insert(mesh.indices.end(), {k, right, both, k, both, up});
    }
  MeshReport report = report_of(mesh);
  EXPECT_EQ(report.distinct_positions, std::size_t{n * m});
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.inconsistent_edges, 0u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  mesh.indices.resize(mesh.indices.size() - 3);
  report = report_of(mesh);
  EXPECT_EQ(report.open_edges, 3u);
}

}}  // namespace tessera::test
