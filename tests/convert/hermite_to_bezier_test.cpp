// Hermite patches and networks as bicubic Bezier patches, and as tensor patches over the Hermite basis.

#include "support/errors.h"
#include "support/random_hermite.h"
#include "support/reference.h"
#include "support/ulp.h"
#include "tessera/bezier_operations.h"
#include "tessera/convert.h"
#include "tessera/tensor_patch.h"

namespace tessera::test { namespace {

TEST(HermiteToBezier, IsThePatchOverItsDomain) {
  Random random(1);
  for (const Domain& d : {Domain{}, Domain{-1, 3, 2, 2.5}}) {
    const HermitePatch patch = random_hermite(random, d);
    const PatchGrid grid = value_of(to_bezier(patch));
    EXPECT_EQ(grid.domain(), d);
    EXPECT_EQ(grid.fit_error().distance, 0);
    EXPECT_TRUE(grid.fit_error().certified);
    const double unit = double_unit * std::max(1.0, largest_coefficient(grid.patches()[0]));
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 16; ++j) {
        const double u = d.u_at(i / 16.0), v = d.v_at(j / 16.0);
        const SurfaceJet jet = *grid.evaluate_jet(u, v), expected = evaluate_jet(patch, u, v);
        EXPECT_TRUE(within_units(jet.position, expected.position, unit, 8));
        EXPECT_TRUE(within_units(jet.du, expected.du, unit, 24));
        EXPECT_TRUE(within_units(jet.dv, expected.dv, 4 * unit, 24));
        EXPECT_TRUE(within_units(jet.duv, expected.duv, 4 * unit, 72));
      }
  }
}

TEST(HermiteToBezier, ThereAndBack) {
  Random random(2);
  const Domain d{-1, 3, 2, 2.5};
  for (int k = 0; k < 20; ++k) {
    const HermitePatch patch = random_hermite(random, d);
    const HermitePatch back = value_of(HermitePatch::from_bezier(value_of(to_bezier(patch)).patches()[0], d));
    for (std::size_t i = 0; i < 16; ++i) EXPECT_LT(max_abs(back.geometry()[i] - patch.geometry()[i]), 1e-13);
  }
}

TEST(HermiteToBezier, VanishingTwistsAreParallelogramsAtTheCorners) {
  HermitePatch::OpenCorners corners;
  Random random(3);
  for (CornerTangents& corner : corners)  // whole multiples of 3: nothing rounds
    corner = {{std::floor(uniform(random, -9, 9)), 1, 2}, {3, std::floor(uniform(random, -9, 9)) * 3, 0}, {0, 3, 6}};
  const PatchGrid grid = value_of(to_bezier(value_of(HermitePatch::ferguson(corners))));
  const BezierPatch& patch = grid.patches()[0];
  EXPECT_EQ(patch.point(1, 1), patch.point(1, 0) + patch.point(0, 1) - patch.point(0, 0));
  EXPECT_EQ(patch.point(2, 2), patch.point(2, 3) + patch.point(3, 2) - patch.point(3, 3));
  for (const Vec3& twist : corner_twists(patch)) EXPECT_EQ(twist, Vec3{});
}

TEST(HermiteToBezier, AgreesWithTheHermiteBasis) {
  Random random(4);
  const BasisMatrix hermite = value_of(BasisMatrix::hermite()), power = value_of(BasisMatrix::power(3));
  const HermitePatch patch = random_hermite(random);
  const TensorPatch tensor = value_of(TensorPatch::make(hermite, hermite, patch.geometry()));
  const PatchGrid a = value_of(to_bezier(patch)), b = value_of(to_bezier(tensor));
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_TRUE(within_units(a.patches()[0].points()[k], b.patches()[0].points()[k], 2 * double_unit, 2));
  const TensorPatch algebraic = value_of(change_basis(tensor, power, power));
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_TRUE(within_units(patch.algebraic_form()[k], algebraic.geometry()[k], 16 * double_unit, 4));
}

TEST(HermiteNetworkToBezier, IsTheNetworkAndSharesBorders) {
  Random random(5);
  const std::vector<double> k = random_factors(random, 3), l = random_factors(random, 4);
  const HermiteNetwork network = value_of(HermiteNetwork::from_factors(4, 5, random_nodes(random, 4, 5), k, l));
  const PatchGrid grid = value_of(to_bezier(network));
  ASSERT_EQ(grid.count_u(), 3u);
  ASSERT_EQ(grid.count_v(), 4u);
  EXPECT_TRUE(std::equal(grid.breaks_u().begin(), grid.breaks_u().end(), network.knots_u().begin()));
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const double u = grid.domain().u_at(i / 40.0), v = grid.domain().v_at(j / 40.0);
      const SurfaceJet jet = *grid.evaluate_jet(u, v), expected = evaluate_jet(network, u, v);
      EXPECT_TRUE(within_units(jet.position, expected.position, 4 * double_unit, 8));
      EXPECT_LT(max_abs(jet.du - expected.du), 1e-13);
      EXPECT_LT(max_abs(jet.duv - expected.duv), 1e-12);
    }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (int i = 0; i < 4; ++i) {
        if (a > 0) {
          EXPECT_EQ(grid.patch(a - 1, b).point(3, i), grid.patch(a, b).point(0, i));
        }
        if (b > 0) {
          EXPECT_EQ(grid.patch(a, b - 1).point(i, 3), grid.patch(a, b).point(i, 0));
        }
      }
}

TEST(HermiteNetworkToBezier, NormalsAgreeAlongSharedEdges) {
  Random random(6);
  const HermiteNetwork network = value_of(HermiteNetwork::from_factors(
      3, 3, random_nodes(random, 3, 3), random_factors(random, 2), random_factors(random, 2)));
  const PatchGrid grid = value_of(to_bezier(network));
  for (int k = 0; k <= 64; ++k)
    for (std::size_t other = 0; other < 2; ++other) {
      const double t = k / 64.0;
      const Vec3 left = unit_normal(grid.patch(0, other), 1, t).direction,
                 right = unit_normal(grid.patch(1, other), 0, t).direction;
      const Vec3 low = unit_normal(grid.patch(other, 0), t, 1).direction,
                 high = unit_normal(grid.patch(other, 1), t, 0).direction;
      EXPECT_LT(max_abs(left - right), 1e-14);
      EXPECT_LT(max_abs(low - high), 1e-14);
    }
}

TEST(HermiteToBezier, RefusesWhatOverflows) {
  HermitePatch::Grid grid{};
  grid[0] = {1e308, 0, 0};
  grid[4] = {1e308, 0, 0};
  const HermitePatch patch = value_of(HermitePatch::make(grid, {0, 3, 0, 1}));
  expect_refused(to_bezier(patch), StatusCode::non_finite, 4, "control point [1][0] is (inf, 0, 0)");
}

}}  // namespace tessera::test
