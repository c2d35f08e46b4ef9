// Updates of touched patches: the same bytes as edits one by one and evaluation of all, and nothing else is written.

#include "tessera/evaluate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <limits>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "support/allocations.h"
#include "support/points.h"

namespace tessera::test { namespace {

PatchSetOptions every_kind() {
  PatchSetOptions options;
  options.blocks = {true, true, true, true, true, true};
  options.origin = Vec3{0.25, -0.5, 1};
  return options;
}

/// New points for some patches, in any order.
struct Edits {
  std::vector<std::uint32_t> patch;
  std::vector<Vec3> points;

  void add(const PatchSet& set, std::size_t of, const std::vector<Vec3>& net) {
    ASSERT_EQ(net.size(), set.patch(of).points().size());
    patch.push_back(static_cast<std::uint32_t>(of));
    points.insert(points.end(), net.begin(), net.end());
  }
  operator PatchEdits() const { return {patch, points}; }
};

/// Edits of `count` patches; one in four becomes degenerate: an edge or all of it is one point.
Edits random_edits(Random& random, const PatchSet& set, std::size_t count) {
  Edits edits;
  std::vector<std::size_t> order = shuffled_order(random, set.patch_count());
  order.resize(count);
  for (const std::size_t k : order) {
    const BezierPatch& patch = set.patch(k);
    auto net = random_points(random, patch.degree_u(), patch.degree_v());
    const std::size_t same = random() % 8;  // 0: the first row, 1: all
    if (same == 0) std::fill_n(net.begin(), patch.degree_v() + 1, net[0]);
    if (same == 1) std::fill(net.begin(), net.end(), net[0]);
    edits.add(set, k, net);
  }
  return edits;
}

void edit_one_by_one(PatchSet& set, const Edits& edits) {
  std::size_t next = 0;
  for (const std::uint32_t k : edits.patch) {
    const std::size_t size = set.patch(k).points().size();
    ASSERT_TRUE(set.set_control_points(k, std::span(edits.points).subspan(next, size)).ok());
    next += size;
  }
}

template <class T>
void expect_same_coefficients(const Coefficients<T>& a, const Coefficients<T>& b) {
  EXPECT_TRUE(a.bernstein == b.bernstein);
  EXPECT_TRUE(a.power == b.power);
  EXPECT_TRUE(a.bernstein_threshold == b.bernstein_threshold);
  EXPECT_TRUE(a.power_threshold == b.power_threshold);
  EXPECT_TRUE(a.points == b.points);
  EXPECT_TRUE(a.point_threshold == b.point_threshold);
  EXPECT_EQ(a.largest_threshold, b.largest_threshold);
}
void expect_same_sets(const PatchSet& a, const PatchSet& b) {
  expect_same_coefficients(impl_of(a).f32, impl_of(b).f32);
  expect_same_coefficients(impl_of(a).f64, impl_of(b).f64);
  for (std::size_t k = 0; k < a.patch_count(); ++k) {
    EXPECT_TRUE(std::ranges::equal(a.patch(k).points(), b.patch(k).points()));
    EXPECT_EQ(impl_of(a).collapsed[k].bits, impl_of(b).collapsed[k].bits);
  }
}

Status run_in(int threads, GridUpdate& update, PatchSet& set, const GridPlan& plan, const Edits& edits, const auto& out,
              const Execution& execution = {}) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Status status;
  arena.execute([&] { status = update.run(set, plan, edits, out, execution); });
  return status;
}

template <class T>
void compare_with_full(const std::vector<BezierPatch>& patches, Representation representation, Isa isa, int threads) {
  Random random(901);
  const auto t = uniform_parameters(5);
  PatchSet set = set_of(patches, every_kind()), expected = set_of(patches, every_kind());
  const GridPlan plan =
      value_of(GridPlan::make(set, t, t, {.precision = precision_of<T>, .representation = representation, .isa = isa}));
  GridUpdate update = value_of(GridUpdate::make(set));
  AllBuffers<T> grids(plan), full(plan);
  ASSERT_TRUE(evaluate(set, plan, grids.views()).ok());
  for (const std::size_t count : {std::size_t{1}, patches.size() / 5, patches.size() / 2, patches.size()}) {
    const Edits edits = random_edits(random, set, count);
    const std::uint64_t revision = set.revision();
    ExecutionReport report;
    ASSERT_TRUE(run_in(threads, update, set, plan, edits, grids.views(), {.report = &report}).ok());
    EXPECT_EQ(report.isa, isa);
    EXPECT_EQ(set.revision(), revision + 1);
    edit_one_by_one(expected, edits);
    expect_same_sets(set, expected);
    ASSERT_TRUE(evaluate(expected, plan, full.views()).ok());
    EXPECT_TRUE(grids == full) << count << " " << name(isa);
  }
}

TEST(Update, SameBytesAsEditsOneByOneAndFullEvaluation) {
  Random random(902);
  const std::vector<BezierPatch> mixed = mixed_patches(random, 3, 5), field = test::wavy_field(23, 31);
  for (const Isa isa : available_isas()) {
    compare_with_full<float>(mixed, Representation::bernstein, isa, 1);
    compare_with_full<double>(mixed, Representation::bernstein, isa, 2);
    compare_with_full<float>(field, Representation::bernstein, isa, 2);
  }
  compare_with_full<float>(mixed, Representation::power, available_isas().back(), 8);
  compare_with_full<double>(field, Representation::power, available_isas().back(), 8);
}

/// Positions and normals in blocks: touched ones equal those of a full evaluation, all other memory is unchanged.
TEST(Update, BlocksAreThoseOfFullEvaluation) {
  Random random(905);
  const auto patches = mixed_patches(random, 3, 9);
  const auto t = uniform_parameters(5);
  for (const Isa isa : available_isas()) {
    PatchSet set = set_of(patches, every_kind()), expected = set_of(patches, every_kind());
    const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = isa}));
    GridUpdate update = value_of(GridUpdate::make(set));
    AlignedVector<float> position(plan.block_capacity()), normal(position.size()), full(position.size()),
        full_normal(position.size());
    ASSERT_TRUE(evaluate(set, plan, QuantityBlocks<float>{.position = position, .normal = normal}).ok());
    for (const std::size_t count : {std::size_t{1}, patches.size() / 4, patches.size()}) {
      const Edits edits = random_edits(random, set, count);
      std::vector<bool> touched(position.size() / (3 * PatchSet::lanes * plan.count_u() * plan.count_v()), false);
      for (const std::uint32_t patch : edits.patch) touched[set.slot(patch).block] = true;
      const std::size_t block_values = position.size() / touched.size();
      for (std::size_t block = 0; block < touched.size(); ++block)
        if (!touched[block])
          std::fill_n(position.begin() + static_cast<std::ptrdiff_t>(block * block_values), block_values, -7.0f);
      ASSERT_TRUE(
          run_in(3, update, set, plan, edits, QuantityBlocks<float>{.position = position, .normal = normal}).ok());
      edit_one_by_one(expected, edits);
      expect_same_sets(set, expected);
      ASSERT_TRUE(evaluate(expected, plan, QuantityBlocks<float>{.position = full, .normal = full_normal}).ok());
      EXPECT_TRUE(normal == full_normal);
      for (std::size_t k = 0; k < position.size(); ++k)
        ASSERT_EQ(position[k], touched[k / block_values] ? full[k] : -7.0f) << k;
      position = full;
    }
  }
}

TEST(Update, ParametersOfEachPatchAreRefused) {
  PatchSet set = set_of(wavy_field(2, 2), {});
  const std::vector<double> t(12, 0.5);
  const GridPlan plan = value_of(GridPlan::make(set, PatchParameters{t, t}));
  GridUpdate update = value_of(GridUpdate::make(set));
  AllBuffers<float> grids(plan);
  const Status status = update.run(set, plan, PatchEdits{}, grids.views());
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_NE(status.message().find("parameters"), std::string::npos);
}

TEST(Update, OtherRecordsAreNotTouched) {
  Random random(903);
  PatchSet set = set_of(mixed_patches(random, 3, 9), every_kind());
  const auto t = uniform_parameters(4);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  const Edits edits = random_edits(random, set, 20);
  GridBuffers<float> grids(plan), full(plan);
  ASSERT_TRUE(update.run(set, plan, edits, grids.views()).ok());
  ASSERT_TRUE(evaluate(set, plan, full.views()).ok());
  const GridBuffers<float> canaries(plan);
  const std::size_t values = 3 * t.size() * t.size();
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const bool edited = std::ranges::count(edits.patch, k) > 0;
    const auto at = [&](const std::vector<float>& all) { return std::span(all).subspan(k * values, values); };
    const GridBuffers<float>& expected = edited ? full : canaries;
    EXPECT_TRUE(std::ranges::equal(at(grids.position), at(expected.position))) << k;
    EXPECT_TRUE(std::ranges::equal(at(grids.dv), at(expected.dv))) << k;
    EXPECT_TRUE(std::ranges::equal(at(grids.normal), at(expected.normal))) << k;
  }
}

void expect_bad_views(GridUpdate& update, PatchSet& set, const GridPlan& plan, const Edits& edits,
                      QuantityViews<float> views) {
  views.position.size = plan.capacity() - 1;
  EXPECT_EQ(update.run(set, plan, edits, views).code(), StatusCode::buffer_too_small);
  EXPECT_EQ(update.run(set, plan, edits, QuantityViews<float>{}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(update.run(set, plan, edits, QuantityViews<double>{}).code(), StatusCode::invalid_argument);
}

TEST(Update, BadEditsAreRefusedBeforeAnythingIsWritten) {
  Random random(904);
  const std::vector<BezierPatch> patches = mixed_patches(random, 3, 2);
  PatchSet set = set_of(patches, every_kind());
  const PatchSet before = set_of(patches, every_kind());
  const auto t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  GridBuffers<float> grids(plan);
  const GridBuffers<float> canaries(plan);
  const auto refused = [&](const Edits& edits, StatusCode code, std::ptrdiff_t index) {
    const Status status = update.run(set, plan, edits, grids.views());
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.index(), index);
    EXPECT_TRUE(grids == canaries);
    EXPECT_EQ(set.revision(), 0u);
    expect_same_sets(set, before);
  };
  const Edits good = random_edits(random, set, 30);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    Edits edits = good;
    edits.points.back().y = bad;
    refused(edits, StatusCode::non_finite, 29);
    edits.points.front().z = bad;
    refused(edits, StatusCode::non_finite, 0);
  }
  Edits edits = good;
  edits.patch[17] = static_cast<std::uint32_t>(patches.size());
  refused(edits, StatusCode::invalid_argument, 17);
  edits.patch[17] = edits.patch[3];
  refused(edits, StatusCode::invalid_argument, 17);
  edits = good;
  edits.points.pop_back();
  refused(edits, StatusCode::count_mismatch, -1);
  edits.points.resize(good.points.size() + 1);
  refused(edits, StatusCode::count_mismatch, -1);
  expect_bad_views(update, set, plan, good, grids.views());
  PatchSet other = set_of({patches.begin(), patches.begin() + 3});
  const GridPlan its = value_of(GridPlan::make(other, t, t));
  EXPECT_EQ(update.run(other, its, {}, grids.views()).code(), StatusCode::stale);
  refused(edits, StatusCode::count_mismatch, -1);
  ASSERT_TRUE(update.run(set, plan, good, grids.views()).ok());
  ASSERT_TRUE(update.run(set, plan, {}, grids.views()).ok());
  EXPECT_EQ(set.revision(), 1u);
}

/// Far points are checked one by one: all that set_control_points accepts is accepted.
TEST(Update, FarPointsThatFitAreTaken) {
  Random random(905);
  PatchSet set = set_of({random_polynomial(random, 3, 3), random_rational(random, 2, 2)}, every_kind());
  const auto t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  GridBuffers<float> grids(plan);
  for (const double far : {1e9, 1e16, 1e25, 1e30, 1e33, 1e36, 1e39}) {
    PatchSet expected = set_of({set.patch(0), set.patch(1)}, every_kind());
    for (const std::uint32_t k : {0u, 1u}) {
      Edits edits;
      std::vector<Vec3> net(set.patch(k).points().begin(), set.patch(k).points().end());
      net[4].x = far;
      edits.add(set, k, net);
      EXPECT_EQ(update.run(set, plan, edits, grids.views()).code(), expected.set_control_points(k, net).code()) << far;
    }
    expect_same_sets(set, expected);
  }
}

TEST(Update, CopiesOfPatchesKeepTheirPoints) {
  Random random(906);
  const std::vector<BezierPatch> patches = mixed_patches(random, 2, 2);
  PatchSet set = set_of(patches);
  std::vector<std::vector<Vec3>> points;
  for (const BezierPatch& patch : patches) points.emplace_back(patch.points().begin(), patch.points().end());
  const auto t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  GridBuffers<float> grids(plan);
  const Edits first = random_edits(random, set, patches.size()), second = random_edits(random, set, patches.size());
  ASSERT_TRUE(update.run(set, plan, first, grids.views()).ok());
  const BezierPatch copy = set.patch(first.patch[0]);
  const std::vector<Vec3> copied(copy.points().begin(), copy.points().end());
  ASSERT_TRUE(update.run(set, plan, second, grids.views()).ok());
  EXPECT_TRUE(std::ranges::equal(copy.points(), copied));
  EXPECT_FALSE(std::ranges::equal(set.patch(first.patch[0]).points(), copied));
  for (std::size_t k = 0; k < patches.size(); ++k) EXPECT_TRUE(std::ranges::equal(patches[k].points(), points[k]));
}

TEST(Update, NothingIsAllocatedAfterTheFirst) {
  Random random(907);
  PatchSet set = set_of(mixed_patches(random, 3, 9), every_kind());
  const auto t = uniform_parameters(6);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  AllBuffers<float> grids(plan);
  const QuantityViews<float> views = grids.views();
  const Edits all = random_edits(random, set, set.patch_count()), some = random_edits(random, set, 31);
  ASSERT_TRUE(update.run(set, plan, all, views).ok());
  const std::size_t before = allocation_count();
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(update.run(set, plan, all, views).ok());
    ASSERT_TRUE(update.run(set, plan, some, views).ok());
  }
  EXPECT_EQ(allocation_count(), before);
}

/// A patch has its new points and its new grid, or neither.
TEST(Update, CancellationLeavesEachPatchWhole) {
  Random random(908);
  const std::vector<BezierPatch> patches = test::wavy_field(60, 40);
  PatchSet set = set_of(patches);
  const auto t = uniform_parameters(9);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridUpdate update = value_of(GridUpdate::make(set));
  GridBuffers<float> grids(plan), full(plan);
  const GridBuffers<float> canaries(plan);
  const Edits edits = random_edits(random, set, patches.size());
  std::atomic<bool> cancel{true};
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_EQ(update.run(set, plan, edits, grids.views(), execution).code(), StatusCode::cancelled);
  cancel = false;
  execution.progress = [&](double share) { cancel = share > 0.3; };
  EXPECT_EQ(update.run(set, plan, edits, grids.views(), execution).code(), StatusCode::cancelled);
  ASSERT_TRUE(evaluate(set, plan, full.views()).ok());
  std::size_t written = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const bool edited = !std::ranges::equal(set.patch(k).points(), patches[k].points());
    const auto at = [&](const std::vector<float>& all) { return std::span(all).subspan(3 * 81 * k, 3 * 81); };
    ASSERT_TRUE(std::ranges::equal(at(grids.position), at(edited ? full.position : canaries.position))) << k;
    written += edited;
  }
  EXPECT_GT(written, 0u);
  EXPECT_LT(written, patches.size());
}

}}  // namespace tessera::test
