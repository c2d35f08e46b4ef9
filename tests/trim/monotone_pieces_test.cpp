#include "trim/monotone_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trim/loop_pieces.h"
#include "trim/quad_winding.h"
#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::Quad;

double error(Quad a, Quad b) { return static_cast<double>(a > b ? a - b : b - a); }

bool is_monotone(const PlaneBezier& curve, double ParameterPoint::*x) {
  const double sign = curve.points.front().*x <= curve.points.back().*x ? 1 : -1;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
    if (sign * (curve.points[i + 1].*x - curve.points[i].*x) < 0) return false;
  return true;
}

bool crosses(const CutAxis& axis, double a, double b) {
  for (const double line : axis.lines)
    if (std::min(a, b) < line && line < std::max(a, b)) return true;
  return false;
}

const CutLines& lines() {
  static const CutLines all{{{0, 0.25, 0.3, 0.75, 1}, false, 0x1p-44}, {{0, 0.5, 1}, false, 0x1p-44}};
  return all;
}

/// The distance of p from the curve near t, in u and in v, without the part along the curve: ranges are rounded.
ParameterPoint distance_across(const test::QuadBezier& curve, Quad t, const ParameterPoint& p) {
  const Quad step = 1e-12;
  const auto before = curve.at(t - step), after = curve.at(t + step), at = curve.at(t);
  const Quad du = (after.u - before.u) / (2 * step), dv = (after.v - before.v) / (2 * step);
  const Quad along = ((p.u - at.u) * du + (p.v - at.v) * dv) / (du * du + dv * dv);
  EXPECT_LE(error(along, 0), 1e-12);
  const auto nearest = curve.at(t + along);
  return {error(p.u, nearest.u), error(p.v, nearest.v)};
}

/// Checks that the pieces are monotone, cross no line, follow each other, and keep their error.
void check(const TrimLoop& loop, const std::vector<TrimPiece>& pieces) {
  const auto quads = test::quad_beziers(std::span(&loop, 1));
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const TrimPiece& piece = pieces[k];
    ASSERT_TRUE(is_monotone(piece.curve, &ParameterPoint::u) && is_monotone(piece.curve, &ParameterPoint::v));
    ASSERT_FALSE(crosses(lines().u, piece.start().u, piece.end().u));
    ASSERT_FALSE(crosses(lines().v, piece.start().v, piece.end().v));
    ASSERT_EQ(piece.end(), pieces[(k + 1) % pieces.size()].start());
    ASSERT_LE(piece.error.u, 1e-14);
    ASSERT_LE(piece.error.v, 1e-14);
    const double middle = 0.5 * piece.range.from + 0.5 * piece.range.to;
    const auto quad = std::find_if(quads.begin(), quads.end(),
                                   [&](const test::QuadBezier& q) { return q.from <= middle && middle <= q.to; });
    ASSERT_NE(quad, quads.end());
    for (const double s : {0.0, 0.3, 0.5, 0.9, 1.0}) {
      const Quad t = piece.range.from + Quad(s) * (Quad(piece.range.to) - piece.range.from);
      const ParameterPoint p = relative_point(piece.curve, {}, s);
      const ParameterPoint off = distance_across(*quad, (t - quad->from) / (Quad(quad->to) - quad->from), p);
      const double evaluation = plane_error(piece.curve.degree());
      ASSERT_LE(off.u, 1.5 * (piece.error.u + evaluation));
      ASSERT_LE(off.v, 1.5 * (piece.error.v + evaluation));
    }
  }
}

TEST(MonotonePieces, FollowRandomCurves) {
  std::mt19937 random(1);
  std::size_t count = 0;
  for (int k = 0; k < 300; ++k) {
    const TrimLoop loop = test::random_loop(random);
    const LoopPieces made = test::pieces_of(loop, 7, lines());
    check(loop, made.pieces);
    if (HasFatalFailure()) return;
    EXPECT_EQ(made.gaps, 0u);
    for (const TrimPiece& piece : made.pieces) EXPECT_EQ(piece.loop, 7u);
    count += made.pieces.size();
  }
  EXPECT_GT(count, 3000u);
}

TEST(MonotonePieces, EndsOnLinesHaveTheirNumber) {
  const LoopPieces made = test::pieces_of(test::circle({0.5, 0.5}, 0.4), 0, lines());
  int on_lines = 0;
  for (const TrimPiece& piece : made.pieces) on_lines += lines().u.is_line(piece.end().u);
  EXPECT_EQ(on_lines, 6);                 // two for each inner line that it crosses
  EXPECT_EQ(made.pieces.size(), 4u + 6);  // the line v = 0.5 passes through ends of arcs
}

TEST(MonotonePieces, CutLinesStayExact) {
  const LoopPieces made = test::pieces_of(test::polygon({{0.1, 0.2}, {0.9, 0.31}, {0.4, 0.8}}), 0, lines());
  EXPECT_EQ(made.pieces.size(), 4u + 3 + 3);  // the last side passes through (0.25, 0.5)
  for (const TrimPiece& piece : made.pieces) {
    EXPECT_TRUE(piece.exact_line);
    EXPECT_EQ(piece.error, ParameterPoint{});
  }
}

TEST(MonotonePieces, CurvesAlongALineMoveOntoIt) {
  const double near = 0.75 + 1e-14;
  const LoopPieces made =
      test::pieces_of(test::polygon({{near, 0.1}, {near, 0.4}, {0.9, 0.4}, {0.9, 0.1}}), 0, lines());
  EXPECT_EQ(made.pieces.front().start(), (ParameterPoint{0.75, 0.1}));
  EXPECT_EQ(made.pieces.front().end(), (ParameterPoint{0.75, 0.4}));
  EXPECT_GE(made.pieces.front().error.u, 0.9e-14);
  EXPECT_EQ(made.gaps, 0u);
}

}}  // namespace tessera
