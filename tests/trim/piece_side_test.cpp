#include "trim/piece_side.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trim/loop_pieces.h"
#include "trim/quad_winding.h"
#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::Quad;

const CutLines& piece_side_lines() {
  static const CutLines all{{{-10, 10}, false, 0}, {{-10, 10}, false, 0}};
  return all;
}

test::QuadBezier in_quad(const PlaneBezier& curve) {
  test::QuadBezier quad;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const Quad w = curve.weight(i);
    quad.points.push_back({w * curve.points[i].u, w * curve.points[i].v, w});
  }
  return quad;
}

/// Points around a piece: anywhere in and around its box, and next to it at all distances.
ParameterPoint random_point(std::mt19937& random, const TrimPiece& piece) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double t = 0.5 + 0.5 * uniform(random);
  const ParameterPoint on = precise_point(piece.curve, t).rounded();
  if (random() % 8 == 0) return {on.u, on.v};
  const double distance = std::pow(10, -8 + 8 * uniform(random));
  return {on.u + distance * uniform(random), random() % 4 == 0 ? on.v : on.v + distance * uniform(random)};
}

TEST(PieceSide, AgreesWithQuadrupleNumbersBeyondItsReach) {
  std::mt19937 random(1);
  int near = 0, decided = 0;
  for (int k = 0; k < 10; ++k) {
    for (const TrimPiece& piece : test::pieces_of(test::random_loop(random), 0, piece_side_lines()).pieces) {
      const test::QuadBezier quad = in_quad(piece.curve);
      const ParameterPoint most = reach(piece);
      for (int i = 0; i < 60; ++i) {
        const ParameterPoint q = random_point(random, piece);
        const std::optional<bool> crossing = test::crosses(quad.points, q.u, q.v, 1e-25);
        const PieceSide side = side_of(piece, q);
        if (side == PieceSide::near) {
          if (++near % 8 != 0) continue;
          const double rounding = piece.exact_line ? 1e-15 : 0;  // it was cut from a line a little beside
          ASSERT_TRUE(test::passes(quad.points, q.u, q.v, most.u + rounding, most.v + rounding));
          continue;
        }
        ++decided;
        if (piece.exact_line || !crossing) continue;  // the line is that of the caller's ends: tested below
        ASSERT_EQ(side == PieceSide::left, *crossing);
      }
    }
  }
  EXPECT_GT(decided, 5000);
  EXPECT_LT(near, decided / 2);
}

TEST(PieceSide, LinesAreExact) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 100000; ++k) {
    const TrimPiece piece = line_piece({uniform(random), uniform(random)}, {uniform(random), uniform(random)}, 0);
    const ParameterPoint q = random_point(random, piece);
    const ParameterPoint &a = piece.start(), &b = piece.end();
    const Quad determinant = (Quad(a.u) - q.u) * (Quad(b.v) - q.v) - (Quad(a.v) - q.v) * (Quad(b.u) - q.u);
    const bool at_height = piece.lower_v() <= q.v && q.v < piece.upper_v();
    PieceSide expected = PieceSide::beside;
    if (determinant == 0 && q.v >= piece.lower_v() && q.v <= piece.upper_v())
      expected = PieceSide::near;
    else if (at_height)
      expected = (determinant > 0) == (a.v < b.v) ? PieceSide::left : PieceSide::right;
    ASSERT_EQ(side_of(piece, q), expected);
  }
}

TEST(PieceSide, EndsBelongToTheUpperNeighbour) {
  const TrimPiece rising = line_piece({0, 0}, {1, 1}, 0), level = line_piece({0, 0}, {1, 0}, 0);
  EXPECT_EQ(side_of(rising, {-1, 0}), PieceSide::left);
  EXPECT_EQ(side_of(rising, {-1, 1}), PieceSide::beside);
  EXPECT_EQ(side_of(rising, {2, 0}), PieceSide::right);
  EXPECT_EQ(side_of(rising, {0, 0}), PieceSide::near);
  EXPECT_EQ(side_of(rising, {1, 1}), PieceSide::near);
  EXPECT_EQ(side_of(level, {-1, 0}), PieceSide::beside);
  EXPECT_EQ(side_of(level, {0.5, 0}), PieceSide::near);
  EXPECT_EQ(side_of(level, {0.5, 1e-300}), PieceSide::beside);
}

}}  // namespace tessera
