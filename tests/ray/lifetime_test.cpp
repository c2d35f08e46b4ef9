// Edits make a scene stale, refit renews it; moves of set and scene change nothing.

#include <utility>

#include "ray_support.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

TEST(Lifetime, StaleUntilRefit) {
  const std::vector<Vec3> low{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}},
      high{{0, 0, 2}, {0, 1, 2}, {1, 0, 2}, {1, 1, 2}};
  PatchSet set = set_of({polynomial(1, 1, low)});
  RayScene scene = scene_of(set);
  const Ray down = ray({0.3, 0.6, 5}, {0, 0, -1});
  EXPECT_NEAR(scene.closest(down).t, 5, 1e-12);
  const std::uint64_t revision = scene.revision();
  EXPECT_EQ(revision, set.revision());

  ASSERT_TRUE(set.set_control_points(0, high).ok());
  Hit hit;
  std::uint8_t occluded = 7;
  EXPECT_EQ(scene.closest({&down, 1}, {&hit, 1}).code(), StatusCode::stale);
  EXPECT_EQ(scene.occluded({&down, 1}, {&occluded, 1}).code(), StatusCode::stale);
  EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);
  EXPECT_EQ(scene.occluded(down), HitKind::invalid_ray);
  EXPECT_EQ(scene.revision(), revision);

  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(scene.revision(), set.revision());
  EXPECT_NEAR(scene.closest(down).t, 3, 1e-12);
  EXPECT_EQ(scene.occluded(down), HitKind::hit);
}

TEST(Lifetime, ScenesKeepSetsThatTheyAreGiven) {
  const auto scene_of_nothing_else = [] {
    PatchSet set = set_of({polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}})});
    EXPECT_FALSE(RayScene::make(std::move(set), {.mode = static_cast<RayMode>(9)}).ok());
    EXPECT_EQ(set.patch_count(), 1u);  // an error leaves the set with its owner
    return value_of(RayScene::make(std::move(set)));
  };
  RayScene scene = scene_of_nothing_else();
  EXPECT_NEAR(scene.closest(ray({0.3, 0.6, 5}, {0, 0, -1})).t, 5, 1e-12);
  EXPECT_TRUE(scene.rebuild().ok());
}

TEST(Lifetime, ModelsBecomeScenesInOneCall) {
  Model model;
  for (const BezierPatch& patch : wavy_field(1, 2)) model.surfaces.push_back({{}, patch});
  const PatchSet set = value_of(make_patch_set(model));
  const RayScene scene = value_of(RayScene::make(model)), same = value_of(RayScene::make(set));
  const Ray down = ray({0.5, 1.5, 9}, {0, 0, -1});
  EXPECT_EQ(scene.closest(down).t, same.closest(down).t);
  EXPECT_EQ(scene.closest(down).surface, 1u);
  model.surfaces[1].trims = std::vector{circle({0.5, 0.5}, 1e101, true)};
  EXPECT_EQ(RayScene::make(model).status().index(), 1);
}

TEST(Lifetime, EditsThatTearOrWeldBorders) {
  std::vector<BezierPatch> patches = wavy_field(2, 1);
  PatchSet set = set_of(patches);
  RayScene scene = scene_of(set);
  std::vector<Vec3> points(patches[1].points().begin(), patches[1].points().end());
  for (Vec3& p : points) p.x += 1;  // a gap of width 1
  ASSERT_TRUE(set.set_control_points(1, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(scene.closest(ray({1.5, 0.5, 9}, {0, 0, -1})).kind, HitKind::miss);
  EXPECT_EQ(scene.closest(ray({2.5, 0.5, 9}, {0, 0, -1})).patch, 1u);
  ASSERT_TRUE(set.set_control_points(1, patches[1].points()).ok());
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(scene.closest(ray({1.5, 0.5, 9}, {0, 0, -1})).patch, 1u);
}

TEST(Lifetime, AFailedRefitLeavesTheSceneStale) {
  PatchSet set = set_of(sphere());
  RayScene scene = scene_of(set);
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  ASSERT_TRUE(set.set_control_points(0, sphere()[0].points()).ok());
  EXPECT_EQ(scene.refit(execution).code(), StatusCode::cancelled);
  const Ray down = ray({0.1, 0.1, 5}, {0, 0, -1});
  Hit hit;
  EXPECT_EQ(scene.closest({&down, 1}, {&hit, 1}).code(), StatusCode::stale);
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_EQ(scene.closest(down).kind, HitKind::hit);
}

TEST(Lifetime, MovesOfTheSet) {
  PatchSet set = set_of(sphere());
  RayScene scene = scene_of(set);
  const Ray down = ray({0.1, 0.1, 5}, {0, 0, -1});
  const double t = scene.closest(down).t;
  PatchSet moved = std::move(set);
  EXPECT_EQ(scene.closest(down).t, t);
  std::vector<Vec3> points(moved.patch(0).points().begin(), moved.patch(0).points().end());
  for (Vec3& p : points) p.z += 0.5;
  ASSERT_TRUE(moved.set_control_points(0, points).ok());
  EXPECT_EQ(scene.closest(down).kind, HitKind::invalid_ray);  // sees the edit through the move
  ASSERT_TRUE(scene.refit().ok());
  EXPECT_NEAR(scene.closest(down).t, t - 0.5, 1e-12);
  RayScene other = std::move(scene);
  EXPECT_NEAR(other.closest(down).t, t - 0.5, 1e-12);
}

TEST(Lifetime, MemoryIsTold) {
  const PatchSet set = set_of(wavy_field(20, 20));
  const std::size_t coarse = scene_of(set, 4).memory_bytes(), fine = scene_of(set, 16).memory_bytes();
  EXPECT_GE(coarse, 400u * 5 * 5 * 12);
  EXPECT_GE(fine, 400u * 17 * 17 * 12);
  EXPECT_LT(fine, 400u * 17 * 17 * 200);
}

/// A control point that goes far away and comes back leaves no trace.
TEST(Lifetime, AnOutlierThatIsTakenBackIsForgotten) {
  PatchSet set = value_of(PatchSet::make(closed_body()));
  RayScene scene = scene_of(set);
  const Ray ray{.origin = {}, .direction = {0.1, 0.2, 1}};
  const Hit before = scene.closest(ray);
  const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  std::vector<Vec3> far = points;
  far[5].x = 1e30;
  ASSERT_TRUE(set.set_control_points(0, far).ok());
  EXPECT_EQ(scene.refit().code(), StatusCode::unsupported);
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  ASSERT_TRUE(scene.refit().ok());
  const Hit after = scene.closest(ray);
  EXPECT_EQ(after.t, before.t);
  EXPECT_EQ(after.position, before.position);
}

/// Whether a scene can be made of a set, or a set and a mesh, of these types.
template <class... Source>
constexpr bool can_make = requires {
  RayScene::make(std::declval<Source>()...);
};

static_assert(can_make<PatchSet&> && can_make<const PatchSet&> && can_make<PatchSet> && can_make<PatchSet&, Mesh&>);
static_assert(!can_make<PatchSet&, Mesh> && !can_make<PatchSet, Mesh&>, "a scene refers to what it is made of");

}}  // namespace tessera::test
