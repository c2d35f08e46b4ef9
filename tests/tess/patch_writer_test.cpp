// Checks certified meshes as they are written: in vectors of every instruction set, plainly or past the caches, into
// views of any layout; against the patches themselves and against the triangles written one by one.

#include "tess/write/patch_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/impl_access.h"
#include "kernel/table/kernel_table.h"
#include "support/synthetic_sets.h"
#include "tess/division_parameters.h"
#include "tess/plan/make_plan.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

Mesh patch_writer_mesh_of(const PatchSet& set, double tolerance, std::optional<Isa> isa = {},
                          Stores stores = Stores::automatic) {
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = tolerance, .isa = isa}));
  Mesh mesh = good(plan.allocate());
  ExecutionReport report;
  const Status status = plan.run(set, mesh.views(), {.stores = stores, .report = &report});
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(report.isa, isa ? *isa : good(default_isa()));
  const bool can_stream = kernel::kernels(report.isa).finish_lines != nullptr;
  EXPECT_TRUE(stores == Stores::automatic || report.streaming == (can_stream && stores == Stores::streaming));
  return mesh;
}

/// Sets with all paths of the kernels: bicubic, other degrees, rational, poles; rates from 1 to beyond a hundred.
std::vector<std::pair<PatchSet, double>> patch_writer_cases() {
  std::vector<std::pair<PatchSet, double>> all;
  for (const double tolerance : {0.1, 3e-3, 1e-4}) {
    all.emplace_back(set_of(closed_body()), tolerance);
    all.emplace_back(set_of(sphere()), tolerance);
  }
  for (const double tolerance : {0.3, 0.01}) all.emplace_back(set_of(mixed_patches(5, 40)), tolerance);
  all.emplace_back(set_of(wavy_field(9, 7)), 2e-3);
  return all;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.indices, b.indices);
}

TEST(PatchWriter, TheSameBytesOnEveryInstructionSetThatFuses) {
  for (const auto& [set, tolerance] : patch_writer_cases()) {
    std::optional<Mesh> first;
    for (const Isa isa : available_isas()) {
      const Mesh mesh = patch_writer_mesh_of(set, tolerance, isa);
      const MeshReport report = good(check(mesh));
      EXPECT_EQ(report.non_manifold_edges, 0u);
      EXPECT_EQ(report.non_finite_vertices, 0u);
      if (isa == Isa::sse2) continue;
      if (first) expect_equal(mesh, *first);
      if (!first) first = mesh;
    }
  }
}

TEST(PatchWriter, StreamingAndPlainStoresGiveTheSameBytes) {
  for (const auto& [set, tolerance] : patch_writer_cases())
    for (const Isa isa : available_isas())
      expect_equal(patch_writer_mesh_of(set, tolerance, isa, Stores::streaming),
                   patch_writer_mesh_of(set, tolerance, isa, Stores::plain));
}

TEST(PatchWriter, EveryLayoutHoldsTheSameNumbersAndNothingElseIsTouched) {
  const PatchSet set = set_of(wavy_field(9, 7));
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 2e-3}));
  const Mesh mesh = patch_writer_mesh_of(set, 2e-3);
  const std::size_t vertices = plan.capacity().vertices, indices = 3 * plan.capacity().triangles;
  const float untouched = -1.5e33f;
  for (const Stores stores : {Stores::plain, Stores::streaming})
    for (const std::size_t shift : {1u, 5u, 16u})
      for (const std::size_t record : {3u, 7u}) {
        std::vector<float> positions(shift + record * vertices + 16, untouched), normals = positions;
        std::vector<std::uint32_t> triangles(shift + indices + 16, 77777777u);
        MeshViews views;
        views.position = View3<float>::interleaved(std::span(positions).subspan(shift), record);
        views.normal = View3<float>::interleaved(std::span(normals).subspan(shift), record);
        views.indices = std::span(triangles).subspan(shift, indices);
        ASSERT_TRUE(plan.run(set, views, {.stores = stores}).ok());
        std::size_t wrong = 0, touched = 0;
        for (std::size_t k = 0; k < vertices; ++k)
          for (std::size_t c = 0; c < 3; ++c) {
            wrong += positions[shift + k * record + c] != mesh.positions[3 * k + c];
            wrong += normals[shift + k * record + c] != mesh.normals[3 * k + c];
          }
        for (std::size_t k = 0; k < indices; ++k) wrong += triangles[shift + k] != mesh.indices[k];
        for (std::size_t k = 0; k < positions.size(); ++k) {
          const bool inside = k >= shift && k < shift + record * vertices && (k - shift) % record < 3;
          touched += !inside && (positions[k] != untouched || normals[k] != untouched);
        }
        for (std::size_t k = 0; k < triangles.size(); ++k)
          touched += (k < shift || k >= shift + indices) && triangles[k] != 77777777u;
        EXPECT_EQ(wrong, 0u) << shift << " " << record;
        EXPECT_EQ(touched, 0u) << shift << " " << record;
      }
}

/// Vertices of 32 bytes, position, normal and uv, take stores of their own. Other records with a gap do as well.
TEST(PatchWriter, VerticesHoldTheSameNumbersAndNothingElseIsTouched) {
  const float untouched = -1.5e33f;
  for (const auto& [set, tolerance] : patch_writer_cases()) {
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = tolerance}));
    Mesh mesh = good(plan.allocate());
    ASSERT_TRUE(plan.run(set, mesh.views()).ok());
    std::vector<std::uint32_t> indices(mesh.indices.size());
    for (const std::size_t record : {7u, 8u, 11u})
      for (const std::size_t shift : {0u, 3u}) {
        std::vector<float> memory(shift + record * mesh.vertex_count() + 8, untouched), expected = memory;
        const std::span<float> all = std::span(memory).subspan(shift, record * mesh.vertex_count());
        MeshViews views;
        views.position = View3<float>::interleaved(all, record, 0);
        views.normal = View3<float>::interleaved(all, record, 3);
        if (record > 7) views.parameter = View2<float>::interleaved(all, record, 6);
        views.indices = indices;
        ASSERT_TRUE(plan.run(set, views).ok());
        for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
          float* const vertex = expected.data() + shift + record * k;
          std::copy_n(mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, vertex);
          std::copy_n(mesh.normals.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, vertex + 3);
          if (record > 7) std::copy_n(mesh.parameters.begin() + static_cast<std::ptrdiff_t>(2 * k), 2, vertex + 6);
        }
        EXPECT_EQ(std::memcmp(memory.data(), expected.data(), memory.size() * sizeof(float)), 0) << record << shift;
      }
  }
}

TEST(PatchWriter, PositionsAloneAreThoseWithNormals) {
  for (const auto& [set, tolerance] : patch_writer_cases()) {
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = tolerance}));
    Mesh mesh = good(plan.allocate());
    MeshViews views = mesh.views();
    views.normal = {};
    ASSERT_TRUE(plan.run(set, views).ok());
    EXPECT_EQ(mesh.positions, patch_writer_mesh_of(set, tolerance).positions);
  }
}

/// On a border that is a point, each vertex has the limit of the patch's normal along its parameter, corners too.
TEST(PatchWriter, VerticesAtPolesHaveTheNormalsOfTheirLimits) {
  std::size_t at_poles = 0, corners = 0;
  double most = 0;
  for (const std::uint64_t seed : {5, 6, 7}) {
    const PatchSet set = set_of(mixed_patches(seed, 40));  // every fifth is a point at u = 0
    const Mesh mesh = patch_writer_mesh_of(set, 0.02);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t k = mesh.indices[3 * t + corner];
        const double u = mesh.parameters[2 * k], v = mesh.parameters[2 * k + 1];
        if (mesh.patches[t] % 5 != 0 || u != 0) continue;
        const SurfaceJet jet = evaluate_jet(impl_of(set).patches[mesh.patches[t]], 1e-7, v);
        const Vec3 area = cross(jet.du, jet.dv);
        if (!(length(area) > 1e-2 * length(jet.du) * length(jet.dv))) continue;
        most = std::max(most, length(Vec3{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]} -
                                     normalized(area)));
        ++at_poles;
        corners += v == 0 || v == 1;
      }
  }
  EXPECT_LE(most, 1e-4);
  EXPECT_GT(corners, 40u);
  EXPECT_GT(at_poles, corners + 100);
}

/// Every vertex lies at its float parameters, within the rounding that the certificate counts and theirs, and its
/// normal is the patch's.
TEST(PatchWriter, VerticesLieOnTheirPatchesWithTheirNormals) {
  for (const auto& [set, tolerance] : patch_writer_cases()) {
    const Mesh mesh = patch_writer_mesh_of(set, tolerance);
    std::size_t wrong = 0, turned = 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t k = mesh.indices[3 * t + corner];
        const BezierPatch& patch = impl_of(set).patches[mesh.patches[t]];
        const double u = mesh.parameters[2 * k], v = mesh.parameters[2 * k + 1];
        const Vec3 p{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
        const Vec3 n{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
        const SurfaceJet jet = evaluate_jet(patch, u, v);
        const double slack = vertex_rounding(patch, set.origin()) + 0x1p-24 * (length(jet.du) + length(jet.dv));
        wrong += !(length(p + mesh.origin - jet.position) <= slack);
        const Vec3 area = cross(jet.du, jet.dv);
        if (length(area) > 1e-2 * length(jet.du) * length(jet.dv) && length(area) > 1e-3 * slack)
          turned += !(length(n - normalized(area)) <= 2e-3);
      }
    EXPECT_EQ(wrong, 0u) << tolerance;
    EXPECT_EQ(turned, 0u) << tolerance;
  }
}

TEST(PatchWriter, TrianglesAreThoseOfTheDivisions) {
  for (const auto& [set, tolerance] : patch_writer_cases()) {
    const PlanFacts facts = good(find_plan_facts(impl_of(set), PlannerOptions{}, {}));
    const CertifiedPlan plan = good(make_plan(facts, {tolerance}, {}));
    const Mesh mesh = patch_writer_mesh_of(set, tolerance);
    std::vector<std::uint32_t> expected(mesh.indices.size());
    for (std::size_t k = 0; k < plan.patch_count(); ++k)
      plan.division(k).write_triangles(static_cast<std::uint32_t>(plan.first_vertex(k)),
                                       expected.data() + 3 * plan.first_triangle(k));
    EXPECT_EQ(mesh.indices, expected);
  }
}

TEST(Division, ParametersOfAVertexAreThoseInOrder) {
  const Division division = Division::of({3, 3, {}, false}, {4, 6}, {5, 6, 4, 9});
  std::size_t vertex = 0;
  for_parameters(division, [&](double u, double v) {
    const auto at = division.parameters(vertex++);
    EXPECT_EQ(at.u, u);
    EXPECT_EQ(at.v, v);
  });
}

}}  // namespace tessera::test
