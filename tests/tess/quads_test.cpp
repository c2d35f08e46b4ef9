// Quads: whole cells are faces of four corners, and the mesh otherwise equals one of triangles.

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>

#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

Mesh quads_of(const PatchSet& set, const Tessellation& plan, const Execution& execution = {}) {
  Mesh mesh = good(plan.allocate());
  const Status status = plan.run(set, mesh.views(), execution);
  EXPECT_TRUE(status.ok()) << status.message();
  return mesh;
}

/// Patch and corners of each triangle, in their order.
std::vector<std::array<std::uint32_t, 4>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 4>> triangles;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    triangles.push_back({mesh.patches[t], mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Expects that the faces of a plan with these options and quads are those of its triangles.
void expect_the_same(const PatchSet& set, TessellationOptions options) {
  options.quads = false;
  const Tessellation plain = good(Tessellation::make(set, options));
  const Mesh triangles = mesh_of(set, plain);
  options.quads = true;
  const Tessellation plan = good(Tessellation::make(set, options));
  const Mesh mesh = quads_of(set, plan);
  const MeshCapacity size = plan.capacity();
  EXPECT_EQ(plain.capacity().quads, 0u);
  EXPECT_EQ(mesh.quad_count(), size.quads);
  EXPECT_EQ(mesh.quad_patches.size(), size.quads);
  EXPECT_EQ(mesh.triangle_count(), size.triangles);
  EXPECT_EQ(size.triangles + 2 * size.quads, plain.capacity().triangles);
  EXPECT_EQ(mesh.positions, triangles.positions);
  EXPECT_EQ(mesh.normals, triangles.normals);
  EXPECT_EQ(mesh.parameters, triangles.parameters);
  const Mesh split = good(split_quads(mesh));
  EXPECT_TRUE(split.quads.empty() && split.quad_patches.empty());
  EXPECT_EQ(triangles_of(split), triangles_of(triangles));
  MeshReport with = good(check(mesh)), without = good(check(triangles));
  EXPECT_EQ(with.quads, size.quads);
  EXPECT_EQ(with.triangles, without.triangles);
  EXPECT_EQ(with.open_edges, without.open_edges);
  EXPECT_EQ(with.degenerate_triangles, without.degenerate_triangles);
  EXPECT_EQ(with.flipped_triangles, without.flipped_triangles);
  EXPECT_EQ(with.t_junctions, without.t_junctions);
}

TEST(Quads, OfCertifiedMeshesAreTheirInnerCells) {
  for (const auto& patches : {closed_body(), sphere(), wavy_field(3, 4), mixed_patches(2, 40)})
    for (const bool share : {false, true}) {
      const PatchSet set = set_of(patches);
      const TessellationOptions options{
          .tolerance = 0.003, .relative = true, .joining = {.share_vertices = share}, .quads = true};
      EXPECT_GT(good(Tessellation::make(set, options)).capacity().quads, 0u);
      expect_the_same(set, options);
    }
}

TEST(Quads, OfUniformMeshesAreAllCellsButThoseAtPoles) {
  for (const auto& patches : {closed_body(), sphere(), mixed_patches(2, 40)})
    for (const auto& [u, v] : {std::pair{1, 1}, {1, 5}, {4, 1}, {2, 2}, {6, 3}}) {
      const PatchSet set = set_of(patches);
      expect_the_same(set, {.rates = UniformRates{u, v}});
    }
  const PatchSet set = set_of(closed_body());
  const auto plan = good(Tessellation::make(set, {.rates = UniformRates{4, 4}, .quads = true}));
  EXPECT_EQ(plan.capacity().quads, 6u * 16u);
  EXPECT_EQ(plan.capacity().triangles, 0u);
  EXPECT_TRUE(good(check(quads_of(set, plan))).closed());
}

TEST(Quads, NoneWhereAllCellsAreInStrips) {
  const PatchSet set = set_of(closed_body());
  const auto plan = good(Tessellation::make(set, {.tolerance = 5, .quads = true}));
  EXPECT_EQ(plan.capacity().quads, 0u);
  EXPECT_EQ(quads_of(set, plan).indices, mesh_of(set, good(Tessellation::make(set, {.tolerance = 5}))).indices);
}

/// Corners go around a box of the parameters, and the patch's bound holds for the halves by either diagonal.
TEST(Quads, KeepTheBoundByEitherDiagonal) {
  const PatchSet set = set_of(closed_body());
  const auto plan = good(Tessellation::make(set, {.tolerance = 0.01, .quads = true}));
  const Mesh mesh = quads_of(set, plan);
  ASSERT_GT(mesh.quad_count(), 100u);
  double most = 0;
  for (std::size_t k = 0; k < mesh.quad_count(); ++k) {
    const std::uint32_t* const corner = &mesh.quads[4 * k];
    const auto u = [&](std::size_t c) { return mesh.parameters[2 * corner[c]]; };
    const auto v = [&](std::size_t c) { return mesh.parameters[2 * corner[c] + 1]; };
    EXPECT_TRUE(u(0) == u(3) && u(1) == u(2) && u(0) < u(1) && v(0) == v(1) && v(2) == v(3) && v(0) < v(3)) << k;
    if (k % 5 != 0) continue;
    for (const std::array<std::size_t, 3>& half :
         {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}) {
      MeshTriangle triangle;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = corner[half[c]];
        triangle.parameters[c] = {mesh.parameters[2 * at], mesh.parameters[2 * at + 1]};
        triangle.corners[c] =
            mesh.origin + Vec3{mesh.positions[3 * at], mesh.positions[3 * at + 1], mesh.positions[3 * at + 2]};
      }
      const std::uint32_t patch = mesh.quad_patches[k];
      const double far = largest_distance(set.patch(patch), triangle, 0.1, 400).low;
      EXPECT_LE(far, plan.bounds()[patch]) << "quad " << k;
      most = std::max(most, far / plan.bounds()[patch]);
    }
  }
  EXPECT_GT(most, 0.2);  // it is the same surface
}

TEST(Quads, TheSameBytesForAnyNumberOfThreads) {
  const PatchSet set = set_of(mixed_patches(4, 300));
  const auto plan = good(Tessellation::make(set, {.tolerance = 0.01, .relative = true, .quads = true}));
  const auto uniform = good(Tessellation::make(set, {.rates = UniformRates{5, 4}, .quads = true}));
  const Mesh certified_mesh = quads_of(set, plan), uniform_mesh = quads_of(set, uniform);
  for (const std::size_t threads : {1u, 2u, 5u})
    for (const Stores stores : {Stores::plain, Stores::streaming}) {
      const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      const auto expect_same = [](const Mesh& mesh, const Mesh& wanted) {
        EXPECT_EQ(mesh.positions, wanted.positions);
        EXPECT_EQ(mesh.normals, wanted.normals);
        EXPECT_EQ(mesh.indices, wanted.indices);
        EXPECT_EQ(mesh.patches, wanted.patches);
        EXPECT_EQ(mesh.quads, wanted.quads);
        EXPECT_EQ(mesh.quad_patches, wanted.quad_patches);
      };
      expect_same(quads_of(set, plan, {.stores = stores}), certified_mesh);
      expect_same(quads_of(set, uniform, {.stores = stores}), uniform_mesh);
    }
}

void expect_bad_views_are_refused(const PatchSet& set, const Tessellation& plan) {
  Mesh mesh = good(plan.allocate());
  std::fill(mesh.quads.begin(), mesh.quads.end(), 7u);
  std::fill(mesh.positions.begin(), mesh.positions.end(), 7.0f);
  const Mesh clean = mesh;
  const auto refused = [&](StatusCode code, const std::string& message, auto change) {
    MeshViews views = mesh.views();
    change(views);
    const Status status = plan.run(set, views);
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
    EXPECT_EQ(mesh.quads, clean.quads);
    EXPECT_EQ(mesh.positions, clean.positions);
  };
  const std::string wanted = std::to_string(4 * plan.capacity().quads);
  refused(StatusCode::buffer_too_small, wanted + " are needed",
          [](MeshViews& views) { views.quads = views.quads.first(views.quads.size() - 1); });
  refused(StatusCode::buffer_too_small, "the quads view holds 1 indices",
          [](MeshViews& views) { views.quads = views.quads.first(1); });
  refused(StatusCode::buffer_too_small, "quad patch",
          [](MeshViews& views) { views.quad_patch = views.quad_patch.first(views.quad_patch.size() - 1); });
  refused(StatusCode::buffer_too_small, wanted + " are needed", [](MeshViews& views) { views.quads = {}; });
  refused(StatusCode::invalid_argument, "quad", [](MeshViews& views) { views.quad_patch = views.quads; });
}

TEST(Quads, BadViewsAreRefused) {
  const PatchSet set = set_of(sphere());
  expect_bad_views_are_refused(set, good(Tessellation::make(set, {.tolerance = 0.01, .quads = true})));
  expect_bad_views_are_refused(set, good(Tessellation::make(set, {.rates = UniformRates{4, 4}, .quads = true})));
}

TEST(Quads, ViewsOfQuadsNeedAPlanOfQuads) {
  const PatchSet set = set_of(sphere());
  std::vector<std::uint32_t> quads(100000, 7u);
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.01}, TessellationOptions{.rates = UniformRates{4, 4}}}) {
    const Tessellation plan = good(Tessellation::make(set, options));
    Mesh mesh = good(plan.allocate());
    const Mesh clean = mesh;
    MeshViews views = mesh.views();
    views.quads = quads;
    EXPECT_EQ(plan.run(set, views).code(), StatusCode::invalid_argument);
    EXPECT_EQ(mesh.positions, clean.positions);
    EXPECT_EQ(quads, std::vector<std::uint32_t>(100000, 7u));
  }
}

Mesh cube() {
  Mesh mesh;
  for (int k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis) mesh.positions.push_back(static_cast<float>(k >> axis & 1));
  mesh.quads = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  return mesh;
}

TEST(Quads, CheckKnowsThem) {
  MeshReport report = good(check(cube()));
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.quads, 6u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.inconsistent_edges, 0u);
  Mesh mesh = cube();
  mesh.quads.resize(20);
  mesh.indices = {1, 3, 7};
  report = good(check(mesh));
  EXPECT_EQ(report.open_edges, 3u);  // the quad's other half is missing
  EXPECT_EQ(report.triangles, 11u);
  mesh = cube();
  std::swap(mesh.quads[1], mesh.quads[3]);
  EXPECT_EQ(good(check(mesh)).inconsistent_edges, 4u);
  mesh = cube();
  mesh.quads[3] = mesh.quads[2];
  EXPECT_EQ(good(check(mesh)).degenerate_triangles, 1u);
  const auto error_of = [](auto change) {
    Mesh bad = cube();
    change(bad);
    return check(bad).status().message();
  };
  EXPECT_EQ(error_of([](Mesh& m) { m.quads[9] = 8; }), "corner 1 of quad 2 is vertex 8, the mesh has 8");
  EXPECT_EQ(error_of([](Mesh& m) { m.quads.pop_back(); }), "23 indices are not four per quad");
  EXPECT_EQ(error_of([](Mesh& m) { m.quad_patches = {1}; }), "1 patch for 6 quads");
}

TEST(Quads, AreSplitPartByPart) {
  Mesh mesh = cube();
  mesh.indices = {0, 1, 2, 1, 2, 3};
  mesh.patches = {5, 6};
  mesh.quad_patches = {5, 5, 6, 6, 6, 6};
  mesh.parts = {{"a", 0, 1, 0, 2}, {"b", 1, 1, 2, 4}, {"c", 2, 0}};
  const Mesh split = good(split_quads(mesh));
  EXPECT_EQ(split.triangle_count(), 14u);
  EXPECT_EQ(split.patches, (std::vector<std::uint32_t>{5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 6}));
  EXPECT_EQ(std::vector(split.indices.begin(), split.indices.begin() + 9),
            (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 3, 1}));
  ASSERT_EQ(split.parts.size(), 3u);
  EXPECT_EQ(split.parts[1].name, "b");
  EXPECT_EQ(split.parts[1].first_triangle, 5u);
  EXPECT_EQ(split.parts[1].triangle_count, 9u);
  EXPECT_EQ(split.parts[1].quad_count, 0u);
  const auto code_of = [&](auto change) {
    Mesh bad = mesh;
    change(bad);
    return split_quads(bad).status().code();
  };
  EXPECT_EQ(code_of([](Mesh& m) { m.parts[1].first_quad = 1; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Mesh& m) { m.parts[1].quad_count = ~std::size_t{0}; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Mesh& m) { m.parts.pop_back(), m.parts.pop_back(); }), StatusCode::count_mismatch);
  EXPECT_EQ(code_of([](Mesh& m) { m.quads.pop_back(); }), StatusCode::count_mismatch);
  mesh.quad_patches.clear();
  EXPECT_TRUE(good(split_quads(mesh)).patches.empty());
}

}}  // namespace tessera::test
