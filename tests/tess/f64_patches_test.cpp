// Meshes where the vertices of some patches come from doubles, and those of their neighbours from floats.

#include <algorithm>
#include <functional>
#include <numeric>

#include "tess/far_parts.h"

namespace tessera::test { namespace {

/// A tolerance for which bicubic patches beyond about 20 from the origin need doubles.
constexpr double tolerance = 1e-4;

PatchSet set_at_zero(const std::vector<BezierPatch>& patches) {
  return good(PatchSet::make(patches, {.origin = Vec3{}}));
}
/// Twenty rows of three patches, 10 to 30 from the origin: floats serve about a half of them.
std::vector<BezierPatch> half_far_strip() {
  const std::vector<BezierPatch> field = wavy_field(30, 3);
  return {field.begin() + 30, field.end()};
}
/// The strip as it is, with doubles that differ where floats do not, and with gaps between all patches.
std::vector<std::vector<BezierPatch>> half_far_strips() {
  const std::vector<BezierPatch> strip = half_far_strip();
  std::vector<BezierPatch> apart;
  Random random(5);
  for (const BezierPatch& patch : strip) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    const Vec3 shift = 3e-6 * uniform_vector(random, -1, 1);
    for (Vec3& p : points) p = p + shift;
    apart.push_back(good(patch.with_points(points)));
  }
  return {strip, shaken_within_floats(strip, 3), apart};
}

std::size_t f64_count(const Tessellation& plan) {
  const auto patches = proven_mesh_of(plan).plan().patches().rare->f64_patches;
  return static_cast<std::size_t>(std::count(patches.begin(), patches.end(), 1));
}

/// The positions of one patch.
std::vector<float> positions_of(const Tessellation& plan, const Mesh& mesh, std::size_t patch) {
  const CertifiedPlan& inner = proven_mesh_of(plan).plan();
  const auto at = [&](std::size_t vertex) { return mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * vertex); };
  return {at(inner.first_vertex(patch)), at(inner.first_vertex(patch + 1))};
}

void expect_no_cracks(const Tessellation& plan, const Mesh& mesh) {
  const MeshReport report = good(check(mesh));
  EXPECT_EQ(report.open_edges, plan.open_edges());
  EXPECT_EQ(report.t_junctions, 0u);
  EXPECT_EQ(report.non_manifold_edges, 0u);
}

/// Expects the same positions and bounds of the patches `kept` without the others, in their order there.
void expect_same(const std::vector<BezierPatch>& patches, const std::vector<std::size_t>& kept,
                 const std::function<bool(std::size_t)>& is_compared) {
  const PatchSet set = set_at_zero(patches);
  std::vector<BezierPatch> some;
  for (const std::size_t k : kept) some.push_back(patches[k]);
  const PatchSet part = set_at_zero(some);
  const TessellationOptions options{.tolerance = tolerance};
  const Tessellation plan = good(Tessellation::make(set, options)), of_part = good(Tessellation::make(part, options));
  const Mesh mesh = mesh_of(set, plan), part_mesh = mesh_of(part, of_part);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (!is_compared(kept[k])) continue;
    EXPECT_EQ(positions_of(plan, mesh, kept[k]), positions_of(of_part, part_mesh, k)) << kept[k];
    EXPECT_EQ(plan.bounds()[kept[k]], of_part.bounds()[k]) << kept[k];
  }
}

TEST(F64Patches, MeetOthersWithoutACrackAndKeepTheirBounds) {
  for (const std::vector<BezierPatch>& strip : half_far_strips())
    for (const bool shares : {false, true})
      for (const bool fewest : {false, true}) {
        const PatchSet set = set_at_zero(strip);
        const TessellationOptions options{
            .tolerance = tolerance, .joining = {.share_vertices = shares}, .fewest = fewest};
        const Tessellation plan = good(Tessellation::make(set, options));
        EXPECT_FALSE(is_f64(plan, 0));
        EXPECT_TRUE(is_f64(plan, strip.size() - 1));
        EXPECT_LE(plan.bound(), tolerance * (1 + 1e-6));
        const Mesh mesh = mesh_of(set, plan);
        expect_no_cracks(plan, mesh);
        if (!shares) expect_bounds(set, mesh, plan.bounds(), 400);
      }
}

TEST(F64Patches, TakeNoVerticesOfFloats) {
  for (const std::vector<BezierPatch>& strip : half_far_strips()) {
    const PatchSet set = set_at_zero(strip);
    PlannerOptions options{.weld = {tolerance / 8, true}, .f64_patches = {}, .angle = {}, .camera = {}};
    for (std::size_t k = 0; k < strip.size(); ++k) options.f64_patches.push_back(k % 2);
    const PlanFacts facts = good(find_plan_facts(impl_of(set), options, {}));
    std::size_t taken = 0;
    const auto look = [&](const auto& copies) {
      for (const auto& copy : copies) {
        EXPECT_TRUE(options.f64_patches[copy.from / 4] || !options.f64_patches[copy.to / 4]) << copy.to / 4;
        taken += options.f64_patches[copy.from / 4];
      }
    };
    look(facts.borders.weld().borders);
    look(facts.borders.weld().corners);
    EXPECT_GT(taken, strip.size());
  }
}

TEST(F64Patches, AreThoseThatNeedThem) {
  std::vector<BezierPatch> patches = wavy_field(4, 4);
  const Tessellation near = good(Tessellation::make(set_at_zero(patches), {.tolerance = tolerance}));
  EXPECT_EQ(f64_count(near), 0u);
  patches.push_back(placed(closed_body(), 1, {1000, 0, 0})[2]);
  const PatchSet set = set_at_zero(patches);
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = tolerance}));
  EXPECT_EQ(f64_count(plan), 1u);
  EXPECT_TRUE(is_f64(plan, 16));
  expect_bounds(set, mesh_of(set, plan), plan.bounds());
}

TEST(F64Patches, NearOnesKeepTheirBitsWithoutFarOnes) {
  std::vector<BezierPatch> patches = wavy_field(4, 4);
  std::vector<std::size_t> near(patches.size());
  std::iota(near.begin(), near.end(), std::size_t{0});
  patches.push_back(placed(closed_body(), 1, {1000, 0, 0})[2]);
  const auto all = [](std::size_t) { return true; };
  expect_same(patches, near, all);
  std::ranges::reverse(near);
  expect_same(patches, near, all);
}

/// Where no vertex is moved, patches that touch count; else also those that touch these, which they are moved to.
TEST(F64Patches, DependOnNoPatchThatTouchesNone) {
  const std::vector<std::vector<BezierPatch>> strips = half_far_strips();
  for (std::size_t kind = 0; kind < strips.size(); ++kind) {
    SCOPED_TRACE(kind);
    std::vector<std::size_t> all(strips[kind].size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    expect_same(strips[kind], {all.rbegin(), all.rend()}, [](std::size_t) { return true; });
    const std::size_t beside = kind == 0 ? 3 : 6;
    for (const std::size_t first : {0u, 6u, 15u, 24u, 30u}) {  // ten rows
      const auto at = all.begin() + static_cast<std::ptrdiff_t>(first);
      expect_same(strips[kind], {at, at + 30},
                  [&](std::size_t k) { return k >= first + beside && k + beside < first + 30; });
    }
  }
}

TEST(F64Patches, FollowUpdates) {
  for (const std::size_t kind : {0u, 2u})  // edits part borders of floats whose doubles differ
    for (const bool shares : {false, true}) {
      const std::vector<BezierPatch> strip = half_far_strips()[kind];
      PatchSet set = set_at_zero(strip);
      Tessellation plan =
          good(Tessellation::make(set, {.tolerance = tolerance, .joining = {.share_vertices = shares}, .spare = 10}));
      Mesh mesh = mesh_of(set, plan);
      const std::size_t before = f64_count(plan);
      // All patches are moved as one; then some are raised between their borders, which stay.
      for (const bool inside : {false, true}) {
        std::vector<std::uint32_t> patches;
        std::vector<Vec3> points;
        for (std::uint32_t k = 0; k < set.patch_count(); k += inside ? 2 : 1) {
          patches.push_back(k);
          const BezierPatch& patch = set.patch(k);
          for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
              const bool is_inner = i % 3 != 0 && j % 3 != 0;
              points.push_back(patch.point(i, j) + Vec3{0, 0, inside && !is_inner ? 0.0 : 0x1p-12});
            }
        }
        const MeshChange change = good(plan.update(set, {patches, points}, mesh.views()));
        if (change.topology) mesh = mesh_of(set, plan);
        EXPECT_EQ(mesh.positions, mesh_of(set, plan).positions);
        EXPECT_EQ(f64_count(plan), before);
        expect_no_cracks(plan, mesh);
        EXPECT_LE(plan.bound(), tolerance * (1 + 1e-6));
        if (!shares) expect_bounds(set, mesh, plan.bounds(), 200);
      }
    }
}

/// A view that one of two bodies fills: only patches of that one need doubles.
TEST(F64Patches, OfPixelsAreThoseInThePicture) {
  std::vector<BezierPatch> patches = placed(closed_body(), 1, {300, 0, 0});
  for (const BezierPatch& patch : closed_body()) patches.push_back(patch);
  const PatchSet set = set_at_zero(patches);
  View view;
  view.eye = {300, -6, 0};
  view.target = {300, 0, 0};
  const Tessellation plan = good(Tessellation::make(set, {.pixels = PixelTolerance{0.05, view}}));
  EXPECT_GT(f64_count(plan), 0u);
  for (std::size_t k = 6; k < 12; ++k) EXPECT_FALSE(is_f64(plan, k));
  EXPECT_LE(plan.pixels(), 0.05 * (1 + 1e-6));
  expect_closed(mesh_of(set, plan));
}

}}  // namespace tessera::test
