// Compares lines through many rays at once with those of one ray.

#include "kernel/table/kernel_table.h"
#include "ray/line/ray_lines.h"
#include "ray/line/ray_segment.h"
#include "ray_support.h"

namespace tessera::test { namespace {

void lines_expect_same(const Vec3& a, const Vec3& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
}

void lines_expect_same(const RayLine& a, const RayLine& b) {
  EXPECT_EQ(a.empty, b.empty);
  if (a.empty || b.empty) return;
  lines_expect_same(a.start, b.start);
  lines_expect_same(a.direction, b.direction);
  lines_expect_same(a.across[0], b.across[0]);
  lines_expect_same(a.across[1], b.across[1]);
  EXPECT_EQ(a.near, b.near);
  EXPECT_EQ(a.far, b.far);
  EXPECT_EQ(a.enter, b.enter);
  EXPECT_EQ(a.leave, b.leave);
  EXPECT_EQ(a.slack, b.slack);
  EXPECT_EQ(a.spawn, b.spawn);
  EXPECT_EQ(a.base, b.base);
  EXPECT_EQ(a.shift, b.shift);
  EXPECT_EQ(a.speed, b.speed);
}

/// Rays from anywhere, near and very far, of any length, mostly at the box; some along an axis, some with ends, some
/// bad.
Ray any_ray(Random& random) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double far = std::pow(10.0, uniform(random, -2, random() % 8 == 0 ? 17 : 3));
  const Vec3 origin = far * uniform_vector(random, -1, 1), target = uniform_vector(random, -2, 2);
  Ray out;
  out.origin = origin;
  out.direction = std::pow(10.0, uniform(random, -3, random() % 16 == 0 ? -120 : 3)) * (target - origin);
  if (random() % 8 == 0) out.direction.x = 0;
  if (random() % 8 == 0) out.direction.z = random() % 2 == 0 ? -0.0 : 1e-310;
  if (random() % 4 == 0) out.tnear = uniform(random, 0, 2);
  if (random() % 4 == 0) out.tfar = uniform(random, 0, 4);
  if (random() % 16 == 0) out.spawn_offset = uniform(random, 0, 1e-6);
  switch (random() % 64) {
    case 0:
      out.origin.y = std::nan("");
      break;
    case 1:
      out.direction.z = infinity;
      break;
    case 2:
      out.tnear = std::nan("");
      break;
    case 3:
      out.direction = {};
      break;
    case 4:
      out.origin.x = 1e19;
      break;
    case 5:
      out.spawn_offset = -1;
      break;
    default:
      break;
  }
  return out;
}

TEST(Lines, OfATurnAreThoseOfEachRay) {
  const Box3 model{{-1, -2, -0.5}, {3, 1, 2}};
  const SceneFrame frame = SceneFrame::around(model);
  const Box3 box{frame.to_scene(model.lower), frame.to_scene(model.upper)};
  Random random(11);
  for (const Isa isa : available_isas()) {
    RayTurn turn(frame, box, ray_kernels(isa));
    std::size_t met = 0, bad = 0;
    for (int round = 0; round < 4000; ++round) {
      std::vector<Ray> rays(1 + random() % RayTurn::size);
      for (Ray& ray : rays) ray = any_ray(random);
      turn.set(rays);
      for (std::size_t k = 0; k < rays.size(); ++k) {
        ASSERT_EQ(turn.valid()[k], is_valid(rays[k]));
        bad += !turn.valid()[k], met += !turn.line(k).empty;
        lines_expect_same(turn.line(k), turn.valid()[k] ? line_of(rays[k], frame, box) : RayLine{});
        ASSERT_FALSE(HasFailure()) << name(isa) << ", round " << round << ", ray " << k;
      }
    }
    EXPECT_GT(met, 10000u);
    EXPECT_GT(bad, 2000u);
  }
}

}}  // namespace tessera::test
