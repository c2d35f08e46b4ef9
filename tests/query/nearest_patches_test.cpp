// The nearest points of several patches, beside scenes that hold one patch each.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "support/torus.h"
#include "tessera/nearest_points.h"

namespace tessera::test { namespace {

/// Distances of the nearest points of each patch alone, the smallest first.
std::vector<double> distances_of(const std::vector<PointScene>& each, const Vec3& point) {
  std::vector<double> out;
  for (const PointScene& one : each) out.push_back(one.nearest(point).distance);
  std::ranges::sort(out);
  return out;
}

void expect_nearest_patches(const std::vector<BezierPatch>& patches, double reach) {
  const PatchSet set = value_of(PatchSet::make(patches));
  const PointScene scene = value_of(PointScene::make(set));
  std::vector<PointScene> each;
  for (const BezierPatch& patch : patches)
    each.push_back(value_of(PointScene::make(value_of(PatchSet::make(std::vector<BezierPatch>{patch})))));
  Random random(3);
  std::vector<Vec3> points;
  for (int k = 0; k < 50; ++k) points.push_back(reach * uniform_vector(random, -1, 1));
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{7}, patches.size(), patches.size() + 2}) {
    std::vector<NearestPoint> found(points.size() * count);
    ASSERT_TRUE(scene.nearest_patches(points, count, found).ok());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::vector<double> expected = distances_of(each, points[k]);
      std::set<std::uint32_t> seen;
      for (std::size_t j = 0; j < count; ++j) {
        const NearestPoint& one = found[k * count + j];
        EXPECT_TRUE(one.flags.certified);
        ASSERT_EQ(one.kind, j < patches.size() ? NearestKind::found : NearestKind::none);
        if (j >= patches.size()) continue;
        EXPECT_NEAR(one.distance, expected[j], 1e-12 * reach) << "point " << k << ", patch " << j << " of " << count;
        EXPECT_NEAR(length(one.position - points[k]), one.distance, 1e-12 * reach);
        EXPECT_TRUE(seen.insert(one.patch).second);
      }
    }
  }
}

TEST(NearestPatches, OfATorus) { expect_nearest_patches(Torus(5).patches(true), 2); }

TEST(NearestPatches, OfScatteredPatches) {
  Random random(9);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 30; ++k) {
    const Vec3 at = uniform_vector(random, -1, 1);
    std::vector<Vec3> net;
    for (int j = 0; j < 16; ++j)
      net.push_back(at + Vec3{0.2 * (j / 4), 0.2 * (j % 4), 0} + 0.1 * uniform_vector(random, -1, 1));
    patches.push_back(polynomial(3, 3, net));
  }
  expect_nearest_patches(patches, 1.5);
}

TEST(NearestPatches, WithinALargestDistanceAndOfWrongInput) {
  const PatchSet set = value_of(PatchSet::make(Torus(4).patches(false)));
  const PointScene scene = value_of(PointScene::make(set));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points{set.box().centre(), {nan, 0, 0}, {1e12, 0, 0}};
  std::vector<NearestPoint> found(3 * points.size());
  const double near = scene.nearest(points[0]).distance;
  ASSERT_TRUE(scene.nearest_patches(points, 3, found, 0.5 * near).ok());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_EQ(found[k].kind, k / 3 == 1 ? NearestKind::invalid_point : NearestKind::none);
  EXPECT_EQ(scene.nearest_patches(points, 0, found).code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.nearest_patches(points, std::size_t{1} << 40, found).code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.nearest_patches(points, 4, found).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(scene.nearest_patches(points, 2, found, nan).code(), StatusCode::invalid_argument);
  EXPECT_TRUE(scene.nearest_patches({}, 2, {}).ok());
}

}}  // namespace tessera::test
