// Parts far from each other, and tolerances near the precision of positions: float vertices that come from double
// control points.

#include "tess/far_parts.h"
#include "base/impl_access.h"
#include "support/edges_of_set.h"

namespace tessera::test { namespace {

TEST(FarParts, AVertexIsWithinItsRounding) {
  Random random(3);
  for (int k = 0; k < 60; ++k) {
    const int m = 1 + static_cast<int>(random() % 15), n = 1 + static_cast<int>(random() % 15);
    const Vec3 origin{1e6, -2e5, 3}, centre = origin + Vec3{300, 0, 0.001};
    const BezierPatch made = random_polynomial(random, m, n, centre);
    const BezierPatch patch =
        k % 2 ? made
              : rational(m, n, {made.points().begin(), made.points().end()}, random_weights(random, m, n, 0.1, 10));
    const Division division = Division::of(PatchShape::of(patch, SideMask{}), Rates{7, 12}, {Segments(7), 13, 9, 12});
    const double most = f64_vertex_rounding(patch, origin);
    EXPECT_LE(most, 0x1p-23 * 310);
    std::vector<Vec3> found;
    const F64Points points(patch, origin);
    points.for_inner(division, [&](const Vec3& p) { found.push_back(p); });
    for (const Side side : all_sides)
      points.for_border(division, side, [&](int, const Vec3& p) { found.push_back(p); });
    ASSERT_EQ(found.size(), division.vertex_count());
    for (std::size_t vertex = 0; vertex < found.size(); ++vertex) {
      const auto at = division.parameters(vertex);
      const Vec3 exact = de_casteljau(patch, at.u, at.v) - origin, p = found[vertex];
      const Vec3 rounded{as_float(p.x), as_float(p.y), as_float(p.z)};
      EXPECT_LE(length(rounded - exact), most + 1e-9) << m << " " << n << " " << vertex;  // the reference rounds at 1e6
    }
  }
}

TEST(FarParts, KeepATolerance) {
  for (const auto& body : {sphere(), closed_body()})
    for (const bool fewest : {false, true}) {
      const PatchSet set = set_of(far_apart(body, 1000));
      const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.001, .fewest = fewest}));
      EXPECT_TRUE(is_f64(plan));
      EXPECT_LE(plan.bound(), 0.001 * (1 + 1e-6));
      EXPECT_EQ(plan.welded_borders(), 0u);
      const Mesh mesh = mesh_of(set, plan);
      expect_closed(mesh);
      expect_bounds(set, mesh, plan.bounds());
    }
}

TEST(FarParts, ALongCylinderKeepsATolerance) {
  const PatchSet set = set_of(cylinder(1, 1000));
  EXPECT_LE(good(Tessellation::make(set, {.tolerance = 0.001})).bound(), 0.001 * (1 + 1e-6));
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.0025}));
  EXPECT_TRUE(is_f64(plan));
  const Mesh mesh = mesh_of(set, plan);
  expect_bounds(set, mesh, plan.bounds());
  const CrackCount cracks = good(count_cracks(set, 0.0025 / set.box().diagonal(), std::uint64_t{1} << 30));
  EXPECT_TRUE(cracks.good()) << cracks.cracks;
}

TEST(FarParts, FloatVerticesServeOtherTolerances) {
  for (const auto& body : {sphere(), closed_body()}) {
    const PatchSet set = set_of(body);
    EXPECT_FALSE(is_f64(good(Tessellation::make(set, {.tolerance = 1e-4}))));
    EXPECT_TRUE(is_f64(good(Tessellation::make(set, {.tolerance = 2e-6}))));
  }
}

/// Borders are one edge by their float bits; vertices come from doubles, which may differ.
TEST(FarParts, MeetWithoutACrackWhereDoublesDiffer) {
  for (const auto& body : {sphere(), closed_body()})
    for (std::uint64_t seed = 1; seed < 4; ++seed)
      for (const bool shares : {false, true})
        for (const bool fewest : {false, true}) {
          const PatchSet set = set_of(shaken_bits(far_apart(body, 1000), seed));
          TessellationOptions options{.tolerance = 0.004, .joining = {.share_vertices = shares}};
          options.fewest = fewest;
          const Tessellation plan = good(Tessellation::make(set, options));
          ASSERT_TRUE(is_f64(plan) || !body[0].is_rational());
          expect_closed(mesh_of(set, plan));
          options.tolerance = 0.001;
          const Tessellation finer = good(Tessellation::make(set, options));
          ASSERT_TRUE(is_f64(finer));
          const Mesh mesh = mesh_of(set, finer);
          expect_closed(mesh);
          if (!shares) expect_bounds(set, mesh, finer.bounds(), 30);
        }
}

TEST(FarParts, MeetWithoutACrackWhereFloatsAreTheSame) {
  for (std::uint64_t seed = 1; seed < 6; ++seed)
    for (const bool shares : {false, true}) {
      const PatchSet set =
          good(PatchSet::make(shaken_within_floats(far_apart(closed_body(), 1000), seed), {.origin = Vec3{}}));
      const Tessellation plan =
          good(Tessellation::make(set, {.tolerance = 0.001, .joining = {.share_vertices = shares}}));
      ASSERT_TRUE(is_f64(plan));
      EXPECT_EQ(plan.welded_borders(), 0u);
      EXPECT_EQ(edges_of_set(set).count(), 24u);
      const Mesh mesh = mesh_of(set, plan);
      expect_closed(mesh);
      if (!shares) expect_bounds(set, mesh, plan.bounds(), 100);
    }
}

TEST(FarParts, MeetByWeldingWithoutACrack) {
  Random random(8);
  for (const auto& body : {sphere(), closed_body()}) {
    std::vector<BezierPatch> patches = far_apart(body, 1000);
    for (BezierPatch& patch : patches) {
      std::vector<Vec3> points(patch.points().begin(), patch.points().end());
      for (Vec3& p : points) p = p + 1e-4 * uniform_vector(random, -1, 1);
      patch = good(patch.with_points(points));
    }
    const PatchSet set = set_of(patches);
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.002, .joining = {.weld = 6e-4}}));
    EXPECT_TRUE(is_f64(plan));
    EXPECT_GT(plan.welded_borders(), 0u);
    const Mesh mesh = mesh_of(set, plan);
    expect_closed(mesh);
    expect_bounds(set, mesh, plan.bounds(), 60);
  }
}

TEST(FarParts, SharedNormalsAndVertices) {
  const PatchSet set = set_of(shaken_bits(far_apart(sphere(), 1000), 4));
  for (const bool shares : {false, true}) {
    const Tessellation plan =
        good(Tessellation::make(set, {.tolerance = 0.001, .joining = {.crease_angle = 0.1, .share_vertices = shares}}));
    const Mesh mesh = mesh_of(set, plan);
    expect_closed(mesh);
    for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
      const Vec3 p = mesh.origin + Vec3{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
      const Vec3 radius = p - (p.x < 0 ? Vec3{-500, 0.3, 0.1} : Vec3{500, -0.2, 0.7});
      const Vec3 normal{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
      EXPECT_GE(std::abs(dot(radius, normal)), 1 - 1e-3) << k;
    }
  }
}

TEST(FarParts, QuadsHaveTheSameVertices) {
  const PatchSet set = set_of(far_apart(closed_body(), 1000));
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.001}));
  const Mesh quads = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.001, .quads = true})));
  EXPECT_GT(quads.quad_count(), 0u);
  EXPECT_EQ(quads.positions, mesh_of(set, plan).positions);
  expect_closed(quads);
}

TEST(FarParts, TheSameBytesForAllThreadsAndInstructions) {
  const PatchSet set = set_of(shaken_bits(far_apart(sphere(), 1000), 2));
  const auto made = [&](int threads, std::optional<Isa> isa) {
    Mesh mesh;
    tbb::task_arena(threads).execute(
        [&] { mesh = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.001, .isa = isa}))); });
    return mesh;
  };
  const Mesh one = made(1, {});
  const Mesh two = made(2, {});
  EXPECT_EQ(one.positions, two.positions);
  EXPECT_EQ(one.normals, two.normals);
  EXPECT_EQ(one.indices, two.indices);
  for (const Isa isa : available_isas()) {
    const Mesh other = made(1, isa);
    EXPECT_EQ(one.positions, other.positions) << name(isa);
    EXPECT_EQ(one.indices, other.indices) << name(isa);
  }
}

/// The smallest tolerance of a budget, and pixels, that float sums would not keep.
TEST(FarParts, BudgetsAndPixels) {
  const PatchSet set = set_of(far_apart(sphere(), 1000));
  const Tessellation plan = good(Tessellation::make(set, {.budget = 200000}));
  EXPECT_TRUE(is_f64(plan));
  EXPECT_LE(plan.bound(), 0.0005);
  expect_closed(mesh_of(set, plan));
  View view;
  view.eye = {-500, -3, 0};
  view.target = {-500, 0.3, 0.1};
  const Tessellation seen = good(Tessellation::make(set, {.pixels = PixelTolerance{0.05, view}}));
  EXPECT_TRUE(is_f64(seen));
  EXPECT_LE(seen.pixels(), 0.05 * (1 + 1e-6));
}

/// The number that a message ends with, before some words.
double number_before(const std::string& message, const std::string& words) {
  const std::size_t end = message.find(words), begin = message.rfind(' ', end - 1);
  EXPECT_NE(end, std::string::npos) << message;
  return end == std::string::npos ? 0 : std::stod(message.substr(begin + 1, end - begin - 1));
}

/// Bad input: the error names a tolerance that can be kept, and that is not much larger than the rounding.
TEST(FarParts, ARefusalNamesATolerance) {
  Random random(7);
  std::vector<BezierPatch> thin = placed(closed_body(), 1e-7, {1, 2, 3});
  const std::vector<BezierPatch> large = closed_body();
  thin.insert(thin.end(), large.begin(), large.end());
  struct Case {
    std::string name;
    std::vector<BezierPatch> patches;
    double tolerance;
  };
  const Case cases[] = {
      {"spheres 1e6 apart", far_apart(sphere(), 1e6), 0.001},
      {"spheres 1e9 apart", far_apart(sphere(), 1e9), 0.001},
      {"a cylinder of height 1e6", cylinder(1, 1e6), 0.001},
      {"below rounding", closed_body(), 1e-12},
      {"little above rounding", closed_body(), 1e-7},
      {"subnormal", sphere(), 5e-324},
      {"at 1e12", placed(closed_body(), 1, {1e12, -1e12, 1e11}), 1e-9},
      {"thin beside a large one", thin, 1e-9},
      {"degree 15", {random_polynomial(random, 15, 15)}, 1e-9},
  };
  for (const Case& bad : cases) {
    const PatchSet set = set_of(bad.patches);
    const auto refused = Tessellation::make(set, {.tolerance = bad.tolerance});
    ASSERT_FALSE(refused) << bad.name;
    EXPECT_EQ(refused.status().code(), StatusCode::invalid_argument);
    const double named = number_before(refused.status().message(), " is enough");
    EXPECT_NE(refused.status().message().find("; positions in double keep"), std::string::npos)
        << refused.status().message();
    EXPECT_GT(named, bad.tolerance) << refused.status().message();
    const double size = max_abs(set.box().upper - set.box().lower);  // of degree 15, 4096 segments keep no less
    EXPECT_LE(named, (bad.patches.size() == 1 ? 1e-4 : 0x1p-22) * size) << refused.status().message();
    const auto plan = Tessellation::make(set, {.tolerance = named});
    ASSERT_TRUE(plan) << bad.name << ": " << plan.status().message();
    EXPECT_LE(plan->bound(), named * (1 + 1e-6)) << bad.name;
    if (plan->capacity().triangles > 3000000) continue;
    const Mesh mesh = mesh_of(set, *plan);
    expect_bounds(set, mesh, plan->bounds(), 40);
  }
}

TEST(FarParts, UpdatesFollow) {
  for (const bool shares : {false, true}) {
    PatchSet set = set_of(shaken_bits(far_apart(sphere(), 1000), 6));
    Tessellation plan =
        good(Tessellation::make(set, {.tolerance = 0.001, .joining = {.share_vertices = shares}, .spare = 10}));
    Mesh mesh = mesh_of(set, plan);
    // Every patch gets bits of its own at its borders; then one moves as a whole, and its neighbours' borders with it.
    for (const double by : {1e-13, 1e-4}) {
      std::vector<std::uint32_t> patches;
      std::vector<Vec3> points;
      Random random(1);
      for (std::uint32_t k = 0; k<set.patch_count(); k += by> 1e-5 ? 3 : 1) {
        patches.push_back(k);
        const Vec3 shift = by * uniform_vector(random, -1, 1);
        for (const Vec3& p : set.patch(k).points()) points.push_back(p + shift);
      }
      const bool changed = good(plan.update(set, {patches, points}, mesh.views())).topology;
      EXPECT_EQ(changed, by > 1e-5);  // the tolerance leaves no room for borders that part
      if (changed) mesh = mesh_of(set, plan);
      EXPECT_EQ(mesh.positions, mesh_of(set, plan).positions);
      expect_closed(mesh);
      EXPECT_LE(plan.bound(), 0.001 * (1 + 1e-6));
      if (!shares) expect_bounds(set, mesh, plan.bounds(), 100);
    }
  }
}

/// A patch that goes from float sums to doubles changes, and no other does.
TEST(FarParts, OtherVerticesAreAnotherTopology) {
  PatchSet set = set_of(std::vector<BezierPatch>{closed_body()[0], placed(closed_body(), 1, {4, 0, 0})[1]});
  Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.001}));
  EXPECT_FALSE(is_f64(plan));
  Mesh mesh = mesh_of(set, plan);
  std::vector<Vec3> points;
  for (const Vec3& p : set.patch(1).points()) points.push_back(p + Vec3{2000, 0, 0});
  const std::uint32_t patch = 1;
  EXPECT_EQ(good(plan.update(set, {std::span(&patch, 1), points}, mesh.views())).patches, 1u);
  EXPECT_TRUE(is_f64(plan));
  mesh = mesh_of(set, plan);
  expect_bounds(set, mesh, plan.bounds());
}

/// A patch that comes near keeps its doubles until another plan is made; then its vertices change without an edit.
TEST(FarParts, VerticesThatTurnIntoFloatsAreAnotherTopology) {
  const std::vector<BezierPatch> patches{closed_body()[0], placed(closed_body(), 1, {2000, 0, 0})[1]};
  PatchSet set = good(PatchSet::make(patches, {.origin = Vec3{}}));
  Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.001, .spare = 10}));
  Mesh mesh = mesh_of(set, plan);
  const auto move = [&](std::uint32_t patch, double by) {
    std::vector<Vec3> points;
    for (const Vec3& p : set.patch(patch).points()) points.push_back(p + Vec3{by, 0, 0});
    return good(plan.update(set, {std::span(&patch, 1), points}, mesh.views()));
  };
  EXPECT_FALSE(move(1, -1996).topology);
  EXPECT_TRUE(is_f64(plan, 1));
  EXPECT_EQ(mesh.positions, mesh_of(set, plan).positions);
  EXPECT_EQ(move(0, 2000).patches, 2u);
  EXPECT_TRUE(is_f64(plan, 0));
  EXPECT_FALSE(is_f64(plan, 1));
}

}}  // namespace tessera::test
