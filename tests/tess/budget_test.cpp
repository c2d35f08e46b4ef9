// Budgets of triangles: the tolerance that is found, against all others.

#include <algorithm>
#include <cmath>

#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// A bilinear patch over the unit square at (x, y), by its heights at (x, y), (x, y + 1), (x + 1, y) and
/// (x + 1, y + 1).
BezierPatch saddle(double x, double y, double a, double b, double c, double d) {
  const std::vector<Vec3> points{{x, y, a}, {x, y + 1, b}, {x + 1, y, c}, {x + 1, y + 1, d}};
  return value_of(BezierPatch::polynomial(1, 1, points));
}

/// A field of saddles with random heights on its corners, quarters of a unit.
std::vector<BezierPatch> field_of_saddles(Random& random, int columns, int rows) {
  std::vector<double> heights(std::size_t((columns + 1) * (rows + 1)));
  for (double& height : heights) height = std::floor(uniform(random, 0, 5)) / 4;
  const auto at = [&](int x, int y) { return heights[std::size_t(x * (rows + 1) + y)]; };
  std::vector<BezierPatch> patches;
  for (int x = 0; x < columns; ++x)
    for (int y = 0; y < rows; ++y)
      patches.push_back(saddle(x, y, at(x, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1)));
  return patches;
}

bool suffice(const PatchSet& set, double tolerance, std::uint64_t budget) {
  return Tessellation::make(set, {.tolerance = tolerance, .max_triangles = budget}).ok();
}

/// The step k whose tolerance 2^(k/128) is the largest that is no smaller than the plan's bound, and that it takes.
void expect_no_smaller_tolerance(const PatchSet& set, std::uint64_t budget) {
  const Tessellation plan = good(Tessellation::make(set, {.budget = budget}));
  EXPECT_LE(plan.capacity().triangles, budget);
  if (plan.bound() < 1e-6) return;  // flat
  // The plan's bound may lie below its own tolerance, never above it.
  const int first = int(std::floor(128 * std::log2(plan.bound())));
  for (int step = first; step > first - 128; --step)
    EXPECT_FALSE(suffice(set, std::exp2(step / 128.0), budget))
        << "2^(" << step << "/128) instead of the bound " << plan.bound() << " for " << budget << " triangles";
}

TEST(Budgets, ASmallerToleranceThatTakesFewerTrianglesIsFound) {
  const PatchSet set = set_of({saddle(0, 0, 0, 0.25, 0, 0.75), saddle(1, 0, 0, 0.75, 0.5, 0)});
  const Tessellation plan = good(Tessellation::make(set, {.budget = 500}));
  EXPECT_LE(plan.capacity().triangles, 500u);
  EXPECT_LE(plan.bound(), 0.00182 * 1.0055);
  expect_no_smaller_tolerance(set, 500);
}

TEST(Budgets, NoToleranceOfTheStepsBelowSuffices) {
  Random random(26);
  for (int k = 0; k < 150; ++k) {
    const int columns = 1 + k % 4, rows = 1 + k / 4 % 2;
    const PatchSet set = set_of(field_of_saddles(random, columns, rows));
    const auto budget = std::uint64_t(std::floor(std::exp(uniform(random, std::log(40.0), std::log(2000.0)))));
    expect_no_smaller_tolerance(set, budget);
    if (HasFailure()) FAIL() << "set " << k;
  }
}

}}  // namespace tessera::test
