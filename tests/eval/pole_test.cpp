// Normals at poles, and borders that neighbours share.

#include <gtest/gtest.h>

#include "eval/uniform_grid.h"
#include "support/grids.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// A cap over the unit square's parameters whose edge u = 0 is one point: r = (u cos-like, u sin-like, 1 - u^2).
BezierPatch cap() {
  const Vec3 pole{0, 0, 1};
  return polynomial(2, 2, {pole, pole, pole, {0.5, 0, 1}, {0.5, 0.5, 1}, {0, 0.5, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
}

TEST(Poles, NormalIsTheLimitInEveryLayoutAndOrientation) {
  const auto t = uniform_parameters(5);
  for (int way = 0; way < 8; ++way) {
    const BezierPatch patch = reoriented(cap(), way);
    const PatchSet set = set_of({patch});
    const GridPlan plan = value_of(GridPlan::make(set, t, t));
    GridBuffers<float> out(plan);
    ASSERT_TRUE(evaluate(set, plan, out.views()).ok());
    AlignedVector<float> blocks(plan.block_capacity());
    ASSERT_TRUE(evaluate(set, plan, QuantityBlocks<float>{.normal = blocks}).ok());
    int poles = 0;
    for (std::size_t k = 0; k < 25; ++k) {
      const Vec3 normal = vector_at(out.normal, k);
      const std::size_t first = k * 3 * PatchSet::lanes;
      EXPECT_EQ(normal, (Vec3{blocks[first], blocks[first + PatchSet::lanes], blocks[first + 2 * PatchSet::lanes]}));
      // The reference: the normal a little further inside.
      const double u = std::clamp(t[k / 5], 1e-7, 1 - 1e-7), v = std::clamp(t[k % 5], 1e-7, 1 - 1e-7);
      EXPECT_TRUE(within_units(normal, reference_normal(patch, u, v), 1e-5, 1)) << way << " " << k;
      if (max_abs(de_casteljau(patch, t[k / 5], t[k % 5]) - Vec3{0, 0, 1}) == 0) {
        ++poles;
        EXPECT_NEAR(std::abs(normal.z), 1, 1e-6);
      }
    }
    EXPECT_EQ(poles, 5);
  }
}

/// All control points in one place: no normal, and no NaN.
TEST(Poles, APatchThatIsAPointHasNoNormal) {
  const PatchSet set = set_of({polynomial(1, 1, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}})});
  const auto t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridBuffers<float> out(plan);
  ASSERT_TRUE(evaluate(set, plan, out.views()).ok());
  for (const float x : out.normal) EXPECT_EQ(x, 0);
}

/// Two patches on one border, in all orientations, polynomial and rational, any degree and rate: the same bits.
TEST(SharedBorders, AreTheSameBits) {
  Random random(51);
  for (int degree = 1; degree <= max_degree; ++degree)
    for (const int rate : {1, 2, 7, 130})
      for (int way = 0; way < 8; way += (degree > 4 ? 3 : 1))
        for (const bool is_rational : {false, true}) {
          std::vector<Vec3> a = random_points(random, 2, degree), b = random_points(random, 3, degree);
          std::vector<double> wa = random_weights(random, 2, degree, 0.5, 2),
                              wb = random_weights(random, 3, degree, 0.5, 2);
          for (std::size_t j = 0; j <= static_cast<std::size_t>(degree); ++j) {  // a at u = 1 is b at u = 0
            b[j] = a[2 * static_cast<std::size_t>(degree + 1) + j];
            wb[j] = wa[2 * static_cast<std::size_t>(degree + 1) + j];
          }
          const BezierPatch first = is_rational ? rational(2, degree, a, wa) : polynomial(2, degree, a);
          const BezierPatch second = is_rational ? rational(3, degree, b, wb) : polynomial(3, degree, b);
          const PatchSet set = set_of({first, reoriented(second, way)});
          const UniformGrid grid = value_of(UniformGrid::make(set, rate, rate, std::nullopt));
          std::vector<float> positions(3 * grid.capacity());
          ASSERT_TRUE(grid.run(set, {.position = View3<float>::interleaved(positions)}, {}).ok());
          const auto n = static_cast<std::size_t>(rate), side = n + 1;
          for (std::size_t k = 0; k <= n; ++k) {
            // The border u = 0 of `second` at v = k / n, in the parameters of its reoriented copy.
            std::size_t iu = 0, iv = k;
            if (way & 1) iu = n - iu;
            if (way & 2) iv = n - iv;
            if (way & 4) std::swap(iu, iv);
            ASSERT_EQ(vector_at(positions, n * side + k), vector_at(positions, side * side + iu * side + iv))
                << "degree " << degree << " rate " << rate << " way " << way << " rational " << is_rational << " k "
                << k;
          }
        }
}

TEST(SharedBorders, StayWithinTheErrorBound) {
  Random random(52);
  const PatchSet set = set_of(mixed_patches(random, 5));
  const UniformGrid grid = value_of(UniformGrid::make(set, 6, 9, std::nullopt));
  std::vector<float> positions(3 * grid.capacity());
  ASSERT_TRUE(grid.run(set, {.position = View3<float>::interleaved(positions)}, {}).ok());
  for (std::size_t record = 0; record < grid.capacity(); ++record) {
    const std::size_t patch = record / 70, iu = record % 70 / 10, iv = record % 10;
    const double unit = float_unit * largest_coefficient(set.patch(patch), set.origin());
    const Vec3 expected =
        reference_position(set.patch(patch), static_cast<double>(iu) / 6, static_cast<double>(iv) / 9) - set.origin();
    EXPECT_TRUE(within_units(vector_at(positions, record), expected, unit, set.patch(patch).is_rational() ? 4 : 2));
  }
}

TEST(SharedBorders, ACollapsedBorderIsOnePoint) {
  for (int way = 0; way < 8; ++way) {
    const PatchSet set = set_of({reoriented(cap(), way)});
    const UniformGrid grid = value_of(UniformGrid::make(set, 100, 100, std::nullopt));
    std::vector<float> positions(3 * grid.capacity());
    ASSERT_TRUE(grid.run(set, {.position = View3<float>::interleaved(positions)}, {}).ok());
    const Vec3 pole = Vec3{0, 0, 1} - set.origin();
    int there = 0;
    for (std::size_t k = 0; k < grid.capacity(); ++k) there += vector_at(positions, k) == pole;
    EXPECT_EQ(there, 101) << way;
  }
}

}}  // namespace tessera::test
