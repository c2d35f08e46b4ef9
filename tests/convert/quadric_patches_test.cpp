// Pieces of quadrics as rational patches: on the surface up to rounding, at the promised parameters, without cracks.

#include <numbers>

#include "support/quadrics.h"
#include "support/ulp.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

constexpr double pi = std::numbers::pi;

PatchGrid grid_of(const QuadricPiece& part) { return value_of(to_bezier(part)); }

double largest_value(const PatchGrid& grid) {
  double largest = 0;
  for (const BezierPatch& patch : grid.patches()) largest = std::max(largest, largest_coefficient(patch));
  return largest;
}

/// Every shared border of neighbouring patches is the same by ==.
void expect_shared_borders(const PatchGrid& grid) {
  for (std::size_t a = 0; a < grid.count_u(); ++a)
    for (std::size_t b = 0; b < grid.count_v(); ++b) {
      const BezierPatch& patch = grid.patch(a, b);
      const int m = patch.degree_u(), n = patch.degree_v();
      for (int j = 0; a + 1 < grid.count_u() && j <= n; ++j) {
        EXPECT_EQ(patch.point(m, j), grid.patch(a + 1, b).point(0, j));
        EXPECT_EQ(patch.weight(m, j), grid.patch(a + 1, b).weight(0, j));
      }
      for (int i = 0; b + 1 < grid.count_v() && i <= m; ++i) {
        EXPECT_EQ(patch.point(i, n), grid.patch(a, b + 1).point(i, 0));
        EXPECT_EQ(patch.weight(i, n), grid.patch(a, b + 1).weight(i, 0));
      }
    }
}

TEST(QuadricPatches, AreTheSurfaceAtThePromisedParameters) {
  Random random(1);
  for (const QuadricSample& sample : quadric_samples())
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet)
      for (int turn = 0; turn < 4; ++turn) {
        const Quadric surface =
            turn ? quadric(moved(sample.coefficients, random_frame(random, 1))) : quadric(sample.coefficients);
        const QuadricPiece part = piece(surface, sample_range(sample.kind), sheet);
        const PatchGrid grid = grid_of(part);
        EXPECT_EQ(grid.domain(), part.range());
        EXPECT_TRUE(grid.fit_error().certified);
        EXPECT_EQ(grid.fit_error().distance, 0);
        expect_shared_borders(grid);
        const double unit = double_unit * largest_value(grid);
        for (int k = 0; k < 100; ++k) {
          const Domain& r = part.range();
          const double u = uniform(random, r.u0, r.u1), v = uniform(random, r.v0, r.v1);
          const QuadricParameters at = canonical_parameters(part, u, v);
          EXPECT_TRUE(within_units(grid.evaluate_jet(u, v)->position, evaluate_jet(part, at.u, at.v).position, unit, 8))
              << name(sample.kind);
          const QuadricParameters back = grid_parameters(part, at.u, at.v);
          EXPECT_NEAR(back.u, u, 1e-13);
          EXPECT_NEAR(back.v, v, 1e-13);
        }
      }
}

TEST(QuadricPatches, BreakpointsAreCanonicalParameters) {
  for (const QuadricSample& sample : quadric_samples()) {
    if (!is_surface(sample.kind)) continue;
    const QuadricPiece part = piece(quadric(sample.coefficients), sample_range(sample.kind));
    const PatchGrid grid = grid_of(part);
    for (const double u : grid.breaks_u())
      for (const double v : grid.breaks_v()) {
        EXPECT_EQ(canonical_parameters(part, u, v).u, u);
        EXPECT_EQ(grid_parameters(part, u, v).v, v);
        EXPECT_LT(max_abs(grid.evaluate_jet(u, v)->position - evaluate_jet(part, u, v).position), 1e-14);
      }
    for (std::size_t k = 0; k + 1 < grid.breaks_u().size(); ++k)
      EXPECT_LE(grid.breaks_u()[k + 1] - grid.breaks_u()[k], grid.count_u() == 1 ? 100 : 2);
  }
}

TEST(QuadricPatches, AWholeSphereClosesAndHasPoles) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}), {0, 2 * pi, -pi / 2, pi / 2});
  const PatchGrid grid = grid_of(part);
  ASSERT_EQ(grid.count_u(), 4u);
  ASSERT_EQ(grid.count_v(), 2u);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_TRUE(grid.patch(a, 0).collapsed_sides().has(Side::v0));
    EXPECT_TRUE(grid.patch(a, 1).collapsed_sides().has(Side::v1));
    EXPECT_EQ(grid.patch(a, 1).point(1, 2), (Vec3{0, 0, 1}));
  }
  for (std::size_t b = 0; b < 2; ++b)
    for (int j = 0; j <= 2; ++j) EXPECT_EQ(grid.patch(3, b).point(2, j), grid.patch(0, b).point(0, j));
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j) {
      const double u = 2 * pi * i / 64, v = -pi / 2 + pi * j / 64;
      EXPECT_NEAR(length(grid.evaluate_jet(u, v)->position), 1, 4 * double_unit);
    }
}

TEST(QuadricPatches, DegreesAreTheLowestThatDo) {
  const auto degrees = [](QuadricKind kind) {
    for (const QuadricSample& sample : quadric_samples())
      if (sample.kind == kind) {
        const PatchGrid grid = grid_of(piece(quadric(sample.coefficients), sample_range(kind)));
        return std::pair{grid.patches()[0].degree_u(), grid.patches()[0].degree_v()};
      }
    return std::pair{0, 0};
  };
  EXPECT_EQ(degrees(QuadricKind::ellipsoid), (std::pair{2, 2}));
  EXPECT_EQ(degrees(QuadricKind::hyperbolic_paraboloid), (std::pair{2, 2}));
  EXPECT_EQ(degrees(QuadricKind::elliptic_cone), (std::pair{2, 1}));
  EXPECT_EQ(degrees(QuadricKind::plane), (std::pair{1, 1}));
}

TEST(QuadricPatches, ConesHaveTheirApex) {
  const PatchGrid grid = grid_of(piece(quadric({.a = 1, .b = 1, .c = -1}), {0, 2 * pi, 0, 3}));
  for (const BezierPatch& patch : grid.patches()) EXPECT_TRUE(patch.collapsed_sides().has(Side::v0));
}

TEST(QuadricPatches, LongHyperbolasAreCut) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = -1, .k = -1}), {-20, 20, 0, 1});
  const PatchGrid grid = grid_of(part);
  EXPECT_EQ(grid.count_u(), 20u);
  for (int k = 0; k <= 400; ++k) {
    const double u = -20 + 0.1 * k;
    const Vec3 p = grid.evaluate_jet(std::min(u, 20.0), 0.5)->position;
    EXPECT_NEAR((p.x - p.y) * (p.x + p.y), 1, 1e-14 * (p.x * p.x + p.y * p.y));
  }
  EXPECT_EQ(to_bezier(piece(quadric({.a = 1, .b = -1, .k = -1}), {-300, 300, 0, 1}))->count_u(), 300u);
}

}}  // namespace tessera::test
