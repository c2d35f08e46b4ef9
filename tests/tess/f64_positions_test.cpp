// Meshes with positions in double: parts a million apart keep a tolerance and meet without cracks.

#include "base/impl_access.h"
#include "tess/far_parts.h"

namespace tessera::test { namespace {

/// The mesh at its positions in double, relative to a triangle's own place.
void expect_f64_bounds(const PatchSet& set, const Mesh& mesh, std::span<const float> bounds, std::size_t count = 200) {
  ASSERT_EQ(mesh.model_positions.size(), mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 1 + mesh.triangle_count() / count) {
    const std::uint32_t patch = mesh.patches[t];
    MeshTriangle triangle = triangle_of(mesh, t);
    for (std::size_t c = 0; c < 3; ++c) {
      const double* const p = &mesh.model_positions[3 * std::size_t{mesh.indices[3 * t + c]}];
      triangle.corners[c] = {p[0], p[1], p[2]};
    }
    EXPECT_LE(largest_distance(set.patch(patch), triangle, 0.1, 60).low, bounds[patch]) << t;
  }
}

TessellationOptions in_double(double tolerance) {
  TessellationOptions options{.tolerance = tolerance};
  options.precision = Precision::double_precision;
  return options;
}

TEST(FarPartsInDouble, KeepATolerance) {
  for (const auto& body : {sphere(), closed_body()})
    for (const bool shares : {false, true})
      for (const double apart : {4.0, 1e6, 1e9}) {
        const PatchSet set = set_of(far_apart(body, apart));
        TessellationOptions options = in_double(0.001);
        options.joining.share_vertices = shares;
        const Tessellation plan = good(Tessellation::make(set, options));
        EXPECT_LE(plan.bound(), 0.001 * (1 + 1e-6));
        EXPECT_EQ(plan.welded_borders(), 0u);
        const Mesh mesh = mesh_of(set, plan);
        expect_closed(mesh);
        EXPECT_EQ(good(check(mesh)).flipped_triangles, 0u);
        if (!shares) expect_f64_bounds(set, mesh, plan.bounds(), 60);
      }
}

TEST(FarPartsInDouble, ALongCylinderKeepsATolerance) {
  const PatchSet set = set_of(cylinder(1, 1e5));
  const Tessellation plan = good(Tessellation::make(set, in_double(0.1)));
  const Mesh mesh = mesh_of(set, plan);
  expect_f64_bounds(set, mesh, plan.bounds());
}

/// Small patches a million away: all control points of each are one float, and only what meets in double is joined.
TEST(FarPartsInDouble, PatchesWithinOneFloatMeetAsTheirDoublesDo) {
  const Vec3 far{5e5, 3e5, -4e5};
  std::vector<BezierPatch> patches = placed(closed_body(), 1e-4, far);
  const std::vector<BezierPatch> other = placed(closed_body(), 1e-4, -1 * far),
                                 field = placed(wavy_field(6, 6), 1e-4, far);
  patches.insert(patches.end(), other.begin(), other.end());
  for (const bool shares : {false, true})
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const PatchSet set = good(PatchSet::make(shaken_bits(patches, seed, 1e-16), {.origin = Vec3{}}));
      TessellationOptions options = in_double(1e-7);
      options.joining.share_vertices = shares;
      const Tessellation plan = good(Tessellation::make(set, options));
      const Mesh mesh = mesh_of(set, plan);
      expect_closed(mesh);
      if (!shares) expect_f64_bounds(set, mesh, plan.bounds(), 60);
    }
  const PatchSet set = good(PatchSet::make(field, {.origin = Vec3{}}));
  const Tessellation plan = good(Tessellation::make(set, in_double(1e-7)));
  EXPECT_EQ(proven_mesh_of(plan).plan().patch_count(), 36u);
  const MeshReport report = good(check(mesh_of(set, plan)));
  EXPECT_EQ(report.non_manifold_edges, 0u);
  EXPECT_EQ(report.t_junctions, 0u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
}

TEST(FarPartsInDouble, MeetWithoutACrackWhereDoublesDiffer) {
  for (const auto& body : {sphere(), closed_body()})
    for (std::uint64_t seed = 1; seed < 6; ++seed)
      for (const bool shares : {false, true}) {
        const PatchSet set = set_of(shaken_bits(far_apart(body, 1e6), seed, 1e-16));
        TessellationOptions options = in_double(0.001);
        options.joining.share_vertices = shares;
        const Tessellation plan = good(Tessellation::make(set, options));
        const Mesh mesh = mesh_of(set, plan);
        expect_closed(mesh);
        if (!shares) expect_f64_bounds(set, mesh, plan.bounds(), 30);
      }
}

TEST(FarPartsInDouble, MeetByWeldingWithoutACrack) {
  Random random(8);
  for (const auto& body : {sphere(), closed_body()}) {
    std::vector<BezierPatch> patches = far_apart(body, 1e6);
    for (BezierPatch& patch : patches) {
      std::vector<Vec3> points(patch.points().begin(), patch.points().end());
      for (Vec3& p : points) p = p + 1e-5 * uniform_vector(random, -1, 1);
      patch = good(patch.with_points(points));
    }
    const PatchSet set = set_of(patches);
    TessellationOptions options = in_double(0.001);
    options.joining.weld = 6e-5;
    const Tessellation plan = good(Tessellation::make(set, options));
    const Mesh mesh = mesh_of(set, plan);
    expect_closed(mesh);
    expect_f64_bounds(set, mesh, plan.bounds(), 60);
  }
}

TEST(FarPartsInDouble, NormalsAndUpdatesFollow) {
  PatchSet set = set_of(far_apart(sphere(), 1e6));
  TessellationOptions options = in_double(0.001);
  options.joining.crease_angle = 0.01;
  Tessellation plan = good(Tessellation::make(set, options));
  Mesh mesh = mesh_of(set, plan);
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const double* const at = &mesh.model_positions[3 * k];
    const Vec3 p{at[0], at[1], at[2]}, radius = p - (p.x < 0 ? Vec3{-5e5, 0.3, 0.1} : Vec3{5e5, -0.2, 0.7});
    const Vec3 normal{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
    EXPECT_GE(std::abs(dot(radius, normal)), 1 - 1e-6) << k;
  }
  const std::uint32_t patch = 3;
  std::vector<Vec3> points;
  const double room = 0.001 - plan.bound();
  ASSERT_GT(room, 1e-7);
  for (const Vec3& p : set.patch(patch).points()) points.push_back(p + Vec3{0.9 * room, 0, 0});
  EXPECT_FALSE(good(plan.update(set, {std::span(&patch, 1), points}, mesh.views())).topology);
  EXPECT_EQ(mesh.model_positions, mesh_of(set, plan).model_positions);
  EXPECT_LE(plan.bound(), 0.001 * (1 + 1e-6));
  expect_closed(mesh);
  expect_f64_bounds(set, mesh, plan.bounds(), 100);
}

TEST(FarPartsInDouble, ViewsMustSuitThePlan) {
  const PatchSet set = set_of(closed_body());
  const Tessellation single = good(Tessellation::make(set, {.tolerance = 0.01})),
                     twice = good(Tessellation::make(set, in_double(0.01)));
  Mesh mesh = good(twice.allocate());
  EXPECT_EQ(single.run(set, mesh.views()).code(), StatusCode::invalid_argument);
  MeshViews views = mesh.views();
  views.position = {};
  EXPECT_TRUE(twice.run(set, views).ok());
  const std::vector<double> alone = mesh.model_positions;
  EXPECT_TRUE(twice.run(set, mesh.views()).ok());
  EXPECT_EQ(alone, mesh.model_positions);
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    EXPECT_NEAR(mesh.positions[k] + (k % 3 == 0   ? mesh.origin.x
                                     : k % 3 == 1 ? mesh.origin.y
                                                  : mesh.origin.z),
                mesh.model_positions[k], 1e-6);
  views = mesh.views();
  views.model_position = {};
  EXPECT_EQ(twice.run(set, views).code(), StatusCode::invalid_argument);
  views = mesh.views();
  views.model_position.size -= 1;
  EXPECT_EQ(twice.run(set, views).code(), StatusCode::buffer_too_small);
  const Mesh quads = [&] {
    TessellationOptions options = in_double(0.01);
    options.quads = true;
    const Tessellation plan = good(Tessellation::make(set, options));
    Mesh made = good(plan.allocate());
    EXPECT_TRUE(plan.run(set, made.views()).ok());
    return made;
  }();
  EXPECT_EQ(quads.model_positions, mesh.model_positions);
  EXPECT_EQ(good(split_quads(quads)).model_positions, mesh.model_positions);
}

/// A set of curves alone has an empty mesh, which has no memory to be written to.
TEST(MeshesWithoutVertices, AreAllocatedWrittenAndFollowed) {
  const BezierPatch line = polynomial(1, 1, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  for (const Precision precision : {Precision::single_precision, Precision::double_precision})
    for (const bool shares : {false, true}) {
      PatchSet set = set_of({line, line});
      TessellationOptions options{.tolerance = 0.1, .joining = {.share_vertices = shares}};
      options.precision = precision;
      Tessellation plan = good(Tessellation::make(set, options));
      EXPECT_EQ(plan.capacity().vertices, 0u);
      const Mesh allocated = good(plan.allocate());
      Mesh mesh = allocated;  // a copy has no reserved memory
      const Status status = plan.run(set, mesh.views());
      EXPECT_TRUE(status.ok()) << status.message();
      EXPECT_TRUE(plan.run(set, {}).ok());
      const std::vector<Vec3> points{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 0}};
      const std::vector<std::uint32_t> patch{1};
      const auto change = plan.update(set, PatchEdits{patch, points}, mesh.views());
      EXPECT_TRUE(change.ok()) << change.status().message();
    }
}

}}  // namespace tessera::test
