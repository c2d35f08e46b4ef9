// Packing over threads: the same bytes and the same errors for any number of them, and patches that are moved in.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "support/grids.h"
#include "support/random_splines.h"
#include "tessera/convert.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

/// More patches and blocks than one piece of work holds.
std::vector<BezierPatch> many_patches() {
  Random random(91);
  return mixed_patches(random, 3, 120);
}

template <class T>
bool same_bytes(const T& a, const T& b) {
  return a.size() == b.size() && (a.size() == 0 || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

template <class T>
bool same_bytes(const Coefficients<T>& a, const Coefficients<T>& b) {
  return same_bytes(a.bernstein, b.bernstein) && same_bytes(a.power, b.power) &&
         same_bytes(a.bernstein_threshold, b.bernstein_threshold) && same_bytes(a.power_threshold, b.power_threshold);
}

TEST(Packing, TheSameBytesForAnyNumberOfThreads) {
  const std::vector<BezierPatch> patches = many_patches();
  const PatchSetOptions options{.blocks = {true, true, true, true}};
  tbb::task_arena alone(1), crowd(7);
  const PatchSet one = alone.execute([&] { return set_of(patches, options); });
  const PatchSet more = crowd.execute([&] { return set_of(patches, options); });
  EXPECT_TRUE(same_bytes(impl_of(one).f32, impl_of(more).f32));
  EXPECT_TRUE(same_bytes(impl_of(one).f64, impl_of(more).f64));
  EXPECT_EQ(one.origin(), more.origin());
}

/// A patch looks the same to its lane whether the set was packed at once or the patch was put there by an edit.
TEST(Packing, AnEditPacksAsTheSetDoes) {
  const std::vector<BezierPatch> patches = many_patches();
  const PatchSetOptions options{.blocks = {true, true, true, true}, .origin = Vec3{1, 2, 3}};
  std::vector<BezierPatch> moved;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = 2 * p + Vec3{1, 0, -1};
    moved.push_back(value_of(patch.with_points(points)));
  }
  PatchSet edited = set_of(patches, options);
  for (std::size_t k = 0; k < moved.size(); ++k) ASSERT_TRUE(edited.set_control_points(k, moved[k].points()).ok());
  const PatchSet packed = set_of(moved, options);
  EXPECT_TRUE(same_bytes(impl_of(edited).f32, impl_of(packed).f32));
  EXPECT_TRUE(same_bytes(impl_of(edited).f64, impl_of(packed).f64));
}

TEST(Packing, RefusesTheFirstPatchThatDoesNotFit) {
  Random random(92);
  std::vector<BezierPatch> patches(4000, random_polynomial(random, 2, 2));
  for (const std::size_t bad : {3900, 2500, 1203}) patches[bad] = random_polynomial(random, 2, 2, {}, 1e200);
  tbb::task_arena crowd(7);
  for (int round = 0; round < 20; ++round) {
    const Status status = crowd.execute([&] { return PatchSet::make(patches, {.origin = Vec3{}}).status(); });
    ASSERT_EQ(status.code(), StatusCode::non_finite);
    ASSERT_EQ(status.index(), 1203);
  }
}

TEST(Packing, AGridThatIsMovedGivesTheSameSet) {
  Random random(93);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 6; ++k) patches.push_back(random_polynomial(random, 3, 2));
  PatchGrid grid = value_of(PatchGrid::make({0, 1, 3}, {-1, 0, 2, 5}, patches, FitError{0.5, false}));
  const PatchSet copied = value_of(make_patch_set(std::span(&grid, 1)));
  const PatchSet moved = value_of(make_patch_set(std::move(grid)));
  EXPECT_TRUE(same_bytes(impl_of(copied).f32, impl_of(moved).f32));
  EXPECT_EQ(moved.fit_error().distance, 0.5);
  EXPECT_FALSE(moved.fit_error().certified);
  ASSERT_EQ(moved.patch_count(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(moved.patch(k).points().data(), patches[k].points().data());  // shared, not copied
    EXPECT_EQ(moved.source(k).domain.u0, copied.source(k).domain.u0);
    EXPECT_EQ(moved.source(k).domain.v1, copied.source(k).domain.v1);
  }
  EXPECT_EQ(moved.source(5).domain.u1, 3);
  EXPECT_EQ(moved.source(5).domain.v1, 5);
}

/// The set of a B-spline surface does not depend on the number of threads, nor on whether its patches come alone or
/// with the box that they were made with.
TEST(Packing, ASplineGivesTheSetOfItsPatches) {
  Random random(94);
  tbb::task_arena alone(1), crowd(7);
  const PatchSetOptions options{.blocks = {true, true, true, true}};
  for (const bool rational : {false, true}) {
    const BSplineSurface s = random_surface(random, 3, 2, {70}, {41}, rational);
    const auto make = [&] { return value_of(make_patch_set(value_of(to_bezier(s)), options)); };
    const PatchSet one = alone.execute(make), more = crowd.execute(make);
    const PatchGrid grid = value_of(to_bezier(s));
    std::vector<PatchSource> sources;
    for (std::size_t k = 0; k < grid.patches().size(); ++k) sources.push_back({0, grid.patch_domain(k)});
    PatchSetOptions with_sources = options;
    with_sources.sources = sources;
    const PatchSet patches = value_of(PatchSet::make(grid.patches(), with_sources));
    for (const PatchSet* set : {&more, &patches}) {
      EXPECT_TRUE(same_bytes(impl_of(one).f32, impl_of(*set).f32));
      EXPECT_TRUE(same_bytes(impl_of(one).f64, impl_of(*set).f64));
      EXPECT_EQ(one.origin(), set->origin());
      ASSERT_EQ(one.patch_count(), set->patch_count());
      for (std::size_t k = 0; k < one.patch_count(); ++k) EXPECT_EQ(one.source(k).domain, set->source(k).domain);
    }
  }
}

}}  // namespace tessera::test
