// Meshes for a GPU: tangents, ranges of surfaces, short indices and clusters.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/sampled_distance.h"
#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"
#include "tessera/convert.h"
#include "tessera/gpu_mesh.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

Vec3 vector_at(const std::vector<float>& of, std::size_t vertex, std::size_t stride = 3) {
  return {double(of[stride * vertex]), double(of[stride * vertex + 1]), double(of[stride * vertex + 2])};
}

TEST(Tangents, RunAlongUForAllKindsOfParameters) {
  for (const bool shares : {false, true})
    for (const VertexParameters kind : {VertexParameters::surface, VertexParameters::unit, VertexParameters::patch}) {
      if (shares && kind == VertexParameters::patch) continue;
      std::vector<PatchSource> sources;
      const std::vector<BezierPatch> patches = wavy_field(4, 4);
      for (std::uint32_t k = 0; k < patches.size(); ++k) {
        const double u = k / 4, v = k % 4;
        sources.push_back({.surface = 0, .domain = {u, u + 1, v, v + 1}});
      }
      const PatchSet set = good(PatchSet::make(patches, PatchSetOptions{.sources = sources}));
      TessellationOptions options{.tolerance = 0.01, .parameters = kind};
      if (shares) options.joining = {.crease_angle = 0.5, .share_vertices = true};
      const Mesh mesh = mesh_of(set, good(Tessellation::make(set, options)));
      const std::vector<float> found = good(tangents(mesh, set, kind));
      ASSERT_EQ(found.size(), 4 * mesh.vertex_count());
      for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
        const Vec3 t = vector_at(found, k, 4), n = vector_at(mesh.normals, k);
        EXPECT_NEAR(length(t), 1, 1e-6);
        EXPECT_NEAR(dot(t, n), 0, 1e-6);
        EXPECT_EQ(found[4 * k + 3], 1);
        // u of this field grows with x alone, and v with y.
        EXPECT_GT(t.x, 0.5);
        EXPECT_NEAR(dot(t, normalized(cross(Vec3{0, 1, 0}, n))), 1, 1e-5);  // r_u has no y
        EXPECT_GT(cross(n, t).y, 0);
      }
    }
}

TEST(Tangents, OfASphereFollowItsCircles) {
  const PatchSet set = good(make_patch_set(good(to_bezier(good(make_nurbs_sphere({}, 2))))));
  const Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.01})));
  const std::vector<float> found = good(tangents(mesh, set, VertexParameters::surface));
  std::size_t poles = 0;
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const Vec3 p = vector_at(mesh.positions, k) + mesh.origin, t = vector_at(found, k, 4);
    EXPECT_NEAR(length(t), 1, 1e-5);
    EXPECT_NEAR(dot(t, p), 0, 1e-3);
    const double around = std::hypot(p.x, p.y);
    poles += around < 1e-5;
    const double along_circle = around > 1e-2 ? std::abs(t.x * -p.y + t.y * p.x) / around : 1;
    EXPECT_NEAR(along_circle, 1, 1e-3);
  }
  EXPECT_GT(poles, 0u);
}

TEST(Tangents, WrongMeshesAreRefused) {
  const PatchSet set = set_of(wavy_field(2, 2));
  Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.01})));
  const auto refused = [&](const Mesh& wrong, VertexParameters kind, const std::string& message,
                           StatusCode code = StatusCode::invalid_argument) {
    const Status status = tangents(wrong, set, kind).status();
    EXPECT_EQ(status.code(), code);
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
  };
  Mesh bare = mesh;
  bare.normals.clear();
  refused(bare, VertexParameters::patch, "need a mesh with parameters and normals");
  Mesh far = mesh;
  far.parameters[7] = 3;
  refused(far, VertexParameters::patch, "are its parameters of this kind");
  far.parameters[7] = std::nanf("");
  refused(far, VertexParameters::patch, "vertex 3 lies at");
  Mesh without = mesh;
  without.patches.clear();
  refused(without, VertexParameters::patch, "0 patches for ", StatusCode::count_mismatch);
  without = mesh, without.patches[5] = 9;
  refused(without, VertexParameters::patch, "triangle 5 is of patch 9, there are 4");
  without = mesh, without.indices[4] = 1'000'000;
  refused(without, VertexParameters::patch, "triangle 1 has the vertex 1000000");
}

TEST(SurfaceRanges, HoldTheirFacesBoxesAndBounds) {
  const std::vector<BezierPatch> patches = wavy_field(6, 3);
  std::vector<PatchSource> sources;
  for (std::size_t k = 0; k < patches.size(); ++k) sources.push_back({.surface = static_cast<std::uint32_t>(k / 6)});
  const PatchSet set = good(PatchSet::make(patches, PatchSetOptions{.sources = sources}));
  for (const bool quads : {false, true}) {
    const Tessellation plan = good(Tessellation::make(set, {.surface_tolerances = {0.001, 0.1, 0.01}, .quads = quads}));
    const Mesh mesh = mesh_of(set, plan);
    const std::vector<MeshRange> ranges = good(surface_ranges(mesh, set, plan.bounds()));
    ASSERT_EQ(ranges.size(), 3u);
    std::size_t triangles = 0, faces_of_four = 0, vertices = 0;
    for (const MeshRange& range : ranges) {
      EXPECT_EQ(range.first_triangle, triangles);
      EXPECT_EQ(range.first_quad, faces_of_four);
      EXPECT_EQ(range.first_vertex, vertices);  // not shared
      triangles += range.triangle_count, faces_of_four += range.quad_count, vertices += range.vertex_count;
      EXPECT_LE(range.bound, range.surface == 0 ? 0.001 : range.surface == 1 ? 0.1 : 0.01);
      EXPECT_GT(range.bound, 0);
      for (std::size_t k = 3 * range.first_triangle; k < 3 * (range.first_triangle + range.triangle_count); ++k) {
        EXPECT_EQ(set.source(mesh.patches[k / 3]).surface, range.surface);
        EXPECT_GE(mesh.indices[k], range.first_vertex);
        EXPECT_LT(mesh.indices[k], range.first_vertex + range.vertex_count);
        const Vec3 p = vector_at(mesh.positions, mesh.indices[k]) + mesh.origin;
        EXPECT_TRUE(p.x >= range.box.lower.x && p.x <= range.box.upper.x && p.z <= range.box.upper.z);
      }
    }
    EXPECT_EQ(triangles, mesh.triangle_count());
    EXPECT_EQ(faces_of_four, mesh.quad_count());
    EXPECT_EQ(vertices, mesh.vertex_count());
    EXPECT_TRUE(std::isinf(good(surface_ranges(mesh, set, {}))[0].bound));
    EXPECT_EQ(surface_ranges(mesh, set, plan.bounds().first(3)).status().code(), StatusCode::count_mismatch);
  }
}

TEST(ShortIndices, AreTheSameNumbersOrAnError) {
  const PatchSet set = set_of(wavy_field(4, 4));
  const Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.01})));
  const std::vector<std::uint16_t> indices = good(short_indices(mesh));
  EXPECT_TRUE(std::equal(indices.begin(), indices.end(), mesh.indices.begin(), mesh.indices.end()));
  const Mesh large = mesh_of(set, good(Tessellation::make(set, {.rates = UniformRates{64, 64}})));
  EXPECT_EQ(short_indices(large).status().code(), StatusCode::unsupported);
}

/// Misses per triangle of a cache that holds the last vertices that entered it.
double misses(const Mesh& mesh, std::size_t cache) {
  std::vector<std::uint32_t> held;
  std::size_t count = 0;
  for (const std::uint32_t vertex : mesh.indices) {
    if (std::ranges::find(held, vertex) != held.end()) continue;
    ++count;
    held.push_back(vertex);
    if (held.size() > cache) held.erase(held.begin());
  }
  return static_cast<double>(count) / static_cast<double>(mesh.triangle_count());
}

TEST(CacheOrder, KeepsTrianglesAndPartsWithFewerMisses) {
  const PatchSet set = set_of(wavy_field(6, 6));
  for (const bool shares : {false, true}) {
    Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 2e-4, .joining = {.share_vertices = shares}})));
    for (const std::size_t k : {0, 1, 2}) {
      const std::size_t third = mesh.triangle_count() / 3;
      mesh.parts.push_back({.name = "part",
                            .first_triangle = k * third,
                            .triangle_count = k == 2 ? mesh.triangle_count() - 2 * third : third});
    }
    Mesh ordered = mesh;
    ASSERT_TRUE(order_for_vertex_cache(ordered).ok());
    const auto triangles = [](const Mesh& of, const MeshPart& part) {
      std::vector<std::array<std::uint32_t, 4>> all;
      for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
        all.push_back({of.indices[3 * t], of.indices[3 * t + 1], of.indices[3 * t + 2], of.patches[t]});
      std::ranges::sort(all);
      return all;
    };
    for (const MeshPart& part : mesh.parts) EXPECT_EQ(triangles(mesh, part), triangles(ordered, part));
    EXPECT_LE(misses(ordered, 16), (shares ? 0.70 : 0.78));
    EXPECT_GE(misses(mesh, 16), 1.15 * misses(ordered, 16));
  }
}

TEST(CacheOrder, WrongOnesAreRefused) {
  const PatchSet set = set_of(wavy_field(2, 2));
  const Mesh mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.01})));
  Mesh wrong = mesh;
  EXPECT_EQ(order_for_vertex_cache(wrong, 2).code(), StatusCode::invalid_argument);
  wrong.indices[7] = 1'000'000;
  EXPECT_EQ(order_for_vertex_cache(wrong).code(), StatusCode::invalid_argument);
  wrong = mesh, wrong.patches.pop_back();
  EXPECT_EQ(order_for_vertex_cache(wrong).code(), StatusCode::count_mismatch);
  wrong = mesh, wrong.parts.push_back({.name = "part", .first_triangle = 5, .triangle_count = mesh.triangle_count()});
  EXPECT_EQ(order_for_vertex_cache(wrong).code(), StatusCode::invalid_argument);
  wrong = mesh, wrong.parts = {{.name = "b", .first_triangle = 4, .triangle_count = 4},
                               {.name = "a", .first_triangle = 2, .triangle_count = 4}};
  EXPECT_EQ(order_for_vertex_cache(wrong).code(), StatusCode::invalid_argument);
  EXPECT_EQ(wrong.indices, mesh.indices);
  Mesh none;
  EXPECT_TRUE(order_for_vertex_cache(none).ok());
}

/// Checks that clusters hold each triangle once, with all that is said of them.
void expect_sound(const Mesh& mesh, std::span<const float> bounds, const MeshClusters& made,
                  const ClusterOptions& options) {
  std::vector<std::uint8_t> seen(mesh.triangle_count(), 0);
  std::size_t triangles = 0, vertices = 0;
  for (const MeshCluster& cluster : made.clusters) {
    EXPECT_EQ(cluster.first_triangle, triangles);
    EXPECT_EQ(cluster.first_vertex, vertices);
    EXPECT_GE(cluster.triangle_count, 1u);
    EXPECT_LE(cluster.triangle_count, static_cast<std::uint32_t>(options.max_triangles));
    EXPECT_LE(cluster.vertex_count, static_cast<std::uint32_t>(options.max_vertices));
    triangles += cluster.triangle_count, vertices += cluster.vertex_count;
    for (std::size_t k = cluster.first_triangle; k < triangles; ++k) {
      const std::uint32_t t = made.triangles[k];
      EXPECT_EQ(seen[t]++, 0);
      Vec3 corner[3];
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_LT(made.corners[3 * k + c], cluster.vertex_count);
        const std::uint32_t vertex = made.vertices[cluster.first_vertex + made.corners[3 * k + c]];
        EXPECT_EQ(vertex, mesh.indices[3 * t + c]);
        corner[c] = vector_at(mesh.positions, vertex) + mesh.origin;
        Box3 grown = cluster.box;
        grown.extend(corner[c]);
        EXPECT_EQ(grown.diagonal(), cluster.box.diagonal());
      }
      const Vec3 n = cross(corner[1] - corner[0], corner[2] - corner[0]);
      const double along = length(n) > 0 ? dot(n, cluster.axis) / length(n) : 1;
      EXPECT_LE(std::acos(std::clamp(along, -1.0, 1.0)), cluster.spread + 1e-6);
      EXPECT_GE(cluster.bound, bounds.empty() ? 0 : double(bounds[mesh.patches[t]]));
    }
  }
  EXPECT_EQ(triangles, mesh.triangle_count());
  EXPECT_EQ(vertices, made.vertices.size());
}

TEST(Clusters, HoldEachTriangleOnceWithBoxConeAndBound) {
  for (const bool is_body : {false, true})
    for (const bool shares : {false, true}) {
      const PatchSet set = set_of(is_body ? closed_body() : wavy_field(6, 6));
      const Tessellation plan =
          good(Tessellation::make(set, {.tolerance = 1e-3, .joining = {.share_vertices = shares}}));
      const Mesh mesh = mesh_of(set, plan);
      for (const ClusterOptions& options : {ClusterOptions{}, {.max_triangles = 64, .max_vertices = 48}, {1, 3}}) {
        const MeshClusters made = good(make_clusters(mesh, plan.bounds(), options));
        expect_sound(mesh, plan.bounds(), made, options);
        if (options.max_triangles != 128) continue;
        // Nearly full, compact, and flat enough to be culled.
        EXPECT_LE(made.clusters.size(), mesh.triangle_count() / 128 + mesh.triangle_count() / 600 + 2);
        double spread = 0;
        for (const MeshCluster& cluster : made.clusters) spread += cluster.spread;
        EXPECT_LE(spread / static_cast<double>(made.clusters.size()), 0.6);
        for (const MeshCluster& cluster : made.clusters) EXPECT_LE(cluster.bound, 1e-3);
      }
      expect_sound(mesh, {}, good(make_clusters(mesh, {})), {});
    }
}

TEST(Clusters, DifficultMeshes) {
  // Triangles in one place, and without area: halves by number.
  Mesh mesh;
  for (int k = 0; k < 1000; ++k) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    for (const float x : {0.0f, 1.0f, 0.5f}) mesh.positions.insert(mesh.positions.end(), {x, k % 2 == 0 ? 0.0f : x, 0});
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
  }
  expect_sound(mesh, {}, good(make_clusters(mesh, {})), {});
  EXPECT_TRUE(good(make_clusters(Mesh(), {})).clusters.empty());
  const auto refused = [&](const Mesh& wrong, std::span<const float> bounds, const ClusterOptions& options) {
    return make_clusters(wrong, bounds, options).status().code();
  };
  EXPECT_EQ(refused(mesh, {}, {.max_triangles = 0}), StatusCode::invalid_argument);
  EXPECT_EQ(refused(mesh, {}, {.max_vertices = 257}), StatusCode::invalid_argument);
  const std::vector<float> bounds(3, 1.0f);
  EXPECT_EQ(refused(mesh, bounds, {}), StatusCode::count_mismatch);
  mesh.indices[0] = 3000;
  EXPECT_EQ(refused(mesh, {}, {}), StatusCode::invalid_argument);
  mesh.indices[0] = 0;
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(make_clusters(mesh, {}, {}, {.cancel = &cancel}).status().code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
