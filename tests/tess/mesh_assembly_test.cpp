// Meshes of shapes in many places: their places in one mesh, with normals, turns of faces, parts and colours.

#include "tessera/mesh_assembly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/synthetic_sets.h"
#include "tessera/tessellation.h"

namespace tessera { namespace {

using test::value_of;

/// A closed ball of radius 1 around (0, 0, 0), with normals that point outward.
Mesh ball(const TessellationOptions& options = {.tolerance = 0.01}) {
  const PatchSet set = value_of(PatchSet::make(test::sphere()));
  const Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  return mesh;
}

MeshAssembly one(Mesh mesh, const Affine& placement) {
  return {.shapes = {{.name = "ball", .mesh = std::move(mesh)}}, .instances = {{.placement = placement}}};
}

Vec3 at(const std::vector<float>& values, std::size_t k) {
  return {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}
Vec3 vertex(const Mesh& mesh, std::size_t k) { return mesh.origin + at(mesh.positions, k); }

/// Six times the volume that the triangles enclose.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3)
    sum += dot(at(mesh.positions, mesh.indices[k]),
               cross(at(mesh.positions, mesh.indices[k + 1]), at(mesh.positions, mesh.indices[k + 2])));
  return sum / 6;
}

TEST(MeshAssemblies, VerticesGoWhereThePlacementTakesThem) {
  const Mesh mesh = ball();
  const Affine turned = Affine::translated({3, 4, 5}) * Affine::rotated({1, 2, 3}, 0.7);
  const Affine stretched{.columns = {Vec3{2, 0, 0}, Vec3{1, 3, 0}, Vec3{0, 0, 0.5}}, .translation = {-7, 0, 1}};
  MeshAssembly assembly = one(mesh, turned);
  assembly.instances.push_back({.placement = stretched});
  const Mesh flat = value_of(flatten(assembly));
  ASSERT_EQ(flat.vertex_count(), 2 * mesh.vertex_count());
  ASSERT_EQ(flat.triangle_count(), 2 * mesh.triangle_count());
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    EXPECT_LE(length(vertex(flat, k) - turned.point(vertex(mesh, k))), 2e-6);
    EXPECT_LE(length(vertex(flat, mesh.vertex_count() + k) - stretched.point(vertex(mesh, k))), 2e-6);
    // The gradient of |M^-1 (p - t)|^2 at the placed point is the normal of the placed ball.
    const Vec3 n = at(flat.normals, mesh.vertex_count() + k), p = at(mesh.normals, k);
    EXPECT_NEAR(length(n), 1, 1e-6);
    for (const Vec3& tangent : {cross(p, {1, 0, 0}), cross(p, {0, 1, 0}), cross(p, {0, 0, 1})})
      EXPECT_NEAR(dot(n, stretched.vector(tangent)), 0, 1e-5);
    EXPECT_GT(dot(n, stretched.vector(p)), 0);
  }
  EXPECT_EQ(flat.parameters.size(), 2 * flat.vertex_count());
  EXPECT_EQ(value_of(check(flat)).flipped_triangles, 0u);
  EXPECT_TRUE(value_of(check(flat)).closed());
}

TEST(MeshAssemblies, MirroredFacesTurnAround) {
  for (const bool quads : {false, true}) {
    const Mesh mesh = ball({.tolerance = 0.01, .quads = quads});
    ASSERT_EQ(mesh.quad_count() > 0, quads);
    const Mesh flat = value_of(flatten(one(mesh, Affine::scaled({1, 1, -2}))));
    EXPECT_EQ(flat.quad_count(), mesh.quad_count());
    EXPECT_NEAR(volume(value_of(split_quads(flat))), 2 * volume(value_of(split_quads(mesh))), 1e-4);
    EXPECT_EQ(value_of(check(flat)).flipped_triangles, 0u);
    EXPECT_TRUE(value_of(check(flat)).closed());
  }
}

TEST(MeshAssemblies, TheOriginKeepsFarPartsExact) {
  const Mesh mesh = ball();
  MeshAssembly assembly = one(mesh, Affine::translated({1e7, 2e7, -3e7}));
  assembly.instances.push_back({.placement = Affine::translated({1e7 + 4, 2e7, -3e7})});
  const Mesh flat = value_of(flatten(assembly));
  EXPECT_LE(length(flat.origin - Vec3{1e7 + 2, 2e7, -3e7}), 1e-6);
  for (std::size_t k = 0; k < flat.vertex_count(); ++k) {
    const MeshInstance& instance = assembly.instances[k / mesh.vertex_count()];
    const Vec3 expected = instance.placement.point(vertex(mesh, k % mesh.vertex_count()));
    EXPECT_LE(length(vertex(flat, k) - expected), 3.1 * std::exp2(-24) + 1e-8);  // half the box's diagonal is 3.3
  }
}

TEST(MeshAssemblies, ASingleInstanceThatIsNotMovedKeepsItsMesh) {
  Mesh mesh = ball();
  mesh.origin = {0.1, 0.2, 0.3};
  const Mesh flat = value_of(flatten(one(mesh, {})));
  EXPECT_EQ(flat.origin, mesh.origin);
  EXPECT_EQ(flat.positions, mesh.positions);
  EXPECT_EQ(flat.normals, mesh.normals);
  EXPECT_EQ(flat.patches, mesh.patches);
  EXPECT_EQ(flat.indices, mesh.indices);
}

TEST(MeshAssemblies, PositionsInDoubleAreThoseOfThePlacement) {
  const Mesh mesh = ball({.tolerance = 0.01, .precision = Precision::double_precision});
  const Affine far = Affine::translated({1e9, 0, 0}) * Affine::rotated({0, 0, 1}, 1);
  MeshAssembly assembly = one(mesh, far);
  const Mesh flat = value_of(flatten(assembly));
  ASSERT_EQ(flat.model_positions.size(), mesh.model_positions.size());
  for (std::size_t k = 0; k < flat.vertex_count(); ++k) {
    const Vec3 p{mesh.model_positions[3 * k], mesh.model_positions[3 * k + 1], mesh.model_positions[3 * k + 2]};
    EXPECT_EQ((Vec3{flat.model_positions[3 * k], flat.model_positions[3 * k + 1], flat.model_positions[3 * k + 2]}),
              far.point(p));
  }
  assembly.shapes.push_back({.mesh = ball()});
  assembly.instances.push_back({.shape = 1});
  EXPECT_TRUE(value_of(flatten(assembly)).model_positions.empty());
}

TEST(MeshAssemblies, PartsHaveTheNamesAndColoursOfTheirInstances) {
  const Colour red{1, 0, 0}, blue{0, 0, 1};
  Mesh mesh = ball();
  const std::size_t triangles = mesh.triangle_count();
  mesh.parts = {{.name = "cap", .triangle_count = 3, .colour = red},
                {.name = "rest", .first_triangle = 3, .triangle_count = triangles - 3}};
  MeshAssembly assembly = one(mesh, {});
  assembly.instances[0].name = "left";
  assembly.instances.push_back({.placement = Affine::translated({5, 0, 0}), .colour = blue});
  mesh.parts.clear();
  assembly.shapes.push_back({.mesh = mesh});
  assembly.instances.push_back({.name = "whole", .shape = 1});
  const Mesh flat = value_of(flatten(assembly));
  ASSERT_EQ(flat.parts.size(), 5u);
  const char* const names[] = {"left/cap", "left/rest", "cap", "rest", "whole"};
  const std::optional<Colour> colours[] = {red, {}, red, blue, {}};
  std::size_t next = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(flat.parts[k].name, names[k]);
    EXPECT_EQ(flat.parts[k].colour, colours[k]) << k;
    EXPECT_EQ(flat.parts[k].first_triangle, next);
    next += flat.parts[k].triangle_count;
  }
  EXPECT_EQ(next, flat.triangle_count());
  assembly.instances.resize(1);
  EXPECT_EQ(value_of(flatten(assembly)).parts[1].name, "left/rest");
}

TEST(MeshAssemblies, AttributesThatSomeMeshesLackAreLeftOut) {
  MeshAssembly assembly = one(ball(), {});
  Mesh bare = ball();
  bare.normals.clear();
  assembly.shapes.push_back({.mesh = bare});
  assembly.shapes.push_back({.name = "empty"});  // has no attributes, and takes none away
  assembly.instances.push_back({.shape = 2});
  EXPECT_FALSE(value_of(flatten(assembly)).normals.empty());
  assembly.instances.push_back({.shape = 1});
  const Mesh flat = value_of(flatten(assembly));
  EXPECT_TRUE(flat.normals.empty());
  EXPECT_EQ(flat.parameters.size(), 2 * flat.vertex_count());
  EXPECT_EQ(value_of(flatten({})).vertex_count(), 0u);
}

TEST(MeshAssemblies, WrongOnesAreRefused) {
  MeshAssembly assembly = one(ball(), {});
  assembly.instances.push_back({.name = "lost", .shape = 1});
  Status status = flatten(assembly).status();
  EXPECT_EQ(status.message(), "instance 1 (lost): it is of shape 1, there are 1");
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.index(), 1);
  assembly.instances[1] = {.placement = Affine::translated({0, std::numeric_limits<double>::infinity(), 0})};
  EXPECT_EQ(flatten(assembly).status().message(), "instance 1: its placement is not finite");
  EXPECT_EQ(flatten(assembly).status().code(), StatusCode::non_finite);
  assembly.instances.pop_back();
  assembly.shapes[0].mesh.normals.pop_back();
  status = flatten(assembly).status();
  EXPECT_EQ(status.code(), StatusCode::count_mismatch);
  EXPECT_EQ(status.message(), "shape 0: the mesh's arrays have lengths that do not fit each other");
}

TEST(MeshAssemblies, ModelsGiveTheirInstances) {
  const Colour green{0, 1, 0};
  Model model;
  model.name = "pair";
  model.unit = "mm";
  model.shapes.resize(2);
  model.shapes[0].name = std::string("bolt");
  const Affine moved = Affine::translated({1, 2, 3});
  model.instances = {{.shape = 1}, {.name = std::string("bolt_2"), .placement = moved, .colour = green}};
  const MeshAssembly assembly = value_of(instances_of(model));
  EXPECT_EQ(assembly.name, "pair");
  EXPECT_EQ(assembly.unit, "mm");
  ASSERT_EQ(assembly.shapes.size(), 2u);
  EXPECT_EQ(assembly.shapes[0].name, "bolt");
  ASSERT_EQ(assembly.instances.size(), 2u);
  EXPECT_EQ(assembly.instances[0].shape, 1u);
  EXPECT_EQ(assembly.instances[1].name, "bolt_2");
  EXPECT_EQ(assembly.instances[1].placement, moved);
  EXPECT_EQ(assembly.instances[1].colour, green);
  model.instances[0].shape = 2;
  EXPECT_EQ(instances_of(model).status().message(), "instance 0: it is of shape 2, there are 2");
}

}}  // namespace tessera
