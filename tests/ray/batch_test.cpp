// Batches of rays in arrays: the hits of the same rays one by one, for every layout and every choice of outputs.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <array>

#include "batch_support.h"
#include "support/torus.h"

namespace tessera::test { namespace {

template <class T, class U>
void expect_hits_of_each_ray(const RayScene& scene, const std::vector<Ray>& rays) {
  const Arrays<T> arrays(rays);
  const std::vector<Ray> same = arrays.rays();
  const Outputs<U> out = all_outputs<U>(scene, arrays.views());
  std::vector<std::uint8_t> dark(rays.size(), 7);
  ASSERT_TRUE(occluded(scene, arrays.views(), View1<std::uint8_t>::soa({dark})).ok());
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    expect_hit(out, k, scene.closest(same[k]));
    EXPECT_EQ(dark[k] != 0, scene.occluded(same[k]) == HitKind::hit) << k;
    ASSERT_FALSE(::testing::Test::HasFailure());
    met += out.kind[k] == HitKind::hit;
  }
  EXPECT_GT(met, rays.size() / 4);
  EXPECT_LT(met, rays.size());
}

class Batches : public ::testing::Test {
 protected:
  PatchSet set_ = set_of(Torus(7).patches(false));
  RayScene scene_ = value_of(RayScene::make(set_));
};

TEST_F(Batches, HaveTheBitsOfEachRay) {
  const std::vector<Ray> rays = mixed_rays(set_.box());
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(std::string(name(isa)));
    const RayScene scene = value_of(RayScene::make(set_, {.isa = isa}));
    expect_hits_of_each_ray<float, float>(scene, rays);
    expect_hits_of_each_ray<float, double>(scene, rays);
    expect_hits_of_each_ray<double, float>(scene, rays);
    expect_hits_of_each_ray<double, double>(scene, rays);
  }
}

TEST_F(Batches, OfRationalPatchesAndOfGrids) {
  const PatchSet rational = set_of(Torus(7).patches(true));
  expect_hits_of_each_ray<float, double>(value_of(RayScene::make(rational)), mixed_rays(set_.box()));
  expect_hits_of_each_ray<float, float>(scene_of(set_), mixed_rays(set_.box()));
}

TEST_F(Batches, OfAnyNumber) {
  const std::vector<Ray> rays = mixed_rays(set_.box());
  for (const std::size_t count : {1, 2, 3, 4, 5, 15, 16, 17, 31, 100, 511, 512, 513, 1000}) {
    const std::vector<Ray> some(rays.begin() + 900, rays.begin() + 900 + static_cast<std::ptrdiff_t>(count));
    const Arrays<float> arrays(some);
    const std::vector<Ray> same = arrays.rays();
    const Outputs<float> out = all_outputs<float>(scene_, arrays.views());
    for (std::size_t k = 0; k < count; ++k) expect_hit(out, k, scene_.closest(same[k]));
    ASSERT_FALSE(HasFailure()) << count;
  }
}

/// Records of hits keep no number of what was in their memory.
TEST_F(Batches, LeaveNothingOfWhatWasThere) {
  const std::vector<RayInstance> two{{&scene_, Affine{}}, {&scene_, Affine::scaled({0.5, 0.5, 0.5})}};
  const RayScene instances = value_of(RayScene::make(two)), grid = scene_of(set_);
  const Arrays<double> arrays(mixed_rays(set_.box()));
  Hit used;
  used.kind = HitKind{9};
  used.flags = {true, true, true, true, true, true};
  used.surface = used.patch = used.instance = 77;
  used.t = used.u = used.v = used.patch_u = used.patch_v = used.residual = 77;
  used.position = used.normal = used.du = used.dv = {77, 77, 77};
  for (const RayScene* scene : std::array<const RayScene*, 3>{&scene_, &instances, &grid}) {
    const Outputs<double> out = all_outputs<double>(*scene, arrays.views());
    const std::vector<Ray> rays = arrays.rays();
    std::vector<Hit> hits(rays.size(), used);
    ASSERT_TRUE(scene->closest(rays, hits).ok());
    for (std::size_t k = 0; k < rays.size(); ++k) expect_hit(out, k, hits[k]);
  }
}

/// The rays and hits of a renderer, in one record.
struct Record {
  float origin[3], tnear, direction[3], tfar;
  std::uint32_t mask;
  float normal[3], u, v;
  std::uint32_t patch;
  float t;
};
static_assert(sizeof(Record) % sizeof(float) == 0);

TEST_F(Batches, InRecords) {
  const Arrays<float> arrays(mixed_rays(set_.box()));
  const std::vector<Ray> rays = arrays.rays();
  std::vector<Record> records(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    Record& record = records[k];
    for (std::size_t c = 0; c < 3; ++c)
      record.origin[c] = arrays.origin[c][k], record.direction[c] = arrays.direction[c][k];
    record.tnear = arrays.tnear[k], record.tfar = arrays.tfar[k];
    record.mask = 0xabcd;
  }
  constexpr auto stride = static_cast<std::ptrdiff_t>(sizeof(Record) / sizeof(float));
  const auto one = [&](auto& of) {
    return VectorView<std::remove_reference_t<decltype(of)>, 1>{{&of}, stride, records.size()};
  };
  const auto input = [&](const float& of) { return View1<const float>{{&of}, stride, records.size()}; };
  const auto input3 = [&](const float(&of)[3]) {
    return View3<const float>{{&of[0], &of[1], &of[2]}, stride, records.size()};
  };
  Record& first = records[0];
  RayViews<float> in;
  in.origin = input3(first.origin), in.direction = input3(first.direction);
  in.tnear = input(first.tnear), in.tfar = input(first.tfar);
  HitViews<float> out;
  out.normal = {{&first.normal[0], &first.normal[1], &first.normal[2]}, stride, records.size()};
  out.u = one(first.u), out.v = one(first.v), out.patch = one(first.patch), out.t = one(first.t);
  ASSERT_TRUE(closest(scene_, in, out).ok());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit hit = scene_.closest(rays[k]);
    const Record& record = records[k];
    EXPECT_EQ(record.t, static_cast<float>(hit.t));
    EXPECT_EQ(record.patch, hit.kind == HitKind::hit ? hit.patch : HitViews<float>::no_hit);
    EXPECT_EQ(record.u, static_cast<float>(hit.u));
    EXPECT_EQ(record.v, static_cast<float>(hit.v));
    EXPECT_EQ(record.normal[1], static_cast<float>(hit.normal.y));
    EXPECT_EQ(record.mask, 0xabcdu);
    EXPECT_EQ(record.origin[2], arrays.origin[2][k]);
  }
}

/// The values of an output do not depend on the other outputs.
TEST_F(Batches, EachOutputAlone) {
  const Arrays<float> arrays(mixed_rays(set_.box()));
  const std::size_t count = arrays.tnear.size();
  const Outputs<double> all = all_outputs<double>(scene_, arrays.views());
  const auto alone = [&](auto member) {
    Outputs<double> out(count);
    HitViews<double> views;
    views.*member = out.views().*member;
    const Status status = closest(scene_, arrays.views(), views);
    EXPECT_TRUE(status.ok()) << status.message();
    return out;
  };
  std::size_t k = 0;
  for (View1<double> HitViews<double>::*member :
       {&HitViews<double>::t, &HitViews<double>::u, &HitViews<double>::v, &HitViews<double>::patch_u,
        &HitViews<double>::patch_v, &HitViews<double>::residual}) {
    EXPECT_EQ(alone(member).numbers[k], all.numbers[k]) << k;
    ++k;
  }
  k = 0;
  for (View1<std::uint32_t> HitViews<double>::*member :
       {&HitViews<double>::patch, &HitViews<double>::surface, &HitViews<double>::instance}) {
    EXPECT_EQ(alone(member).indices[k], all.indices[k]) << k;
    ++k;
  }
  k = 0;
  for (View3<double> HitViews<double>::*member :
       {&HitViews<double>::position, &HitViews<double>::normal, &HitViews<double>::du, &HitViews<double>::dv}) {
    EXPECT_EQ(alone(member).vectors[k], all.vectors[k]) << k;
    ++k;
  }
  EXPECT_EQ(alone(&HitViews<double>::kind).kind, all.kind);
  const Outputs<double> flags = alone(&HitViews<double>::flags);
  for (std::size_t ray = 0; ray < count; ++ray) EXPECT_TRUE(same_flags(flags.flags[ray], all.flags[ray])) << ray;
}

/// Record 0 of a view of stride 0 belongs to all rays, and absent views have their defaults.
TEST_F(Batches, OneRecordForAllRays) {
  const Arrays<float> arrays(picture(24));
  RayViews<float> all = arrays.views(), one = all;
  one.origin.stride = 0, one.origin.size = 1;
  one.tnear = {}, one.tfar = {}, one.spawn_offset = {};
  EXPECT_EQ(all_outputs<double>(scene_, all).numbers, all_outputs<double>(scene_, one).numbers);
  const float far = 1.7f, offset = 1e-3f;
  one.tfar = View1<const float>{{&far}, 0, 1}, one.spawn_offset = View1<const float>{{&offset}, 0, 1};
  std::vector<Ray> rays = arrays.rays();
  for (Ray& ray : rays) ray.tfar = far, ray.spawn_offset = offset;
  const Outputs<double> out = all_outputs<double>(scene_, one);
  for (std::size_t k = 0; k < rays.size(); ++k) expect_hit(out, k, scene_.closest(rays[k]));
}

TEST_F(Batches, OnAnyNumberOfThreads) {
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  std::vector<Ray> rays = picture(120);
  const Arrays<float> arrays(rays);
  const auto on = [&](int threads) {
    return tbb::task_arena(threads).execute([&] { return all_outputs<double>(scene_, arrays.views()); });
  };
  const Outputs<double> one = on(1), many = on(4);
  EXPECT_EQ(one.numbers, many.numbers);
  EXPECT_EQ(one.indices, many.indices);
  EXPECT_EQ(one.vectors, many.vectors);
}

}}  // namespace tessera::test
