// Results are the same bytes for any number of threads.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <bit>

#include "ray_support.h"

namespace tessera::test { namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same_bits(const Vec3& a, const Vec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

TEST(Threads, SameBytes) {
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  const PatchSet set = set_of(wavy_field(12, 9));
  Random random(41);
  std::vector<Ray> rays;
  for (int k = 0; k < 30000; ++k) {
    const Vec3 origin =
        k < 15000 ? Vec3{6, -8, 9} : Vec3{uniform(random, 0, 12), uniform(random, 0, 9), uniform(random, -2, 2)};
    const Vec3 target{uniform(random, -1, 13), uniform(random, -1, 10), 0};
    rays.push_back(ray(origin, target - origin));
  }
  const auto run = [&](int threads, std::vector<Hit>& hits, std::vector<std::uint8_t>& occluded) {
    tbb::task_arena(threads).execute([&] {
      const RayScene scene = scene_of(set);
      hits = closest(scene, rays);
      occluded.resize(rays.size());
      ASSERT_TRUE(scene.occluded(rays, occluded).ok());
    });
  };
  std::vector<Hit> one, many;
  std::vector<std::uint8_t> occluded_one, occluded_many;
  run(1, one, occluded_one);
  for (const int threads : {2, 4}) {
    run(threads, many, occluded_many);
    EXPECT_EQ(occluded_one, occluded_many);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const Hit &a = one[k], &b = many[k];
      ASSERT_TRUE(a.kind == b.kind && a.flags.unrefined == b.flags.unrefined && a.patch == b.patch &&
                  same_bits(a.t, b.t) && same_bits(a.u, b.u) && same_bits(a.v, b.v) &&
                  same_bits(a.position, b.position) && same_bits(a.normal, b.normal) &&
                  same_bits(a.residual, b.residual))
          << k;
    }
  }
}

TEST(Threads, ProgressAndCancellation) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = scene_of(set);
  const std::vector<Ray> rays(20000, ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> hits(rays.size());
  double last = 0;
  Execution execution;
  execution.progress = [&](double share) {
    EXPECT_GT(share, last);
    last = share;
  };
  ASSERT_TRUE(scene.closest(rays, hits, execution).ok());
  EXPECT_EQ(last, 1);
  const std::atomic<bool> cancel = true;
  execution.cancel = &cancel;
  EXPECT_EQ(scene.closest(rays, hits, execution).code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
