// Patch sets: packing, places, edits, errors.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "support/grids.h"
#include "support/reference.h"
#include "surface/net/homogeneous.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

TEST(PatchSet, EveryPatchHasItsOwnPlaceAmongItsLikes) {
  Random random(71);
  const PatchSet set = set_of(mixed_patches(random, 3, 5));
  std::set<std::pair<std::uint32_t, std::uint32_t>> places;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const PatchSet::Slot slot = set.slot(k);
    EXPECT_LT(slot.block, set.block_count());
    EXPECT_TRUE(places.emplace(slot.block, slot.lane).second);
    const BlockGroup& group = impl_of(set).group_of_block(slot.block);
    EXPECT_EQ(group.degree_u, set.patch(k).degree_u());
    EXPECT_EQ(group.degree_v, set.patch(k).degree_v());
    EXPECT_EQ(group.rational, set.patch(k).is_rational());
  }
  EXPECT_EQ(set.block_count(), 18u);  // 9 degrees, polynomial and rational; 5 patches each fit one block
}

/// Coefficients are (V - o) or (w (V - o), w), rounded once.
TEST(PatchSet, BlocksHoldTheRelativeNets) {
  Random random(72);
  PatchSetOptions options;
  options.blocks.double_bernstein = true;
  const PatchSet set = set_of(mixed_patches(random, 3), options);
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    const PatchSet::Slot slot = set.slot(k);
    const BlockGroup& group = impl_of(set).group_of_block(slot.block);
    const std::size_t first = group.first_value + (slot.block - group.first_block) * group.block_values + slot.lane;
    const double scale = patch.is_rational() ? power_of_two_near(std::ranges::max(patch.weights())) : 1;
    std::size_t value = first;
    for (int i = 0; i <= patch.degree_u(); ++i)
      for (int j = 0; j <= patch.degree_v(); ++j) {
        const double w = patch.weight(i, j) / scale;
        const Vec3 p = w * (patch.point(i, j) - set.origin());
        std::vector<double> expected = {p.x, p.y, p.z};
        if (patch.is_rational()) expected.push_back(w);
        for (const double x : expected) {
          EXPECT_EQ(impl_of(set).f32.bernstein[value], static_cast<float>(x));
          EXPECT_EQ(impl_of(set).f64.bernstein[value], x);
          value += PatchSet::lanes;
        }
      }
  }
}

TEST(PatchSet, OriginAndBox) {
  Random random(73);
  const std::vector<BezierPatch> patches = {random_polynomial(random, 3, 3, {100, 0, 0}),
                                            random_polynomial(random, 2, 4, {-50, 3, 3})};
  const PatchSet set = set_of(patches);
  EXPECT_EQ(set.origin(), set.box().centre());
  for (const BezierPatch& patch : patches)
    for (const Vec3& p : patch.points()) {
      Box3 box = set.box();
      box.extend(p);
      EXPECT_EQ(box.lower, set.box().lower);
      EXPECT_EQ(box.upper, set.box().upper);
    }
  EXPECT_EQ(set_of(patches, {.origin = Vec3{}}).origin(), Vec3{});
}

TEST(PatchSet, AnEditIsSeenAndCounted) {
  Random random(74);
  PatchSetOptions options;
  options.blocks = {true, true, true, true};
  PatchSet set = set_of(mixed_patches(random, 3, 4), options);
  const auto t = uniform_parameters(4);
  for (const std::size_t patch : {0u, 5u, 17u}) {
    const std::uint64_t before = set.revision();
    const auto points = random_points(random, set.patch(patch).degree_u(), set.patch(patch).degree_v());
    ASSERT_TRUE(set.set_control_points(patch, points).ok());
    EXPECT_EQ(set.revision(), before + 1);
    // A set made anew from the edited patches has the same origin option and must have the same blocks.
    std::vector<BezierPatch> patches;
    for (std::size_t k = 0; k < set.patch_count(); ++k) patches.push_back(set.patch(k));
    PatchSetOptions same = options;
    same.origin = set.origin();
    const PatchSet fresh = set_of(patches, same);
    EXPECT_TRUE(impl_of(fresh).f32.bernstein == impl_of(set).f32.bernstein);
    EXPECT_TRUE(impl_of(fresh).f32.power == impl_of(set).f32.power);
    EXPECT_TRUE(impl_of(fresh).f64.bernstein == impl_of(set).f64.bernstein);
    EXPECT_TRUE(impl_of(fresh).f64.power == impl_of(set).f64.power);
    EXPECT_TRUE(impl_of(fresh).f32.bernstein_threshold == impl_of(set).f32.bernstein_threshold);
    EXPECT_TRUE(impl_of(fresh).f32.power_threshold == impl_of(set).f32.power_threshold);
    EXPECT_TRUE(impl_of(fresh).f64.bernstein_threshold == impl_of(set).f64.bernstein_threshold);
    EXPECT_TRUE(impl_of(fresh).f64.power_threshold == impl_of(set).f64.power_threshold);
  }
}

TEST(PatchSet, ARefusedEditChangesNothing) {
  Random random(75);
  PatchSet set = set_of({random_polynomial(random, 3, 3), random_rational(random, 2, 2)});
  const auto blocks = impl_of(set).f32.bernstein;
  const auto points = std::vector<Vec3>(set.patch(0).points().begin(), set.patch(0).points().end());
  auto bad = points;
  bad[7].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(set.set_control_points(0, bad).code(), StatusCode::non_finite);
  EXPECT_EQ(set.set_control_points(0, bad).index(), 7);
  bad[7].y = 1e300;  // finite, but no float
  EXPECT_EQ(set.set_control_points(0, bad).code(), StatusCode::non_finite);
  bad.pop_back();
  EXPECT_EQ(set.set_control_points(0, bad).code(), StatusCode::count_mismatch);
  EXPECT_EQ(set.set_control_points(2, points).code(), StatusCode::invalid_argument);
  EXPECT_EQ(set.revision(), 0u);
  EXPECT_TRUE(blocks == impl_of(set).f32.bernstein);
  EXPECT_TRUE(std::ranges::equal(points, set.patch(0).points()));
}

TEST(PatchSet, RefusesWhatItCannotHold) {
  Random random(76);
  EXPECT_EQ(PatchSet::make({}).status().code(), StatusCode::invalid_argument);
  std::vector<BezierPatch> patches = {random_polynomial(random, 1, 1), random_polynomial(random, 1, 1, {}, 1e200)};
  const Status huge = PatchSet::make(patches).status();
  EXPECT_EQ(huge.code(), StatusCode::non_finite);
  EXPECT_EQ(huge.index(), 0);  // the origin is the centre of a box of 1e200: the small patch does not fit float either
  EXPECT_TRUE(PatchSet::make(patches, {.blocks = {false, true, false, false}}).ok());  // doubles hold it
  EXPECT_EQ(PatchSet::make(patches, {.origin = Vec3{0, std::numeric_limits<double>::infinity(), 0}}).status().code(),
            StatusCode::non_finite);
  const std::vector<PatchSource> one(1);
  EXPECT_EQ(PatchSet::make(patches, {.sources = one}).status().code(), StatusCode::count_mismatch);
  std::vector<PatchSource> flat(2);
  flat[1].domain = {0, 0, 0, 1};
  EXPECT_EQ(PatchSet::make(patches, {.sources = flat}).status().index(), 1);
}

/// Alternating signs give the largest power coefficients: 3^15 in each direction.
TEST(PatchSet, CoefficientsFitAsFarAsPromised) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i <= 15; ++i)
    for (int j = 0; j <= 15; ++j) {
      const double x = (i + j) % 2 == 0 ? 0x1p44 : -0x1p44;
      points.push_back({x, -x, x});
      weights.push_back((i + j) % 2 == 0 ? 1e308 : 1e300);
    }
  const std::vector<BezierPatch> patches{value_of(BezierPatch::polynomial(15, 15, points)),
                                         value_of(BezierPatch::rational(15, 15, points, weights))};
  const PatchSet set = set_of(patches, {.blocks = {true, true, true, true}});
  for (const auto* values : {&impl_of(set).f32.bernstein, &impl_of(set).f32.power})
    for (const float value : *values) ASSERT_TRUE(std::isfinite(value));
}

/// Patches whose derivatives would be infinite or NaN are an error. Small weights make them so sooner, by the square of
/// their ratio.
TEST(PatchSet, DerivativesOfWhatIsHeldAreNumbers) {
  const auto patch = [](double size, double weight) {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int i = 0; i <= 15; ++i)
      for (int j = 0; j <= 15; ++j) {
        const double x = (i + j) % 2 == 0 ? size : -size;
        points.push_back({x, -x, x});
        weights.push_back((i + j) % 2 == 0 ? 1 : weight);
      }
    return value_of(BezierPatch::rational(15, 15, points, weights));
  };
  for (const auto& [size, weight, held] : {std::tuple{5e33, 1.0, true},
                                           {1e34, 1.0, false},
                                           {5e29, 1e-2, true},
                                           {1e30, 1e-2, false},
                                           {5e15, 1e-9, true},
                                           {1e16, 1e-9, false}}) {
    const auto set = PatchSet::make(std::vector{patch(size, weight)}, {.origin = Vec3{}});
    ASSERT_EQ(set.ok(), held) << size << ' ' << weight;
    if (!held) continue;
    const auto t = uniform_parameters(7);
    const GridPlan plan = value_of(GridPlan::make(*set, t, t));
    AllBuffers<float> out(plan);
    ASSERT_TRUE(evaluate(*set, plan, out.views()).ok());
    for (const auto& values : out.values)
      for (const float x : values) ASSERT_TRUE(std::isfinite(x)) << size << ' ' << weight;
  }
}

TEST(Model, SurfacesBecomeSources) {
  Random random(77);
  Model model;
  for (int k = 0; k < 5; ++k) model.surfaces.push_back({"patch " + std::to_string(k), random_polynomial(random, 3, 3)});
  const PatchSet set = value_of(make_patch_set(model));
  EXPECT_EQ(set.surface_count(), 5u);
  for (std::uint32_t k = 0; k < 5; ++k) EXPECT_EQ(set.source(k).surface, k);
  EXPECT_EQ(make_patch_set(Model{}).status().code(), StatusCode::invalid_argument);
}

}}  // namespace tessera::test
