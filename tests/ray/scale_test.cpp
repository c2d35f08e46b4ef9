// Models of any size and place, origins far away.

#include <cmath>

#include "ray_support.h"

namespace tessera::test { namespace {

struct Place {
  const char* name;
  double scale;
  Vec3 shift;
};

class Places : public testing::TestWithParam<Place> {};

TEST_P(Places, SphereFromOutside) {
  const auto [name, scale, shift] = GetParam();
  const PatchSet set = set_of(placed(sphere(), scale, shift));
  const RayScene scene = scene_of(set);
  // The resolution of double at the model's place, and a share of the size.
  const double tolerance = 1e-9 * scale + 1e-14 * max_abs(shift);
  Random random(31);
  for (const double distance : {1.5, 30.0, 1e4, 1e6}) {
    for (int k = 0; k < 300; ++k) {
      const Vec3 away = normalized(random_direction(random)), target = normalized(random_direction(random));
      const Vec3 from = shift + scale * distance * away, to = shift + scale * target;
      const Vec3 d = normalized(to - from);
      if (std::abs(dot(d, target)) < 0.2) continue;  // not at the silhouette
      const Hit hit = scene.closest(ray(from, d));
      ASSERT_EQ(hit.kind, HitKind::hit);
      EXPECT_FALSE(hit.flags.unrefined);
      // A far origin rounds the ray itself.
      const double far = tolerance + 1e-15 * distance * scale;
      if (dot(d, target) < 0) {
        EXPECT_LT(length(hit.position - to), 10 * far);
      }
      EXPECT_NEAR(length(hit.position - shift), scale, far);
      EXPECT_NEAR(hit.t, length(hit.position - from), 4 * far);
    }
  }
}

TEST_P(Places, NothingLeaks) {
  const auto [name, scale, shift] = GetParam();
  const PatchSet set = set_of(placed(closed_body(), scale, shift));
  const RayScene scene = scene_of(set);
  Random random(32);
  std::vector<Ray> rays;
  for (int k = 0; k < 20000; ++k)
    rays.push_back(ray(shift + 0.3 * scale * random_direction(random), random_direction(random)));
  std::size_t missed = 0;
  for (const Hit& hit : closest(scene, rays)) missed += hit.kind != HitKind::hit;
  EXPECT_EQ(missed, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scales, Places,
                         testing::Values(Place{"unit", 1, {}}, Place{"off_zero", 5, {1e6, -1e6, 1e6}},
                                         Place{"small", 1e-6, {}}, Place{"large", 1e6, {}},
                                         Place{"small_off_zero", 1e-6, {0.01, 0.02, -0.01}},
                                         Place{"large_off_zero", 1e6, {1e8, 0, 0}}),
                         [](const auto& place) { return place.param.name; });

TEST(Scales, BeyondFloatIsAnError) {
  RaySceneOptions grid;
  grid.mode = RayMode::grid;
  for (const double scale : {1e13, 1e-11}) {
    const PatchSet set = set_of(placed(sphere(), scale, {}));
    EXPECT_EQ(RayScene::make(set, grid).status().code(), StatusCode::unsupported);
    const Hit hit = value_of(RayScene::make(set)).closest(ray({0, 0, 3 * scale}, {0.1, 0.2, -1}));
    EXPECT_EQ(hit.kind, HitKind::hit);
    EXPECT_NEAR(length(hit.position), scale, 1e-13 * scale);
  }
}

}}  // namespace tessera::test
