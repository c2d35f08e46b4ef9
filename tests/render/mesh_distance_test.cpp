// Compares distances to meshes with those to each triangle, one by one.

#include "render/mesh_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random_patches.h"
#include "support/triangle_distance.h"

namespace tessera::test { namespace {

Mesh random_mesh(Random& random, std::size_t triangles) {
  Mesh mesh;
  mesh.origin = {10, -20, 5};
  for (std::size_t k = 0; k < 3 * triangles; ++k) {
    const Vec3 p = (k / 3 % 7 == 0 ? 0.1 : 1.0) * uniform_vector(random, -1, 1);
    for (const double x : {p.x, p.y, p.z}) mesh.positions.push_back(static_cast<float>(x));
    mesh.indices.push_back(static_cast<std::uint32_t>(k % 11 == 0 ? k / 2 : k));  // some needles and points
  }
  return mesh;
}

TEST(MeshDistance, IsThatToTheNearestTriangle) {
  Random random(4);
  for (const std::size_t triangles : {1u, 3u, 5u, 100u, 1000u}) {
    const Mesh mesh = random_mesh(random, triangles);
    const auto distance = render::MeshDistance::make(mesh);
    ASSERT_TRUE(distance.ok());
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = mesh.origin + uniform_vector(random, -2, 2);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        Vec3 corner[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const float* at = &mesh.positions[3 * mesh.indices[3 * t + c]];
          corner[c] = mesh.origin + Vec3{double(at[0]), double(at[1]), double(at[2])};
        }
        least = std::min(least, distance_to_triangle(p, corner[0], corner[1], corner[2]));
      }
      EXPECT_NEAR(distance->distance(p, 100), least, 1e-12);
      EXPECT_EQ(distance->distance(p, 0.5 * least), 0.5 * least);
      const auto nearest = distance->nearest(p, 100);
      ASSERT_TRUE(nearest);
      EXPECT_NEAR(length(*nearest - p), least, 1e-12);
      EXPECT_LT(distance->distance(*nearest, 100), 1e-12);  // it is a point of the mesh
      EXPECT_FALSE(distance->nearest(p, 0.5 * least));
    }
  }
}

/// The corners of a needle lie on a line but for rounding, so its normal points anywhere.
TEST(MeshDistance, NeedlesAreNoNearerThanTheirLongestEdge) {
  Random random(6);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 a = uniform_vector(random, -1, 1), b = uniform_vector(random, -1, 1);
    const double share = 0.1 + 0.8 * uniform(random, 0, 1);
    const Vec3 c = a + share * (b - a);
    Mesh mesh;
    mesh.positions.resize(9);
    mesh.model_positions = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    mesh.indices = {0, 1, 2};
    const auto distance = render::MeshDistance::make(mesh);
    ASSERT_TRUE(distance.ok());
    const Vec3 normal = normalized(cross(b - a, c - a));
    const Vec3 p = c + uniform(random, -1, 1) * (k % 2 == 0 ? normal : uniform_vector(random, -1, 1));
    EXPECT_NEAR(distance->distance(p, 100), distance_to_segment(p, a, b), 1e-15);
  }
}

TEST(MeshDistance, RefusesWhatIsNoMesh) {
  Random random(5);
  Mesh mesh = random_mesh(random, 4);
  mesh.indices[5] = 12;
  EXPECT_EQ(render::MeshDistance::make(mesh).status().message(), "triangle 1 has vertex 12, there are 12");
  mesh.indices[5] = 5;
  mesh.positions[15] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(render::MeshDistance::make(mesh).status().code(), StatusCode::non_finite);
  mesh.indices.clear();
  EXPECT_EQ(render::MeshDistance::make(mesh).status().code(), StatusCode::invalid_argument);
}

}}  // namespace tessera::test
