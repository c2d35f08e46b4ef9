// Scattered points: the same bytes for every form of the call, degenerate points, edits.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "support/allocations.h"
#include "support/points.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

template <class T>
AllBuffers<T> run(const PatchSet& set, const Samples<T>& samples, Isa isa, int threads, ExecutionReport& report) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Execution execution;
  execution.report = &report;
  AllBuffers<T> out(samples.size());
  arena.execute([&] { out = all_outputs(set, samples, {.isa = isa}, execution); });
  return out;
}

template <class T>
void compare_points(const std::vector<BezierPatch>& patches, std::size_t count) {
  Random random(311);
  const PatchSet set = set_of(patches, with_points());
  const Samples<T> samples = random_samples<T>(random, set.patch_count(), count);
  std::vector<AllBuffers<T>> by_isa;
  for (const Isa isa : available_isas()) {
    ExecutionReport report;
    by_isa.push_back(run(set, samples, isa, 1, report));
    EXPECT_GT(report.tasks, 2u) << "too little work to be shared";
    EXPECT_EQ(report.isa, isa);
    EXPECT_TRUE(by_isa.back() == run(set, samples, isa, 2, report)) << name(isa);
    EXPECT_TRUE(by_isa.back() == run(set, samples, isa, 8, report)) << name(isa);
  }
  if (by_isa.size() < 3) GTEST_SKIP() << "this machine lacks AVX-512";
  EXPECT_TRUE(by_isa[1] == by_isa[2]);
  EXPECT_FALSE(by_isa[0] == by_isa[1]) << "SSE2 can't round like AVX2";
}

TEST(Points, SameBytesForAnyThreadsAndOnEveryIsaOfOneDegree) {
  compare_points<float>(test::wavy_field(9, 11), 20000);
  compare_points<double>(test::wavy_field(9, 11), 9000);
}
TEST(Points, SameBytesForAnyThreadsAndOnEveryIsaOfMixedDegrees) {
  Random random(312);
  const std::vector<BezierPatch> patches = mixed_patches(random, 4, 2);
  compare_points<float>(patches, 9000);
  compare_points<double>(patches, 9000);
}

/// A set that was made without coefficients for points gives the same bytes, before and after edits.
template <class T>
void compare_on_demand(const std::vector<BezierPatch>& patches) {
  Random random(331);
  PatchSet with = set_of(patches, with_points()), without = set_of(patches);
  const Samples<T> samples = random_samples<T>(random, with.patch_count(), 3000);
  for (int edit = 0; edit < 3; ++edit) {
    std::vector<AllBuffers<T>> found(4, AllBuffers<T>(0));
    std::vector<std::thread> threads;  // of which all, or some, pack at once
    for (AllBuffers<T>& to : found) threads.emplace_back([&] { to = all_outputs(without, samples, {}); });
    for (std::thread& thread : threads) thread.join();
    const AllBuffers<T> wanted = all_outputs(with, samples, {});
    for (const AllBuffers<T>& of : found) EXPECT_EQ(of.values, wanted.values) << edit;
    const std::span<const Vec3> old = with.patch(static_cast<std::size_t>(edit)).points();
    std::vector<Vec3> points(old.begin(), old.end());
    for (Vec3& p : points) p.z += 1;
    for (PatchSet* set : {&with, &without})
      ASSERT_TRUE(set->set_control_points(static_cast<std::size_t>(edit), points).ok());
  }
}
TEST(Points, SetsWithoutCoefficientsPackThemOnDemand) {
  Random random(332);
  const std::vector<BezierPatch> patches = mixed_patches(random, 3);
  compare_on_demand<float>(patches);
  compare_on_demand<double>(patches);
}

TEST(Points, CoefficientsOnDemandAreKeptUntilAnEdit) {
  PatchSet set = set_of(test::wavy_field(2, 3));
  const std::size_t before = set.memory_bytes();
  AllBuffers<float> none(1);
  EXPECT_TRUE(evaluate(set, PatchSamples<float>{}, none.views()).ok());
  EXPECT_EQ(set.memory_bytes(), before);
  Random random(333);
  const Samples<float> samples = random_samples<float>(random, set.patch_count(), 10);
  AllBuffers<float> out(samples.size());
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(evaluate(set, samples.views(), out.views(), {}, {.cancel = &cancel}).code(), StatusCode::cancelled);
  EXPECT_TRUE(evaluate(set, samples.views(), out.views()).ok());
  EXPECT_GE(set.memory_bytes(), before + 6 * 192);
  const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
  ASSERT_TRUE(set.set_control_points(0, points).ok());
  EXPECT_LT(set.memory_bytes(), before + 6 * 192);
}

/// A sample's values depend neither on its neighbours nor on the kernel that their order selects.
template <class T>
void compare_orders(const PatchSet& set, const Samples<T>& samples, const std::vector<std::size_t>& order) {
  const Samples<T> ordered = samples.in_order(order);
  for (const Isa isa : available_isas()) {
    const AllBuffers<T> a = all_outputs(set, samples, {.isa = isa}), b = all_outputs(set, ordered, {.isa = isa});
    for (std::size_t k = 0; k < order.size(); ++k) {
      ASSERT_EQ(b.normal_kind[k], a.normal_kind[order[k]]);
      ASSERT_EQ(b.curvature_kind[k], a.curvature_kind[order[k]]);
      for (std::size_t i = 0; i < a.values.size(); ++i) {
        const std::size_t width = a.values[i].size() / order.size();
        for (std::size_t c = 0; c < width; ++c)
          ASSERT_EQ(b.values[i][k * width + c], a.values[i][order[k] * width + c]) << name(isa) << " " << i;
      }
    }
  }
}
template <class T>
void compare_sorted(const std::vector<BezierPatch>& patches) {
  Random random(313);
  const PatchSet set = set_of(patches, with_points());
  const Samples<T> samples = random_samples<T>(random, set.patch_count(), 5000);
  std::vector<std::size_t> order = shuffled_order(random, samples.size());
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return samples.patch[k]; });
  compare_orders(set, samples, order);
}
TEST(Points, OrderDoesNotMatter) {
  Random random(314);
  compare_sorted<float>(test::wavy_field(5, 7));
  compare_sorted<double>(test::wavy_field(5, 7));
  compare_sorted<float>(mixed_patches(random, 3));
  compare_sorted<float>(test::sphere());
}
TEST(Points, OrderDoesNotMatterWherePatchesAreFetchedAhead) {
  const std::vector<BezierPatch> patches = test::wavy_field(60, 100);
  compare_sorted<float>(patches);
  compare_sorted<double>(patches);
}

/// Runs of one patch of every length around the lanes of a vector, between samples of others.
template <class T>
void compare_runs(const std::vector<BezierPatch>& patches) {
  Random random(319);
  const PatchSet set = set_of(patches, with_points());
  Samples<T> samples = random_samples<T>(random, set.patch_count(), 4200);
  for (std::size_t k = 0, run = 0; k < samples.size(); run = (run + 1) % 41)
    for (const std::size_t first = k; k < std::min(samples.size(), first + 1 + run); ++k)
      samples.patch[k] = samples.patch[first];
  compare_orders(set, samples, shuffled_order(random, samples.size()));
}
TEST(Points, RunsOfEveryLengthAreWhatTheirSamplesAreAlone) {
  Random random(320);
  compare_runs<float>(test::wavy_field(5, 7));
  compare_runs<double>(test::wavy_field(5, 7));
  compare_runs<float>(mixed_patches(random, 3));
  compare_runs<double>(mixed_patches(random, 3));
}

TEST(Points, EachOutputAloneIsWhatItIsAmongOthers) {
  Random random(315);
  const PatchSet set = set_of(mixed_patches(random, 3), with_points());
  const Samples<float> samples = random_samples<float>(random, set.patch_count(), 500);
  const AllBuffers<float> all = all_outputs(set, samples);
  std::size_t k = 0;
  for_each_value_quantity([&](const auto& output) {
    AllBuffers<float> alone(samples.size());
    QuantityViews<float> out;
    const QuantityViews<float> views = alone.views();
    output.of(out) = output.of(views);
    ASSERT_TRUE(evaluate(set, samples.views(), out).ok());
    EXPECT_TRUE(alone.values[k] == all.values[k]) << output.name;
    ++k;
  });
  AllBuffers<float> kinds(samples.size());
  ASSERT_TRUE(evaluate(set, samples.views(), {.normal_kind = kinds.views().normal_kind}).ok());
  EXPECT_EQ(kinds.normal_kind, all.normal_kind);
  ASSERT_TRUE(evaluate(set, samples.views(), {.curvature_kind = kinds.views().curvature_kind}).ok());
  EXPECT_EQ(kinds.curvature_kind, all.curvature_kind);
}

/// A cap whose edge u = 0 is one point, on every edge in turn; the sphere's poles; patches that are a curve or a point.
std::vector<BezierPatch> degenerate_samples() {
  const Vec3 pole{0, 0, 1};
  const BezierPatch cap =
      polynomial(2, 2, {pole, pole, pole, {0.5, 0, 1}, {0.5, 0.5, 1}, {0, 0.5, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  std::vector<BezierPatch> patches = sphere();
  for (int way = 0; way < 8; ++way) patches.push_back(reoriented(cap, way));
  patches.push_back(polynomial(1, 1, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}));
  patches.push_back(polynomial(1, 2, {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {0, 0, 0}, {1, 1, 0}, {2, 0, 0}}));
  return patches;
}

/// Kinds equal the grid's; normals do so within the rounding of limits.
template <class T>
void compare_degenerate(Isa isa) {
  const PatchSet set = set_of(degenerate_samples(), with_points());
  const std::vector<double> t = {0, 0.25, 0.5, 1};
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.precision = precision_of<T>, .isa = isa}));
  AllBuffers<T> grid(plan);
  ASSERT_TRUE(evaluate(set, plan, grid.views()).ok());
  Samples<T> samples;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (const double u : t)
      for (const double v : t) samples.add(k, static_cast<T>(u), static_cast<T>(v));
  AllBuffers<T> points = all_outputs(set, samples, {.isa = isa});
  EXPECT_EQ(points.normal_kind, grid.normal_kind);
  EXPECT_EQ(points.curvature_kind, grid.curvature_kind);
  EXPECT_GT(std::ranges::count(points.normal_kind, NormalKind::limit), 0);
  EXPECT_GE(std::ranges::count(points.normal_kind, NormalKind::undefined), 32);
  const QuantityViews<T> a = points.views(), b = grid.views();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_TRUE(within_units(read(a.normal, k), read(b.normal, k), sizeof(T) == 4 ? 1e-6 : 1e-13, 1)) << k;
    if (points.normal_kind[k] == NormalKind::undefined) {
      EXPECT_EQ(read(a.normal, k), Vec3{});
    }
  }
}
TEST(Points, DegeneratePointsAsInGrids) {
  for (const Isa isa : available_isas()) {
    compare_degenerate<float>(isa);
    compare_degenerate<double>(isa);
  }
}

TEST(Points, EditsAreSeenAsIfTheSetWereNew) {
  Random random(316);
  std::vector<BezierPatch> patches = mixed_patches(random, 3);
  const PatchSetOptions options = [] {
    PatchSetOptions fixed = with_points();
    fixed.origin = Vec3{};
    return fixed;
  }();
  PatchSet set = set_of(patches, options);
  for (std::size_t k = 0; k < patches.size(); k += 3) {
    const auto points = random_points(random, patches[k].degree_u(), patches[k].degree_v(), {}, k % 2 ? 3 : 1e-3);
    ASSERT_TRUE(set.set_control_points(k, points).ok());
    patches[k] = value_of(patches[k].with_points(points));
  }
  const Samples<float> floats = random_samples<float>(random, patches.size(), 2000);
  const Samples<double> doubles = random_samples<double>(random, patches.size(), 2000);
  EXPECT_TRUE(all_outputs(set, floats) == all_outputs(set_of(patches, options), floats));
  EXPECT_TRUE(all_outputs(set, doubles) == all_outputs(set_of(patches, options), doubles));
}

TEST(Points, NothingIsAllocatedWhenEvaluatingAgain) {
  Random random(317);
  const PatchSet set = set_of(mixed_patches(random, 3, 2), with_points());
  const Samples<float> samples = random_samples<float>(random, set.patch_count(), 3000);
  AllBuffers<float> out(samples.size());
  const QuantityViews<float> views = out.views();
  ASSERT_TRUE(evaluate(set, samples.views(), views, {.isa = available_isas().back()}).ok());
  const std::size_t before = allocation_count();
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(evaluate(set, samples.views(), views, {.isa = available_isas().back()}).ok());
  EXPECT_EQ(allocation_count(), before);
}

TEST(Points, ProgressIsToldAndCancellationSeen) {
  Random random(318);
  const PatchSet set = set_of(test::wavy_field(3, 3), with_points());
  const Samples<float> samples = random_samples<float>(random, 9, 50000);
  std::vector<float> positions(3 * samples.size());
  const QuantityViews<float> out{.position = View3<float>::interleaved(positions)};
  double last = 0;
  Execution execution;
  execution.progress = [&](double share) { last = std::max(last, share); };
  ASSERT_TRUE(evaluate(set, samples.views(), out, {}, execution).ok());
  EXPECT_EQ(last, 1);
  std::atomic<bool> cancel{false};
  execution.cancel = &cancel;
  execution.progress = [&](double) { cancel = true; };
  EXPECT_EQ(evaluate(set, samples.views(), out, {}, execution).code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
