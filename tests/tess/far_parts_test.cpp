// Parts far from each other, and tolerances near what positions can hold: float vertices that come from double control
// points.

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/crack_survey.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/certified_tessellation_impl.h"
#include "tess/f64_points.h"
#include "tess/tessellate_support.h"
#include "tessera/bezier_operations.h"
#include "tessera/mesh_update.h"

namespace tessera::test {
namespace {

/// The bodies at both ends of a length along x.
std::vector<BezierPatch> far_apart(const std::vector<BezierPatch>& body, double apart) {
  std::vector<BezierPatch> patches = placed(body, 1, {-apart / 2, 0.3, 0.1});
  const std::vector<BezierPatch> other = placed(body, 1, {apart / 2, -0.2, 0.7});
  patches.insert(patches.end(), other.begin(), other.end());
  return patches;
}

/// The side of a cylinder about the z axis, as four rational patches.
std::vector<BezierPatch> cylinder(double radius, double height) {
  constexpr double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  std::vector<BezierPatch> patches;
  for (int quarter = 0; quarter < 4; ++quarter) {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int i = 0; i <= 2; ++i)
      for (const double z : {0.0, height}) {
        points.push_back({radius * x[2 * quarter + i], radius * y[2 * quarter + i], z});
        weights.push_back(i == 1 ? std::sqrt(0.5) : 1);
      }
    patches.push_back(rational(2, 1, points, weights));
  }
  return patches;
}

/// Every control point moved by some units in its last place, and each patch turned; poles stay points.
std::vector<BezierPatch> shaken_bits(const std::vector<BezierPatch>& patches, std::uint64_t seed, double by = 1e-15) {
  Random random(seed);
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) {
      const bool is_pole = std::count(patch.points().begin(), patch.points().end(), p) > 1;
      const Vec3 shift = uniform_vector(random, -1, 1);
      if (!is_pole) p = p + by * length(p) * shift;
    }
    out.push_back(reoriented(good(patch.with_points(points)), static_cast<int>(random() % 8)));
  }
  return out;
}

/// GCC 12 leaves the rounding out where it vectorizes conversions to float and back.
double as_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return double{rounded};
}

/// Every control point moved as far as its float, relative to the origin, stays what it is, and each patch turned.
std::vector<BezierPatch> shaken_within_floats(const std::vector<BezierPatch>& patches, std::uint64_t seed) {
  Random random(seed);
  const auto shaken = [&](double x) {
    const double packed = as_float(x);
    return packed + 0x1p-25 * uniform(random, -0.99, 0.99) * std::abs(packed);
  };
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = {shaken(p.x), shaken(p.y), shaken(p.z)};
    out.push_back(reoriented(good(patch.with_points(points)), static_cast<int>(random() % 8)));
  }
  return out;
}

/// About so many triangles of a mesh against the true distance.
void expect_bounds(const PatchSet& set, const Mesh& mesh, std::span<const float> bounds, std::size_t count = 200) {
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 1 + mesh.triangle_count() / count) {
    const std::uint32_t patch = mesh.patches[t];
    EXPECT_LE(largest_distance(set.patch(patch), triangle_of(mesh, t), 0.1, 60).low, bounds[patch]) << t;
  }
}

void expect_closed(const Mesh& mesh) {
  const MeshReport report = good(check(mesh));
  EXPECT_TRUE(report.closed()) << report.open_edges << " open, " << report.non_manifold_edges << " not manifold";
  EXPECT_EQ(report.degenerate_triangles, 0u);
}

bool is_f64(const CertifiedTessellation& plan) { return plan.impl().plan().is_f64(); }

TEST(FarParts, AVertexIsWithinItsRounding) {
  Random random(3);
  for (int k = 0; k < 60; ++k) {
    const int m = 1 + static_cast<int>(random() % 15), n = 1 + static_cast<int>(random() % 15);
    const Vec3 origin{1e6, -2e5, 3}, centre = origin + Vec3{300, 0, 0.001};
    const BezierPatch made = random_polynomial(random, m, n, centre);
    const BezierPatch patch =
        k % 2 ? made
              : rational(m, n, {made.points().begin(), made.points().end()}, random_weights(random, m, n, 0.1, 10));
    const Division division = Division::of(PatchShape::of(patch, EdgeMask{}), Rates{7, 12}, {Segments(7), 13, 9, 12});
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
      const CertifiedTessellation plan = good(CertifiedTessellation::make(set, {.tolerance = 0.001, .fewest = fewest}));
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
  EXPECT_LE(good(CertifiedTessellation::make(set, {.tolerance = 0.001})).bound(), 0.001 * (1 + 1e-6));
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, {.tolerance = 0.005}));
  EXPECT_TRUE(is_f64(plan));
  const Mesh mesh = mesh_of(set, plan);
  expect_bounds(set, mesh, plan.bounds());
  const CrackCount cracks = good(count_cracks(set, 0.005 / set.box().diagonal(), std::uint64_t{1} << 30));
  EXPECT_TRUE(cracks.good()) << cracks.cracks;
}

TEST(FarParts, FloatVerticesServeOtherTolerances) {
  for (const auto& body : {sphere(), closed_body()}) {
    const PatchSet set = set_of(body);
    EXPECT_FALSE(is_f64(good(CertifiedTessellation::make(set, {.tolerance = 1e-4}))));
    EXPECT_TRUE(is_f64(good(CertifiedTessellation::make(set, {.tolerance = 2e-6}))));
  }
}

/// Borders are one edge by their float bits; vertices come from doubles, which may differ.
TEST(FarParts, MeetWithoutACrackWhereDoublesDiffer) {
  for (const auto& body : {sphere(), closed_body()})
    for (std::uint64_t seed = 1; seed < 4; ++seed)
      for (const bool shares : {false, true})
        for (const bool fewest : {false, true}) {
          const PatchSet set = set_of(shaken_bits(far_apart(body, 1000), seed));
          CertifiedOptions options{.tolerance = 0.004, .share_vertices = shares};
          options.fewest = fewest;
          const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
          ASSERT_TRUE(is_f64(plan) || !body[0].is_rational());
          expect_closed(mesh_of(set, plan));
          options.tolerance = 0.001;
          const CertifiedTessellation finer = good(CertifiedTessellation::make(set, options));
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
          good(PatchSet::from(shaken_within_floats(far_apart(closed_body(), 1000), seed), {.origin = Vec3{}}));
      const CertifiedTessellation plan =
          good(CertifiedTessellation::make(set, {.tolerance = 0.001, .share_vertices = shares}));
      ASSERT_TRUE(is_f64(plan));
      EXPECT_EQ(plan.welded_borders(), 0u);
      EXPECT_EQ(SharedEdges(set.impl()).count(), 24u);
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
    const CertifiedTessellation plan = good(CertifiedTessellation::make(set, {.tolerance = 0.002, .weld = 6e-4}));
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
    const CertifiedTessellation plan =
        good(CertifiedTessellation::make(set, {.tolerance = 0.001, .crease_angle = 0.1, .share_vertices = shares}));
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
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, {.tolerance = 0.001}));
  Mesh quads = good(plan.allocate_quads());
  ASSERT_TRUE(plan.run(set, quads.views()).ok());
  EXPECT_EQ(quads.positions, mesh_of(set, plan).positions);
  expect_closed(quads);
}

TEST(FarParts, TheSameBytesForAllThreadsAndInstructions) {
  const PatchSet set = set_of(shaken_bits(far_apart(sphere(), 1000), 2));
  const auto made = [&](int threads, std::optional<Isa> isa) {
    Mesh mesh;
    tbb::task_arena(threads).execute(
        [&] { mesh = mesh_of(set, good(CertifiedTessellation::make(set, {.tolerance = 0.001, .isa = isa}))); });
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
  CertifiedOptions budget{.most_triangles = 200000};
  budget.smallest = true;
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, budget));
  EXPECT_TRUE(is_f64(plan));
  EXPECT_LE(plan.bound(), 0.0005);
  expect_closed(mesh_of(set, plan));
  View view;
  view.eye = {-500, -3, 0};
  view.target = {-500, 0.3, 0.1};
  const CertifiedTessellation seen = good(CertifiedTessellation::make(set, {.pixels = PixelTolerance{0.05, view}}));
  EXPECT_TRUE(is_f64(seen));
  EXPECT_LE(seen.pixels(), 0.05 * (1 + 1e-6));
}

/// The number that a message ends with, before some words.
double number_before(const std::string& message, const std::string& words) {
  const std::size_t end = message.find(words), begin = message.rfind(' ', end - 1);
  EXPECT_NE(end, std::string::npos) << message;
  return end == std::string::npos ? 0 : std::stod(message.substr(begin + 1, end - begin - 1));
}

/// Bad input: what is refused names a tolerance that is kept, and not much larger than the rounding.
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
    const auto refused = CertifiedTessellation::make(set, {.tolerance = bad.tolerance});
    ASSERT_FALSE(refused) << bad.name;
    EXPECT_EQ(refused.status().code(), StatusCode::invalid_argument);
    const double named = number_before(refused.status().message(), " would do");
    EXPECT_NE(refused.status().message().find("; positions in double keep"), std::string::npos)
        << refused.status().message();
    EXPECT_GT(named, bad.tolerance) << refused.status().message();
    const double size = max_abs(set.box().upper - set.box().lower);  // of degree 15, 4096 segments keep no less
    EXPECT_LE(named, (bad.patches.size() == 1 ? 1e-4 : 0x1p-22) * size) << refused.status().message();
    const auto plan = CertifiedTessellation::make(set, {.tolerance = named});
    ASSERT_TRUE(plan) << bad.name << ": " << plan.status().message();
    EXPECT_LE(plan->bound(), named * (1 + 1e-6)) << bad.name;
    if (plan->capacity().triangles > 3000000) continue;
    const Mesh mesh = mesh_of(set, *plan);
    expect_bounds(set, mesh, plan->bounds(), 40);
  }
}

/// The mesh at its positions in double, relative to a triangle's own place.
void expect_f64_bounds(const PatchSet& set, const Mesh& mesh, std::span<const float> bounds, std::size_t count = 200) {
  ASSERT_EQ(mesh.positions_f64.size(), mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 1 + mesh.triangle_count() / count) {
    const std::uint32_t patch = mesh.patches[t];
    MeshTriangle triangle = triangle_of(mesh, t);
    for (std::size_t c = 0; c < 3; ++c) {
      const double* const p = &mesh.positions_f64[3 * std::size_t{mesh.indices[3 * t + c]}];
      triangle.corners[c] = {p[0], p[1], p[2]};
    }
    EXPECT_LE(largest_distance(set.patch(patch), triangle, 0.1, 60).low, bounds[patch]) << t;
  }
}

CertifiedOptions in_double(double tolerance) {
  CertifiedOptions options{.tolerance = tolerance};
  options.precision = Precision::double_precision;
  return options;
}

TEST(FarPartsInDouble, KeepATolerance) {
  for (const auto& body : {sphere(), closed_body()})
    for (const bool shares : {false, true})
      for (const double apart : {4.0, 1e6, 1e9}) {
        const PatchSet set = set_of(far_apart(body, apart));
        CertifiedOptions options = in_double(0.001);
        options.share_vertices = shares;
        const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
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
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, in_double(0.1)));
  const Mesh mesh = mesh_of(set, plan);
  expect_f64_bounds(set, mesh, plan.bounds());
}

/// Small patches a million away: all control points of each are one float, and nothing is joined but what meets in double.
TEST(FarPartsInDouble, PatchesWithinOneFloatMeetAsTheirDoublesDo) {
  const Vec3 far{5e5, 3e5, -4e5};
  std::vector<BezierPatch> patches = placed(closed_body(), 1e-4, far);
  const std::vector<BezierPatch> other = placed(closed_body(), 1e-4, -1 * far),
                                 field = placed(wavy_field(6, 6), 1e-4, far);
  patches.insert(patches.end(), other.begin(), other.end());
  for (const bool shares : {false, true})
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const PatchSet set = good(PatchSet::from(shaken_bits(patches, seed, 1e-16), {.origin = Vec3{}}));
      CertifiedOptions options = in_double(1e-7);
      options.share_vertices = shares;
      const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
      const Mesh mesh = mesh_of(set, plan);
      expect_closed(mesh);
      if (!shares) expect_f64_bounds(set, mesh, plan.bounds(), 60);
    }
  const PatchSet set = good(PatchSet::from(field, {.origin = Vec3{}}));
  const CertifiedTessellation plan = good(CertifiedTessellation::make(set, in_double(1e-7)));
  EXPECT_EQ(plan.impl().plan().patch_count(), 36u);
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
        CertifiedOptions options = in_double(0.001);
        options.share_vertices = shares;
        const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
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
    CertifiedOptions options = in_double(0.001);
    options.weld = 6e-5;
    const CertifiedTessellation plan = good(CertifiedTessellation::make(set, options));
    const Mesh mesh = mesh_of(set, plan);
    expect_closed(mesh);
    expect_f64_bounds(set, mesh, plan.bounds(), 60);
  }
}

TEST(FarPartsInDouble, NormalsAndUpdatesFollow) {
  PatchSet set = set_of(far_apart(sphere(), 1e6));
  CertifiedOptions options = in_double(0.001);
  options.crease_angle = 0.01;
  MeshUpdate update = good(MeshUpdate::make(set, good(CertifiedTessellation::make(set, options))));
  Mesh mesh = mesh_of(set, update.plan());
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const double* const at = &mesh.positions_f64[3 * k];
    const Vec3 p{at[0], at[1], at[2]}, radius = p - (p.x < 0 ? Vec3{-5e5, 0.3, 0.1} : Vec3{5e5, -0.2, 0.7});
    const Vec3 normal{mesh.normals[3 * k], mesh.normals[3 * k + 1], mesh.normals[3 * k + 2]};
    EXPECT_GE(std::abs(dot(radius, normal)), 1 - 1e-6) << k;
  }
  const std::uint32_t patch = 3;
  std::vector<Vec3> points;
  for (const Vec3& p : set.patch(patch).points()) points.push_back(p + Vec3{1e-4, 0, 0});
  ASSERT_TRUE(update.run(set, {std::span(&patch, 1), points}, mesh.views()).ok());
  EXPECT_EQ(mesh.positions_f64, mesh_of(set, update.plan()).positions_f64);
  ASSERT_TRUE(update.restate(set).ok());
  EXPECT_LE(update.bound(), 0.0012);
  expect_closed(mesh);
  expect_f64_bounds(set, mesh, update.bounds(), 100);
}

TEST(FarPartsInDouble, ViewsMustSuitThePlan) {
  const PatchSet set = set_of(closed_body());
  const CertifiedTessellation single = good(CertifiedTessellation::make(set, {.tolerance = 0.01})),
                              twice = good(CertifiedTessellation::make(set, in_double(0.01)));
  Mesh mesh = good(twice.allocate());
  EXPECT_EQ(single.run(set, mesh.views()).code(), StatusCode::invalid_argument);
  MeshViews views = mesh.views();
  views.position = {};
  EXPECT_TRUE(twice.run(set, views).ok());
  const std::vector<double> alone = mesh.positions_f64;
  EXPECT_TRUE(twice.run(set, mesh.views()).ok());
  EXPECT_EQ(alone, mesh.positions_f64);
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    EXPECT_NEAR(mesh.positions[k] + (k % 3 == 0   ? mesh.origin.x
                                     : k % 3 == 1 ? mesh.origin.y
                                                  : mesh.origin.z),
                mesh.positions_f64[k], 1e-6);
  views = mesh.views();
  views.position_f64 = {};
  EXPECT_EQ(twice.run(set, views).code(), StatusCode::invalid_argument);
  views = mesh.views();
  views.position_f64.size -= 1;
  EXPECT_EQ(twice.run(set, views).code(), StatusCode::buffer_too_small);
  const Mesh quads = [&] {
    Mesh made = good(twice.allocate_quads());
    EXPECT_TRUE(twice.run(set, made.views()).ok());
    return made;
  }();
  EXPECT_EQ(quads.positions_f64, mesh.positions_f64);
  EXPECT_EQ(good(split_quads(quads)).positions_f64, mesh.positions_f64);
}

TEST(FarParts, UpdatesFollow) {
  for (const bool shares : {false, true}) {
    PatchSet set = set_of(shaken_bits(far_apart(sphere(), 1000), 6));
    MeshUpdate update = good(
        MeshUpdate::make(set, good(CertifiedTessellation::make(set, {.tolerance = 0.001, .share_vertices = shares}))));
    Mesh mesh = mesh_of(set, update.plan());
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
      ASSERT_TRUE(update.run(set, {patches, points}, mesh.views()).ok());
      EXPECT_EQ(mesh.positions, mesh_of(set, update.plan()).positions);
      expect_closed(mesh);
      ASSERT_TRUE(update.restate(set).ok());
      EXPECT_LE(update.bound(), 0.0015);
      if (!shares) expect_bounds(set, mesh, update.bounds(), 100);
    }
  }
}

/// Patches that go from float sums to doubles change everywhere.
TEST(FarParts, RetessellatingTellsOfOtherVertices) {
  PatchSet set = set_of(std::vector<BezierPatch>{closed_body()[0], placed(closed_body(), 1, {4, 0, 0})[1]});
  MeshUpdate update = good(MeshUpdate::make(set, good(CertifiedTessellation::make(set, {.tolerance = 0.001}))));
  EXPECT_FALSE(is_f64(update.plan()));
  Mesh mesh = mesh_of(set, update.plan());
  std::vector<Vec3> points;
  for (const Vec3& p : set.patch(1).points()) points.push_back(p + Vec3{2000, 0, 0});
  const std::uint32_t patch = 1;
  ASSERT_TRUE(update.run(set, {std::span(&patch, 1), points}, mesh.views()).ok());
  ASSERT_TRUE(update.restate(set).ok());
  EXPECT_EQ(update.unproven(), 1u);
  EXPECT_EQ(good(update.retessellate(set)), 2u);
  EXPECT_TRUE(is_f64(update.plan()));
  mesh = mesh_of(set, update.plan());
  expect_bounds(set, mesh, update.plan().bounds());
}

}  // namespace
}  // namespace tessera::test
