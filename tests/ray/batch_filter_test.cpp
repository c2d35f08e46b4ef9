// Batches whose rays pass through cut-outs by a filter, and instances by masks. Filters that stop or throw.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>

#include "batch_support.h"
#include "support/torus.h"
#include "tessera/bezier_operations.h"

namespace tessera::test { namespace {

/// Eight by eight fields per patch.
bool is_cut_out(double patch_u, double patch_v) {
  return (static_cast<int>(8 * patch_u) + static_cast<int>(8 * patch_v)) % 2 != 0;
}

const BatchOptions chequered{.filter = [](const HitCandidate& at) {
  return is_cut_out(at.patch_u, at.patch_v) ? HitVerdict::reject : HitVerdict::accept;
}};

/// The nearest of all hits that count.
std::optional<Hit> first_of(const HitLists& lists, std::size_t ray, const std::function<bool(const Hit&)>& counts) {
  for (std::size_t k = lists.first[ray]; k < lists.first[ray + 1]; ++k)
    if (counts(lists.hits[k])) return lists.hits[k];
  return {};
}

void expect_filtered(const RayScene& scene, const std::vector<Ray>& given, const BatchOptions& options,
                     const std::function<bool(const Hit&)>& counts) {
  const Arrays<float> arrays(given);
  const std::vector<Ray> rays = arrays.rays();
  HitLists lists;
  ASSERT_TRUE(scene.all(rays, lists).ok());
  const Outputs<double> out = all_outputs<double>(scene, arrays.views(), options);
  std::vector<std::uint8_t> dark(rays.size(), 7);
  ASSERT_TRUE(occluded(scene, arrays.views(), View1<std::uint8_t>::soa({dark}), options).ok());
  std::size_t met = 0, passed = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::optional<Hit> expected = first_of(lists, k, counts);
    ASSERT_EQ(out.kind[k] == HitKind::hit, expected.has_value()) << k;
    EXPECT_EQ(dark[k] != 0, expected.has_value()) << k;
    if (!expected) continue;
    ++met, passed += expected->t != lists.hits[lists.first[k]].t;
    EXPECT_NEAR(out.numbers[0][k], expected->t, 1e-11) << k;
    EXPECT_EQ(out.indices[0][k], expected->patch) << k;
    EXPECT_EQ(out.indices[2][k], expected->instance) << k;
    EXPECT_NEAR(out.numbers[3][k], expected->patch_u, 1e-9) << k;
    EXPECT_NEAR(out.numbers[4][k], expected->patch_v, 1e-9) << k;
  }
  EXPECT_GT(met, rays.size() / 5);
  EXPECT_GT(passed, met / 8);
}

TEST(HitFilters, CutOutsAreThoseOfAllHits) {
  std::vector<BezierPatch> quartic;
  for (const BezierPatch& patch : Torus(5).patches(false)) quartic.push_back(value_of(elevate_degree(patch, 4, 4)));
  for (const auto& patches : {Torus(5).patches(false), Torus(5).patches(true), quartic}) {
    const PatchSet set = set_of(patches);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(std::string(name(isa)));
      const RayScene scene = value_of(RayScene::make(set, {.isa = isa}));
      expect_filtered(scene, mixed_rays(set.box()), chequered,
                      [](const Hit& hit) { return !is_cut_out(hit.patch_u, hit.patch_v); });
    }
  }
}

TEST(HitFilters, ThatAcceptAllChangeNothing) {
  const PatchSet set = set_of(Torus(7).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  std::vector<Ray> rays = mixed_rays(set.box());
  for (std::size_t k = 0; k < rays.size(); k += 5) rays[k].spawn_offset = 1e-9;
  const Arrays<float> arrays(rays);
  const Outputs<double> expected = all_outputs<double>(scene, arrays.views());
  const BatchOptions accept{.filter = [](const HitCandidate&) { return HitVerdict::accept; }};
  const Outputs<double> out = all_outputs<double>(scene, arrays.views(), accept);
  EXPECT_EQ(out.numbers, expected.numbers);
  EXPECT_EQ(out.indices, expected.indices);
  EXPECT_EQ(out.vectors, expected.vectors);
  const BatchOptions reject{.filter = [](const HitCandidate&) { return HitVerdict::reject; }};
  for (const HitKind kind : all_outputs<double>(scene, arrays.views(), reject).kind) EXPECT_NE(kind, HitKind::hit);
}

/// A candidate has the numbers of the hit that it becomes.
TEST(HitFilters, AreToldTheHit) {
  const PatchSet set = set_of(Torus(7).patches(false));
  const RayScene ring = value_of(RayScene::make(set));
  const RayScene placed =
      value_of(RayScene::make(std::vector<RayInstance>{{&ring, Affine::translated({0, 0, 3})}, {&ring, Affine{}}}));
  for (const RayScene* scene : {&ring, &placed}) {
    const Arrays<double> arrays(mixed_rays(set.box()));
    std::vector<std::vector<HitCandidate>> told(arrays.tnear.size());  // a ray is traced by one thread
    const BatchOptions options{.filter = [&](const HitCandidate& at) {
      told[at.ray].push_back(at);
      return HitVerdict::accept;
    }};
    const Outputs<double> out = all_outputs<double>(*scene, arrays.views(), options);
    for (std::size_t k = 0; k < told.size(); ++k) {
      ASSERT_EQ(told[k].empty(), out.kind[k] != HitKind::hit);
      if (told[k].empty()) continue;
      const HitCandidate& at = told[k].back();
      EXPECT_EQ(at.t, out.numbers[0][k]);
      EXPECT_EQ(at.u, out.numbers[1][k]);
      EXPECT_EQ(at.v, out.numbers[2][k]);
      EXPECT_EQ(at.patch_u, out.numbers[3][k]);
      EXPECT_EQ(at.patch_v, out.numbers[4][k]);
      EXPECT_EQ(at.patch, out.indices[0][k]);
      EXPECT_EQ(at.surface, out.indices[1][k]);
      EXPECT_EQ(at.instance, out.indices[2][k]);
    }
  }
}

class StoppedBatches : public ::testing::TestWithParam<int> {
 protected:
  Status closest_with(const HitFilter& filter, HitViews<float> hits) {
    return on_threads([&] { return closest(scene_, arrays_.views(), hits, {.filter = filter}); });
  }
  Status occluded_with(const HitFilter& filter) {
    return on_threads(
        [&] { return occluded(scene_, arrays_.views(), View1<std::uint8_t>::soa({dark_}), {.filter = filter}); });
  }
  Status on_threads(const std::function<Status()>& call) { return tbb::task_arena(GetParam()).execute(call); }

  tbb::global_control four_{tbb::global_control::max_allowed_parallelism, 4};
  PatchSet set_ = set_of(Torus(7).patches(false));
  RayScene scene_ = value_of(RayScene::make(set_));
  Arrays<float> arrays_{picture(100)};
  std::size_t count_ = arrays_.tnear.size();
  std::vector<std::uint8_t> dark_ = std::vector<std::uint8_t>(count_);
};

TEST_P(StoppedBatches, SayWhichRay) {
  for (const std::size_t at : {std::size_t{0}, std::size_t{4321}, count_}) {
    const HitFilter stop = [&](const HitCandidate& candidate) {
      return candidate.ray >= at && candidate.ray < at + 600 ? HitVerdict::stop : HitVerdict::accept;
    };
    Outputs<float> out(count_);
    for (const Status& status : {closest_with(stop, out.views()), occluded_with(stop)}) {
      if (at == count_) {
        EXPECT_TRUE(status.ok()) << status.message();
        continue;
      }
      EXPECT_EQ(status.code(), StatusCode::cancelled);
      EXPECT_GE(status.index(), static_cast<std::ptrdiff_t>(at));
      EXPECT_LT(status.index(), static_cast<std::ptrdiff_t>(at + 600));
      EXPECT_EQ(status.message(), "stopped by the filter at ray " + std::to_string(status.index()));
    }
  }
  Outputs<float> out(count_);
  const Status status = closest_with([](const HitCandidate&) { return HitVerdict{7}; }, out.views());
  EXPECT_EQ(status.code(), StatusCode::cancelled);
}

TEST_P(StoppedBatches, ReturnWhatWasThrown) {
  Outputs<float> out(count_);
  const auto expect = [&](const HitFilter& filter, StatusCode code, const std::string& message) {
    for (const Status& status : {closest_with(filter, out.views()), occluded_with(filter)}) {
      EXPECT_EQ(status.code(), code);
      EXPECT_EQ(status.message(), message);
    }
  };
  expect([](const HitCandidate&) -> HitVerdict { throw std::runtime_error("no texture"); }, StatusCode::internal,
         "no texture");
  expect([](const HitCandidate&) -> HitVerdict { throw std::bad_alloc(); }, StatusCode::out_of_memory, "out of memory");
  expect([](const HitCandidate&) -> HitVerdict { throw 7; }, StatusCode::internal, "unknown exception");
  expect(
      [](const HitCandidate& at) -> HitVerdict {
        if (at.ray > 5000) throw std::runtime_error("late");
        return HitVerdict::reject;
      },
      StatusCode::internal, "late");
}

INSTANTIATE_TEST_SUITE_P(Threads, StoppedBatches, ::testing::Values(1, 4));

TEST(HitFilters, MayTraceRaysAndComputeWithDenormals) {
  const PatchSet set = set_of(Torus(7).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  const Arrays<float> arrays(picture(40));
  const std::vector<Ray> rays = arrays.rays();
  std::atomic<std::size_t> wrong = 0, asked = 0;
  const BatchOptions options{.filter = [&](const HitCandidate& at) {
    volatile double tiny = 1e-310;
    wrong += tiny * 0.5 == 0;
    wrong += !(scene.closest(rays[at.ray]).t <= at.t);
    ++asked;
    return HitVerdict::accept;
  }};
  (void)all_outputs<double>(scene, arrays.views(), options);
  EXPECT_GT(asked, 400u);
  EXPECT_EQ(wrong, 0u);
}

/// Rings in several places: mirrored, stretched, small, and two at one place.
std::vector<RayInstance> placed_rings(const RayScene& ring) {
  const Affine flat = Affine::scaled({1, -1, 0.5}),
               small = Affine::translated({0, 0, 0.2}) * Affine::scaled({0.3, 0.3, 0.3});
  return {{&ring, flat, 1}, {&ring, flat, 2}, {&ring, Affine::rotated({1, 0, 0}, 1.2), 4}, {&ring, small, 9}};
}

TEST(InstancesInBatches, HaveTheBitsOfEachRay) {
  const PatchSet set = set_of(Torus(7).patches(false));
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(std::string(name(isa)));
    const RayScene ring = value_of(RayScene::make(set, {.isa = isa}));
    const RayScene scene = value_of(RayScene::make(placed_rings(ring)));
    std::vector<Ray> rays = mixed_rays(set.box());
    for (std::size_t k = 5; k < rays.size(); k += 31) rays[k].spawn_offset = 1e-9;
    const Arrays<float> arrays(rays);
    const std::vector<Ray> same = arrays.rays();
    const Outputs<double> out = all_outputs<double>(scene, arrays.views());
    const std::vector<Hit> hits = closest(scene, same);
    std::vector<std::uint8_t> dark(rays.size(), 7);
    ASSERT_TRUE(occluded(scene, arrays.views(), View1<std::uint8_t>::soa({dark})).ok());
    std::array<std::size_t, 4> met{};
    for (std::size_t k = 0; k < same.size(); ++k) {
      const Hit alone = scene.closest(same[k]);
      expect_hit(out, k, alone);
      EXPECT_EQ(hits[k].t, alone.t);
      EXPECT_EQ(dark[k] != 0, alone.kind == HitKind::hit);
      ASSERT_FALSE(HasFailure());
      if (alone.kind == HitKind::hit) ++met[alone.instance];
    }
    EXPECT_EQ(met[1], 0u);  // stands where the first one does
    for (const std::size_t k : {0u, 2u, 3u}) EXPECT_GT(met[k], 50u);
  }
}

TEST(InstancesInBatches, AreMetWhereMasksHaveABitInCommon) {
  const PatchSet set = set_of(Torus(7).patches(false));
  const RayScene ring = value_of(RayScene::make(set));
  const std::vector<RayInstance> instances = placed_rings(ring);
  const RayScene scene = value_of(RayScene::make(instances));
  const Arrays<double> arrays(mixed_rays(set.box()));
  const std::vector<Ray> rays = arrays.rays();
  std::vector<std::uint32_t> masks(rays.size());
  for (std::size_t k = 0; k < masks.size(); ++k) masks[k] = static_cast<std::uint32_t>(k * 7 % 16);
  RayViews<double> views = arrays.views();
  views.mask = View1<const std::uint32_t>::soa({masks});
  HitLists lists;
  ASSERT_TRUE(scene.all(rays, lists).ok());
  const Outputs<double> out = all_outputs<double>(scene, views);
  std::vector<std::uint8_t> dark(rays.size(), 7);
  ASSERT_TRUE(occluded(scene, views, View1<std::uint8_t>::soa({dark})).ok());
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::optional<Hit> expected =
        first_of(lists, k, [&](const Hit& hit) { return (instances[hit.instance].mask & masks[k]) != 0; });
    ASSERT_EQ(out.kind[k] == HitKind::hit, expected.has_value());
    EXPECT_EQ(dark[k] != 0, expected.has_value());
    if (!expected) continue;
    ++met;
    EXPECT_NEAR(out.numbers[0][k], expected->t, 1e-11);
    EXPECT_EQ(out.indices[2][k], expected->instance);
  }
  EXPECT_GT(met, rays.size() / 4);
  const std::uint32_t second = 2, none = 0;
  for (const std::uint32_t& all : {second, none}) {
    views.mask = {{&all}, 0, 1};
    const Outputs<double> one = all_outputs<double>(scene, views);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const bool met_one = one.kind[k] == HitKind::hit;
      EXPECT_EQ(one.indices[2][k], met_one ? 1u : HitViews<double>::no_hit);
      EXPECT_LE(met_one, all == second);
    }
  }
}

TEST(InstancesInBatches, WithCutOuts) {
  const PatchSet set = set_of(Torus(7).patches(false));
  const RayScene ring = value_of(RayScene::make(set));
  const RayScene scene = value_of(RayScene::make(placed_rings(ring)));
  const auto is_hole = [](std::uint32_t instance, double u, double v) { return instance != 3 && is_cut_out(u, v); };
  const BatchOptions options{.filter = [&](const HitCandidate& at) {
    return is_hole(at.instance, at.patch_u, at.patch_v) ? HitVerdict::reject : HitVerdict::accept;
  }};
  expect_filtered(scene, mixed_rays(set.box()), options,
                  [&](const Hit& hit) { return !is_hole(hit.instance, hit.patch_u, hit.patch_v); });
}

}}  // namespace tessera::test
