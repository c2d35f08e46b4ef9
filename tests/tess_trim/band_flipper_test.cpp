// Turning of edges that fold a band.

#include "tess/trimmed/band_flipper.h"

#include <array>
#include <atomic>

#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

TEST(BandFlipper, StopsWhenCancelled) {
  // A ridge along u = 1/2: the diagonal from (0, 1/2) to (1, 1/2) folds it, the other one follows it.
  const std::vector<Vec3> points{{0, 0, 0}, {0, 1, 0}, {0.5, 0, 9}, {0.5, 1, 9}, {1, 0, 0}, {1, 1, 0}};
  const BezierPatch ridge = value_of(BezierPatch::polynomial(2, 1, points));
  const std::vector<ParameterPoint> vertices{{0, 0.5}, {0.5, 0.49}, {1, 0.5}, {0.5, 0.51}};
  const std::vector<BandFlipper::Triangle> folded{{0, 1, 2}, {0, 2, 3}};
  const auto any = [](const auto&, const auto&, const auto&, const auto&) { return true; };
  std::atomic<bool> cancel = false;
  const auto flipped = [&](const std::atomic<bool>* flag) {
    std::vector<BandFlipper::Triangle> triangles = folded;
    PatchPoints at(ridge, {});
    BandFlipper(at, vertices).run(triangles, 0, any, flag);
    return triangles;
  };
  EXPECT_NE(flipped(nullptr), folded);
  EXPECT_NE(flipped(&cancel), folded);
  cancel = true;
  EXPECT_EQ(flipped(&cancel), folded);
}

}}  // namespace tessera::test
