// The contents of a tessellation, for patches without poles.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>

#include "support/reference.h"
#include "support/ulp.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

std::vector<BezierPatch> random_patches(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < count; ++k)
    patches.push_back(k % 2 ? random_polynomial(random, 1 + k % 7, 1 + k % 5) : random_rational(random, 1 + k % 4, 3));
  return patches;
}

/// Twice the signed area of a triangle in its patch's parameters.
double parameter_area(const Mesh& mesh, std::size_t triangle) {
  const auto at = [&](std::size_t corner, std::size_t c) {
    return double{mesh.parameters[2 * mesh.indices[3 * triangle + corner] + c]};
  };
  return (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
}

TEST(Tessellation, CountsFollowTheFormula) {
  const std::vector<BezierPatch> patches = random_patches(1, 20);
  const PatchSet set = set_of(patches);
  for (const auto& [u, v] : {std::pair{1, 1}, {1, 2}, {2, 1}, {2, 3}, {3, 5}, {4, 4}, {5, 1}, {7, 33}, {31, 2}}) {
    const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{u, v}}));
    EXPECT_EQ(plan.capacity().vertices, 20u * static_cast<std::size_t>((u + 1) * (v + 1)));
    EXPECT_EQ(plan.capacity().triangles, 20u * static_cast<std::size_t>(2 * u * v));
    const Mesh mesh = good(plan.allocate());
    EXPECT_EQ(mesh.vertex_count(), plan.capacity().vertices);
    EXPECT_EQ(mesh.triangle_count(), plan.capacity().triangles);
    EXPECT_EQ(mesh.origin, set.origin());
  }
}

TEST(Tessellation, TrianglesCoverEachPatchOnce) {
  for (const auto& [u, v] : {std::pair{1, 1}, {2, 3}, {4, 4}, {5, 1}, {3, 17}}) {
    const Mesh mesh = tessellate(random_patches(2, 70), u, v);
    const std::size_t grid = static_cast<std::size_t>((u + 1) * (v + 1));
    std::vector<double> covered(70);
    for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
      EXPECT_GT(parameter_area(mesh, k), 0);  // counter-clockwise in (u,v), so seen from where r_u x r_v points
      covered[mesh.patches[k]] += 0.5 * parameter_area(mesh, k);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(mesh.indices[3 * k + c] / grid, mesh.patches[k]);
    }
    for (const double area : covered) EXPECT_NEAR(area, 1, 1e-5);  // parameters are rounded to float
    EXPECT_EQ(good(check(mesh)).inconsistent_edges, 0u);
    EXPECT_EQ(good(check(mesh)).open_edges, 70u * static_cast<std::size_t>(2 * (u + v)));
  }
}

TEST(Tessellation, VerticesLieWhereTheirParametersSay) {
  const std::vector<BezierPatch> patches = random_patches(3, 40);
  const PatchSet set = set_of(patches);
  const int rate_u = 5, rate_v = 3;
  const Mesh mesh = tessellate(set, rate_u, rate_v);
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (int i = 0; i <= rate_u; ++i)
      for (int j = 0; j <= rate_v; ++j) {
        const std::size_t k =
            (p * (rate_u + 1) + static_cast<std::size_t>(i)) * (rate_v + 1) + static_cast<std::size_t>(j);
        EXPECT_EQ(mesh.parameters[2 * k], static_cast<float>(i / 5.0));
        EXPECT_EQ(mesh.parameters[2 * k + 1], static_cast<float>(j / 3.0));
        const Vec3 position{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
        const double unit = float_unit * largest_coefficient(patches[p], set.origin());
        const Vec3 expected = reference_position(patches[p], i / 5.0, j / 3.0) - set.origin();
        EXPECT_TRUE(within_units(position, expected, unit, patches[p].is_rational() ? 4 : 2))
            << p << " " << i << " " << j;
        const Vec3 normal{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
        EXPECT_LT(max_abs(normal - reference_normal(patches[p], i / 5.0, j / 3.0)), 1e-3) << p << " " << i << " " << j;
      }
}

TEST(Tessellation, FacesLookWhereNormalsPoint) {
  // A dome, so that no facet turns over.
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({i / 3.0, j / 3.0, (i % 3 == 0 || j % 3 == 0) ? 0.0 : 0.3});
  const BezierPatch dome = polynomial(3, 3, points);
  for (int way = 0; way < 8; ++way) {
    const BezierPatch patch = reoriented(dome, way);
    const Mesh mesh = tessellate({patch}, 4, 3);
    for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
      const auto vector = [&](const std::vector<float>& values, std::size_t corner) {
        const float* p = &values[3 * mesh.indices[3 * k + corner]];
        return Vec3{p[0], p[1], p[2]};
      };
      const Vec3 a = vector(mesh.positions, 0);
      const Vec3 face = cross(vector(mesh.positions, 1) - a, vector(mesh.positions, 2) - a);
      for (std::size_t corner = 0; corner < 3; ++corner) EXPECT_GT(dot(face, vector(mesh.normals, corner)), 0) << way;
    }
  }
}

TEST(Tessellation, WritesToAnyLayout) {
  const PatchSet set = set_of(mixed_patches(4, 37));
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{3, 4}}));
  Mesh expected = good(plan.allocate());
  ASSERT_TRUE(plan.run(set, expected.views()).ok());
  const std::size_t vertices = plan.capacity().vertices;

  std::vector<float> interleaved(8 * vertices);
  std::vector<std::uint32_t> indices(3 * plan.capacity().triangles);
  MeshViews views;
  views.position = View3<float>::interleaved(interleaved, 8, 0);
  views.normal = View3<float>::interleaved(interleaved, 8, 3);
  views.parameter = View2<float>::interleaved(interleaved, 8, 6);
  views.indices = indices;
  ASSERT_TRUE(plan.run(set, views).ok());
  EXPECT_EQ(indices, expected.indices);
  for (std::size_t k = 0; k < vertices; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(interleaved[8 * k + c], expected.positions[3 * k + c]);
      EXPECT_EQ(interleaved[8 * k + 3 + c], expected.normals[3 * k + c]);
    }
    for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(interleaved[8 * k + 6 + c], expected.parameters[2 * k + c]);
  }

  std::array<std::vector<float>, 3> soa;
  for (std::vector<float>& array : soa) array.resize(vertices);
  MeshViews least;  // positions and indices alone
  least.position = View3<float>::soa({std::span(soa[0]), std::span(soa[1]), std::span(soa[2])});
  least.indices = indices;
  ASSERT_TRUE(plan.run(set, least).ok());
  for (std::size_t k = 0; k < vertices; ++k)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(soa[c][k], expected.positions[3 * k + c]);
}

TEST(Tessellation, SameBytesForAnyNumberOfThreads) {
  const PatchSet set = set_of(mixed_patches(5, 700));
  for (const int rate : {1, 4, 9}) {
    Mesh one, two;
    tbb::task_arena(1).execute([&] { one = tessellate(set, rate, rate + 1); });
    tbb::task_arena(2).execute([&] { two = tessellate(set, rate, rate + 1); });
    EXPECT_EQ(one.positions, two.positions);
    EXPECT_EQ(one.normals, two.normals);
    EXPECT_EQ(one.parameters, two.parameters);
    EXPECT_EQ(one.patches, two.patches);
    EXPECT_EQ(one.indices, two.indices);
  }
}

TEST(Tessellation, WeightsOfAnySize) {
  Random random(9);
  const std::vector<Vec3> points = random_points(random, 3, 3);
  const std::vector<double> weights = random_weights(random, 3, 3, 0.5, 2);
  const auto scaled = [&](double factor) {
    std::vector<double> product = weights;
    for (double& w : product) w *= factor;
    return rational(3, 3, points, product);
  };
  const Mesh expected = tessellate({scaled(1)}, 4, 4);
  for (const double factor : {0x1p-900, 0x1p-150, 0x1p-30, 0x1p10, 0x1p140, 0x1p900}) {
    EXPECT_EQ(tessellate({scaled(factor)}, 4, 4).positions, expected.positions) << factor;
    EXPECT_EQ(tessellate({scaled(factor)}, 4, 4).normals, expected.normals) << factor;
  }
  std::vector<double> far_apart = weights;
  far_apart[0] = 1e-10;  // float cannot hold its fourth power beside the others
  const Result<PatchSet> set = PatchSet::make(std::vector{rational(3, 3, points, far_apart)});
  EXPECT_EQ(set.status().code(), StatusCode::non_finite);
  far_apart[0] = 3e-9;
  const BezierPatch patch = rational(3, 3, points, far_apart);
  const Mesh mesh = tessellate({patch}, 4, 4);
  EXPECT_EQ(good(check(mesh)).non_finite_vertices, 0u);
  const Vec3 normal{mesh.normals[0], mesh.normals[1], mesh.normals[2]};
  EXPECT_LT(max_abs(normal - unit_normal(patch, 0, 0).direction), 1e-4);
}

TEST(Tessellation, EditsThatKeepThePolesNeedNoNewPlan) {
  std::vector<BezierPatch> patches = random_patches(6, 20);
  PatchSet set = set_of(patches);
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{4, 4}}));
  Mesh mesh = good(plan.allocate());
  Random random(7);
  const std::vector<Vec3> points = random_points(random, patches[3].degree_u(), patches[3].degree_v(), {}, 0.5);
  ASSERT_TRUE(set.set_control_points(3, points).ok());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  EXPECT_EQ(mesh.positions, tessellate(set, 4, 4).positions);
}

TEST(Tessellation, TellsProgressAndWhatItDid) {
  const PatchSet set = set_of(mixed_patches(8, 500));
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{}}));
  Mesh mesh = good(plan.allocate());
  std::vector<double> told;
  ExecutionReport report;
  Execution execution;
  execution.progress = [&](double done) { told.push_back(done); };
  execution.report = &report;
  ASSERT_TRUE(plan.run(set, mesh.views(), execution).ok());
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  EXPECT_GT(report.tasks, 1u);
  EXPECT_EQ(report.isa, good(default_isa()));
}

}}  // namespace tessera::test
