// Chords of loops, and bounds on their slivers.

#include "tess/trimmed/piece_chords.h"

#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess/trimmed/speed_bound.h"
#include "tessera/bezier_patch.h"

namespace tessera::test { namespace {

/// The arc of the unit circle from one angle to another, as a rational parabola.
TrimPiece arc(double from, double to) {
  const double middle = (from + to) / 2, weight = std::cos((to - from) / 2);
  TrimPiece piece;
  piece.curve.points = {{std::cos(from), std::sin(from)},
                        {std::cos(middle) / weight, std::sin(middle) / weight},
                        {std::cos(to), std::sin(to)}};
  piece.curve.weights = {1, weight, 1};
  piece.range = {from, to};
  return piece;
}

/// The chords of pieces on a plane with lengths as in the parameters.
struct Chords {
  std::vector<ParameterPoint> points;
  std::vector<double> parameters;
  double sliver = 0;
};
Chords chords_of(const std::vector<TrimPiece>& pieces, double most, const std::atomic<bool>* cancel = nullptr) {
  Chords chords;
  const ChordLimits limits{.sliver = most, .box = {10, 10}, .speed = {1, 1, 0}, .cancel = cancel};
  chords.sliver = PieceChords().append(pieces, limits, chords.points, chords.parameters);
  return chords;
}

TEST(PieceChords, OfAnArcAreAsFewAsItsSagittasAllow) {
  const auto sagitta = [](int count) { return 1 - std::cos(std::numbers::pi / 4 / count); };
  for (const int count : {1, 2, 4, 8, 16}) {
    const Chords fine = chords_of({arc(0, std::numbers::pi / 2)}, sagitta(count) * (1 + 1e-9));
    EXPECT_EQ(fine.points.size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(fine.sliver, sagitta(count), 1e-12);
  }
  // Even parts of a parabola's parameter are uneven parts of the arc, by up to 6% of their sagittas.
  for (int count = 1; count <= 16; ++count)
    EXPECT_EQ(chords_of({arc(0, std::numbers::pi / 2)}, 1.06 * sagitta(count)).points.size(),
              static_cast<std::size_t>(count));
}

TEST(PieceChords, AreNotHalvedOnceTheCallIsCancelled) {
  std::atomic<bool> cancel = false;
  EXPECT_GT(chords_of({arc(0, std::numbers::pi / 2)}, 1e-9, &cancel).points.size(), 1000u);
  cancel = true;
  EXPECT_EQ(chords_of({arc(0, std::numbers::pi / 2)}, 1e-9, &cancel).points.size(), 1u);
}

TEST(PieceChords, SpanPiecesThatTurnBackALittle) {
  const auto around_top = [](double angle) {
    return std::vector{arc(std::numbers::pi / 2 - angle, std::numbers::pi / 2),
                       arc(std::numbers::pi / 2, std::numbers::pi / 2 + angle)};
  };
  EXPECT_EQ(chords_of(around_top(0.2), 0.1).points.size(), 1u);
  EXPECT_GE(chords_of(around_top(0.2), 0.1).sliver, 1 - std::cos(0.2));
  EXPECT_EQ(chords_of(around_top(1.5), 10).points.size(), 2u);  // half a circle has an inside
}

TEST(SpeedBound, OfParallelogramsIsTheirLengths) {
  const auto patch = [](const Vec3& u, const Vec3& v) {
    const Vec3 at{5, 6, 7};
    return value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{at, at + v, at + u, at + u + v}));
  };
  const SpeedBound straight = SpeedBound::of(patch({3, 0, 0}, {0, 4, 0}));
  EXPECT_NEAR(straight.u, 3, 1e-9);
  EXPECT_NEAR(straight.v, 4, 1e-9);
  EXPECT_NEAR(straight.product, 0, 1e-9);
  EXPECT_NEAR(straight.moved(1, 1), 5, 1e-9);
  const SpeedBound skewed = SpeedBound::of(patch({3, 0, 0}, {3, 4, 0}));
  EXPECT_NEAR(skewed.product, 9, 1e-9);
  EXPECT_NEAR(skewed.moved(1, 1), length(Vec3{6, 4, 0}), 1e-9);
}

}}  // namespace tessera::test
