// Vertices and normals that neighbours share, and quads: the same triangles as without, with other numbers.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <oneapi/tbb/global_control.h>

#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

Tessellation plan_of(const PatchSet& set, const TessellationOptions& options) {
  return good(Tessellation::make(set, options));
}

std::vector<BezierPatch> joined_vertices_turned(std::vector<BezierPatch> patches, std::uint64_t seed) {
  Random random(seed);
  for (BezierPatch& patch : patches) patch = reoriented(patch, static_cast<int>(random() % 8));
  return patches;
}

/// Neighbours that differ by rounding.
std::vector<BezierPatch> torn(const std::vector<BezierPatch>& whole, double by) {
  Random random(5);
  std::vector<BezierPatch> patches;
  for (const BezierPatch& patch : whole) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = p + uniform_vector(random, -by, by);
    patches.push_back(patch.with_points(points).value());
  }
  return patches;
}

/// The patches of a bicubic B-spline surface: every join is C2.
std::vector<BezierPatch> smooth_field() {
  Random random(8);
  std::vector<Vec3> points;
  std::vector<double> knots;
  for (int k = 0; k < 12; ++k) knots.push_back(k);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) points.push_back({double(i), double(j), uniform(random, -1, 1)});
  const BSplineSurface surface = good(BSplineSurface::polynomial(3, knots, 3, knots, points));
  const PatchGrid grid = good(to_bezier(surface));
  return {grid.patches().begin(), grid.patches().end()};
}

/// Two walls that meet at a right angle.
std::vector<BezierPatch> roof() {
  const auto wall = [](const Vec3& far) {
    std::vector<Vec3> points;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) points.push_back(0.5 * i * Vec3{0, 1, 0.2 * i} + 0.5 * j * far);
    return points;
  };
  const std::vector<Vec3> left = wall({1, 0, 0}), right = wall({0, 0, 1});
  std::vector<Vec3> mirrored;  // so that both look outwards
  for (int i = 0; i < 3; ++i)
    for (int j = 2; j >= 0; --j) mirrored.push_back(right[static_cast<std::size_t>(3 * i + j)]);
  return {polynomial(2, 2, left), polynomial(2, 2, mirrored)};
}

/// A sphere all of whose octants look outwards.
std::vector<BezierPatch> round_sphere() {
  std::vector<BezierPatch> patches = sphere();
  for (BezierPatch& patch : patches)
    if (dot(unit_normal(patch, 0.5, 0.5).direction, de_casteljau(patch, 0.5, 0.5)) < 0) patch = reoriented(patch, 2);
  return patches;
}

using Place = std::array<float, 3>;
Place place_of(const std::vector<float>& of, std::size_t vertex) {
  return {of[3 * vertex], of[3 * vertex + 1], of[3 * vertex + 2]};
}

/// The values at the corners of the triangles, in order.
std::vector<Place> corners(const Mesh& mesh, const std::vector<float>& of) {
  std::vector<Place> places;
  for (const std::uint32_t k : mesh.indices) places.push_back(place_of(of, k));
  return places;
}

struct Case {
  const char* name;
  std::vector<BezierPatch> patches;
  double weld = 0;
};
std::vector<Case> cases() {
  return {{"field", wavy_field(7, 6)},
          {"body", closed_body()},
          {"turned body", joined_vertices_turned(closed_body(), 2)},
          {"sphere", sphere()},
          {"torn sphere", torn(sphere(), 1e-7), 1e-5},
          {"torn body", torn(joined_vertices_turned(closed_body(), 4), 1e-5), 1e-3},
          {"smooth", smooth_field()},
          {"apart", mixed_patches(3, 30)}};
}

TEST(SharedVertices, TheSameTrianglesWithEachPlaceOnce) {
  for (const Case& c : cases())
    for (const double relative : {0.3, 0.03, 0.003, 3e-4}) {
      const PatchSet set = set_of(c.patches);
      TessellationOptions options{.tolerance = relative, .relative = true, .joining = {.weld = c.weld}};
      const Mesh apart = mesh_of(set, plan_of(set, options));
      options.joining.share_vertices = true;
      const Tessellation plan = plan_of(set, options);
      const Mesh mesh = mesh_of(set, plan);
      EXPECT_TRUE(mesh.normals.empty());
      EXPECT_EQ(corners(mesh, mesh.positions), corners(apart, apart.positions)) << c.name << " " << relative;
      EXPECT_EQ(mesh.patches, apart.patches);
      const MeshReport report = good(check(mesh));
      if (std::string(c.name) != "apart") {
        EXPECT_EQ(report.vertices, report.distinct_positions) << c.name << " " << relative;
      }
      EXPECT_TRUE(mesh.parameters.empty());
    }
}

TEST(SharedVertices, NormalsNeedACreaseAngle) {
  const PatchSet set = set_of(closed_body());
  const Tessellation plan = plan_of(set, {.tolerance = 0.01, .joining = {.share_vertices = true}});
  Mesh mesh = good(plan.allocate());
  mesh.normals.resize(mesh.positions.size());
  const Status status = plan.run(set, mesh.views());
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_NE(status.message().find("need a crease angle"), std::string::npos);
  for (const double angle : {-0.1, 4.0, std::nan("")})
    EXPECT_EQ(Tessellation::make(set, {.tolerance = 0.01, .joining = {.crease_angle = angle}}).status().code(),
              StatusCode::invalid_argument);
}

/// How many places have more than one normal.
std::size_t creased_places(const Mesh& mesh) {
  std::map<Place, Place> normals;
  std::map<Place, bool> creased;
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const Place at = place_of(mesh.positions, k), normal = place_of(mesh.normals, k);
    const auto [known, fresh] = normals.emplace(at, normal);
    if (!fresh && known->second != normal) creased[at] = true;
  }
  return creased.size();
}

TEST(JoinedNormals, OneNormalAcrossSmoothJoinsAndAllAroundPoles) {
  for (const auto& patches : {smooth_field(), round_sphere(), torn(round_sphere(), 1e-7)}) {
    const PatchSet set = set_of(patches);
    TessellationOptions options{.tolerance = 0.003, .joining = {.weld = 1e-5}};
    const Mesh plain = mesh_of(set, plan_of(set, options));
    EXPECT_GT(creased_places(plain), 0u);
    options.joining.crease_angle = 0.01;
    const Mesh joined = mesh_of(set, plan_of(set, options));
    EXPECT_EQ(creased_places(joined), 0u);
    EXPECT_EQ(joined.positions, plain.positions);
    EXPECT_EQ(joined.indices, plain.indices);
    double most = 0;
    for (std::size_t k = 0; k < plain.normals.size(); ++k)
      most = std::max(most, std::abs(double(plain.normals[k]) - double(joined.normals[k])));
    EXPECT_LE(most, 1e-4);
    options.joining.share_vertices = true;
    const Mesh shared = mesh_of(set, plan_of(set, options));
    const MeshReport report = good(check(shared));
    EXPECT_EQ(report.vertices, report.distinct_positions);
    EXPECT_EQ(corners(shared, shared.positions), corners(plain, plain.positions));
    EXPECT_EQ(corners(shared, shared.normals), corners(joined, joined.normals));
  }
}

TEST(JoinedNormals, CreasesStay) {
  const PatchSet set = set_of(roof());
  TessellationOptions options{.tolerance = 0.001};
  const Mesh plain = mesh_of(set, plan_of(set, options));
  const std::size_t border = creased_places(plain);
  EXPECT_GT(border, 2u);
  for (const bool share : {false, true})
    for (const double angle : {0.0, 0.5, 1.5}) {
      options.joining.share_vertices = share;
      options.joining.crease_angle = angle;
      const Mesh creased = mesh_of(set, plan_of(set, options));
      EXPECT_EQ(creased.positions, plain.positions);
      EXPECT_EQ(creased.normals, plain.normals);
      EXPECT_EQ(creased.indices, plain.indices);
    }
  options.joining.crease_angle = 1.6;
  options.joining.share_vertices = false;
  EXPECT_EQ(creased_places(mesh_of(set, plan_of(set, options))), 0u);
  options.joining.share_vertices = true;
  EXPECT_EQ(mesh_of(set, plan_of(set, options)).vertex_count(), plain.vertex_count() - border);
}

TEST(JoinedNormals, ThoseOfPatchesTurnedAgainstEachOtherStay) {
  std::vector<BezierPatch> patches = smooth_field();
  patches[7] = reoriented(patches[7], 1);  // one parameter runs the other way
  const PatchSet set = set_of(patches);
  const Mesh mesh = mesh_of(set, plan_of(set, {.tolerance = 0.003, .joining = {.crease_angle = 0.01}}));
  const MeshReport report = good(check(mesh));
  EXPECT_EQ(report.flipped_triangles, 0u);
  EXPECT_GT(creased_places(mesh), 0u);
  EXPECT_EQ(report.inconsistent_edges, creased_places(mesh));  // the ring around it
}

TEST(JoinedNormals, ThePointOfAConeKeepsItsNormals) {
  std::vector<Vec3> points(3, Vec3{0, 0, 1});
  for (const double x : {1.0, 0.0, -1.0}) points.push_back({x, 1 - 0.5 * x * x, 0});
  const PatchSet set = set_of({polynomial(1, 2, points)});
  const Mesh plain = mesh_of(set, plan_of(set, {.tolerance = 1e-3}));
  EXPECT_EQ(mesh_of(set, plan_of(set, {.tolerance = 1e-3, .joining = {.crease_angle = 0.1}})).normals, plain.normals);
}

TEST(SharedVertices, TheSameBytesForAnyNumberOfThreads) {
  const PatchSet set = set_of(joined_vertices_turned(wavy_field(20, 20), 6));
  Mesh first;
  for (const std::size_t threads : {1u, 2u, 8u}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    const Mesh mesh =
        mesh_of(set, plan_of(set, {.tolerance = 0.01, .joining = {.crease_angle = 0.1, .share_vertices = true}}));
    if (threads == 1) first = mesh;
    EXPECT_EQ(mesh.positions, first.positions);
    EXPECT_EQ(mesh.normals, first.normals);
    EXPECT_EQ(mesh.indices, first.indices);
  }
}

TEST(SharedVertices, LongRings) {
  std::vector<Vec3> points;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 2; ++j) points.push_back({i / 15.0, double(j), i % 2 == 0 ? -0.5 : 0.5});
  const PatchSet set = set_of({polynomial(15, 1, points)});
  TessellationOptions options{.tolerance = 5e-6, .parameters = VertexParameters::surface};
  const Mesh plain = mesh_of(set, plan_of(set, options));
  ASSERT_GT(plain.vertex_count(), 6200u);  // two thirds in the ring: more than 4096
  options.joining.crease_angle = 0.1;
  options.joining.share_vertices = true;
  const Mesh shared = mesh_of(set, plan_of(set, options));
  EXPECT_EQ(shared.positions, plain.positions);
  EXPECT_EQ(shared.normals, plain.normals);
  EXPECT_EQ(shared.parameters, plain.parameters);
  EXPECT_EQ(shared.indices, plain.indices);
}

TEST(Quads, CellsAreQuadsAndTheRestIsStrips) {
  for (const Case& c : cases())
    for (const bool share : {false, true}) {
      const PatchSet set = set_of(c.patches);
      TessellationOptions options{
          .tolerance = 0.003, .relative = true, .joining = {.weld = c.weld, .share_vertices = share}};
      const Tessellation plain = plan_of(set, options);
      const Mesh mesh = mesh_of(set, plain);
      options.quads = true;
      const Tessellation plan = plan_of(set, options);
      const MeshCapacity size = plan.capacity();
      EXPECT_GT(size.quads, 0u);
      EXPECT_EQ(size.triangles + 2 * size.quads, plain.capacity().triangles);
      EXPECT_EQ(size.vertices, plain.capacity().vertices);
      Mesh strips = good(plan.allocate());
      std::vector<std::uint32_t> quads(4 * size.quads), quad_patch(size.quads);
      MeshViews views = strips.views();
      views.quads = quads;
      views.quad_patch = quad_patch;
      const Status status = plan.run(set, views);
      ASSERT_TRUE(status.ok()) << status.message();
      EXPECT_EQ(strips.positions, mesh.positions);
      EXPECT_EQ(strips.normals, mesh.normals);
      // A patch's triangles come patch by patch: first its strips, then its cells.
      std::vector<std::uint32_t> indices, patches;
      std::size_t t = 0, q = 0;
      for (std::uint32_t k = 0; k < set.patch_count(); ++k) {
        for (; t < size.triangles && strips.patches[t] == k; ++t) {
          indices.insert(indices.end(), strips.indices.begin() + std::ptrdiff_t(3 * t),
                         strips.indices.begin() + std::ptrdiff_t(3 * t + 3));
          patches.push_back(k);
        }
        for (; q < size.quads && quad_patch[q] == k; ++q) {
          const std::uint32_t* at = &quads[4 * q];
          indices.insert(indices.end(), {at[0], at[1], at[2], at[0], at[2], at[3]});
          patches.insert(patches.end(), 2, k);
        }
      }
      EXPECT_EQ(indices, mesh.indices) << c.name;
      EXPECT_EQ(patches, mesh.patches);
      views.quads = views.quads.first(quads.size() - 1);
      EXPECT_EQ(plan.run(set, views).code(), StatusCode::buffer_too_small);
    }
}

}}  // namespace tessera::test
