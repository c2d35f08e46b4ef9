#include "trim/loop_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::value_of;

CutLines unit_lines(bool periodic_u = false, bool periodic_v = false) {
  return {{{0, 0.4, 1}, periodic_u, 0x1p-44}, {{0, 0.6, 1}, periodic_v, 0x1p-44}};
}

/// Repairs, and checks that an even number of ends meet at every point and that all pieces lie in the domain.
RepairedLoops repaired(const std::vector<TrimLoop>& loops, const CutLines& lines = unit_lines()) {
  const RepairedLoops made = value_of(repair_loops(loops, lines));
  std::map<std::pair<double, double>, int> ends;
  for (const TrimPiece& piece : made.pieces) {
    for (const ParameterPoint& p : piece.curve.points)
      EXPECT_TRUE(p.u >= 0 && p.u <= 1 && p.v >= 0 && p.v <= 1) << p.u << ' ' << p.v;
    ++ends[{piece.start().u, piece.start().v}];
    ++ends[{piece.end().u, piece.end().v}];
  }
  for (const auto& [end, count] : ends) EXPECT_EQ(count % 2, 0) << end.first << ' ' << end.second;
  return made;
}

/// The area of the region that the pieces enclose if they are all oriented as one loop; of polygons only.
double length_of(const RepairedLoops& made) {
  double length = 0;
  for (const TrimPiece& piece : made.pieces)
    length += std::hypot(piece.end().u - piece.start().u, piece.end().v - piece.start().v);
  return length;
}

TEST(LoopRepair, GoodLoopsStayAsTheyAre) {
  const RepairedLoops made = repaired({test::rectangle(0, 1, 0, 1), test::circle({0.5, 0.5}, 0.3, true)});
  EXPECT_TRUE(made.remarks.empty());
  EXPECT_FALSE(made.starts_inside);
  EXPECT_NEAR(length_of(made), 4 + 6 * 0.3, 0.1);
}

TEST(LoopRepair, GapsAreClosedAndTold) {
  const double gap = 0.01;
  TrimLoop loop{{test::line({0.1, 0.1}, {0.9, 0.1}), test::line({0.9, 0.1 + gap}, {0.9, 0.9}),
                 test::line({0.9, 0.9}, {0.1, 0.9})}};  // stops short: no fourth side
  const RepairedLoops made = repaired({test::rectangle(0, 1, 0, 1), loop});
  ASSERT_EQ(made.remarks.size(), 1u);
  EXPECT_EQ(made.remarks[0].loop, 1u);
  EXPECT_EQ(made.remarks[0].fault, LoopFault::gap);
  EXPECT_DOUBLE_EQ(made.remarks[0].size, 0.8);
  EXPECT_EQ(made.remarks[0].text, "loop 1: straight lines close 2 gaps, the largest of 0.8 between curves 2 and 0");
  EXPECT_NEAR(length_of(made), 4 + 3.2, 1e-12);
}

TEST(LoopRepair, RoundingIsNoGap) {
  for (const double gap : {1e-16, 1e-15, 2e-14}) {
    TrimLoop loop{{test::line({0.1, 0.1}, {0.9, 0.1}), test::line({0.9 + gap, 0.1 + gap}, {0.9, 0.9}),
                   test::line({0.9 - gap, 0.9}, {0.1, 0.9}), test::line({0.1, 0.9}, {0.1, 0.1 - gap})}};
    const RepairedLoops made = repaired({loop});
    EXPECT_TRUE(made.remarks.empty());
    EXPECT_EQ(made.pieces.size(), 8u);  // each side is cut once
  }
}

TEST(LoopRepair, LoopsWithoutInsideAreDropped) {
  const TrimLoop there_and_back = test::polygon({{0.2, 0.2}, {0.7, 0.3}});
  const Curve forward = value_of(Curve::bezier(std::vector<Vec3>{{0.1, 0.1, 0}, {0.5, 0.9, 0}, {0.9, 0.2, 0}}));
  const Curve back = value_of(Curve::bezier(std::vector<Vec3>{{0.9, 0.2, 0}, {0.5, 0.9, 0}, {0.1, 0.1, 0}}));
  const TrimLoop point{{test::line({0.5, 0.5}, {0.5, 0.5})}};
  const RepairedLoops made = repaired({there_and_back, {{forward, back}}, {}, point});
  EXPECT_TRUE(made.pieces.empty());
  EXPECT_TRUE(made.starts_inside) << "the surface is whole";
  ASSERT_EQ(made.remarks.size(), 4u);
  EXPECT_EQ(made.remarks[0].fault, LoopFault::retraced);
  EXPECT_EQ(made.remarks[1].fault, LoopFault::retraced);
  EXPECT_EQ(made.remarks[2].text, "loop 2: it has no curves");
  EXPECT_EQ(made.remarks[3].text, "loop 3: all of its curves are points");
}

TEST(LoopRepair, SlitsAreDropped) {
  const double noise = 1e-14;
  const RepairedLoops made =
      repaired({test::polygon({{0.1, 0.1}, {0.9, 0.1}, {0.5, 0.35}, {0.9, 0.1 + noise}, {0.9, 0.9}, {0.1, 0.9}})});
  ASSERT_EQ(made.remarks.size(), 1u);
  EXPECT_EQ(made.remarks[0].fault, LoopFault::retraced);
  EXPECT_NEAR(length_of(made), 3.2, 1e-12);
}

TEST(LoopRepair, LoopsOutsideAreCutOff) {
  const RepairedLoops made = repaired({test::rectangle(-0.25, 0.5, 0.5, 1.5)});
  ASSERT_EQ(made.remarks.size(), 1u);
  EXPECT_EQ(made.remarks[0].fault, LoopFault::outside);
  EXPECT_EQ(made.remarks[0].size, 0.5);
  EXPECT_NEAR(length_of(made), 2, 1e-12);  // [0, 0.5] x [0.5, 1]
  EXPECT_TRUE(repaired({test::circle({3, 3}, 0.5)}).pieces.empty());
  EXPECT_FALSE(repaired({test::circle({3, 3}, 0.5)}).starts_inside);
  const RepairedLoops around = repaired({test::circle({0.5, 0.5}, 3)});  // encloses the domain
  EXPECT_NEAR(length_of(around), 4, 1e-12);
}

TEST(LoopRepair, RandomLoopsAreClosedAfterCutting) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 300; ++k) {
    const double scale = 1 + uniform(random);
    TrimLoop loop = test::random_loop(random);
    std::vector<Vec3> points;
    for (const Vec3& p : loop.curves[0].points())
      points.push_back({0.5 + scale * (2 * p.x - 1), 0.5 + scale * (2 * p.y - 1), 0});
    const Curve& old = loop.curves[0];
    loop.curves[0] = old.is_rational() ? value_of(Curve::nurbs(old.degree(), points, old.weights(), old.knots()))
                                       : value_of(Curve::b_spline(old.degree(), points, old.knots()));
    for (const bool u : {false, true})
      for (const bool v : {false, true}) repaired({loop}, unit_lines(u, v));
    if (HasFailure()) return;
  }
}

TEST(LoopRepair, SeamsOfPeriodicSurfaces) {
  // A hole over the seam, once on each side of the domain.
  for (const double centre : {0.0, 1.0, -3.0, 7.0}) {
    const RepairedLoops made = repaired({test::circle({centre, 0.3}, 0.2)}, unit_lines(true));
    EXPECT_TRUE(made.remarks.empty());
    EXPECT_NEAR(length_of(made), 0.8 + 1.2, 0.1);  // the circle, and its diameter on both sides of the seam
  }
  // A cylinder's face between two circles that run around it; and with its seam.
  const TrimLoop bottom{{test::line({0, 0.2}, {1, 0.2})}}, top{{test::line({1.5, 0.9}, {0.5, 0.9})}};
  EXPECT_NEAR(length_of(repaired({bottom, top}, unit_lines(true))), 2 + 1.4, 1e-12);
  EXPECT_NEAR(length_of(repaired({test::rectangle(0, 1, 0.2, 0.9)}, unit_lines(true))), 2 + 1.4, 1e-12);
  EXPECT_TRUE(repaired({test::rectangle(0, 1, 0.2, 0.9)}, unit_lines(true)).remarks.empty());
  // A ball bounded by its seam alone.
  const TrimLoop seam{{test::line({0, 0}, {0, 1}), test::line({1, 1}, {1, 0})}};
  const RepairedLoops ball = repaired({seam}, unit_lines(true));
  EXPECT_TRUE(ball.pieces.empty() && ball.starts_inside);
  EXPECT_EQ(ball.remarks.at(0).fault, LoopFault::retraced);
}

TEST(LoopRepair, ALoopAroundTheSurfaceKeepsItsLeft) {
  const TrimLoop forward{{test::line({0, 0.2}, {1, 0.2})}}, back{{test::line({1, 0.2}, {0, 0.2})}};
  for (const bool left_is_above : {true, false}) {
    const RepairedLoops made = repaired({left_is_above ? forward : back}, unit_lines(true));
    EXPECT_EQ(made.remarks.at(0).fault, LoopFault::open);
    EXPECT_NEAR(length_of(made), 2 + 2 * (left_is_above ? 0.8 : 0.2), 1e-12);
  }
  const TrimLoop up{{test::line({0.7, 0}, {0.7, 1})}};
  EXPECT_NEAR(length_of(repaired({up}, unit_lines(false, true))), 2 + 1.4, 1e-12);
}

TEST(LoopRepair, RefusesWhatIsTooLarge) {
  const TrimLoop far = test::rectangle(0, 1e101, 0, 1);
  const Result<RepairedLoops> refused = repair_loops(std::vector{test::circle({0.5, 0.5}, 0.1), far}, unit_lines());
  EXPECT_EQ(refused.status().code(), StatusCode::unsupported);
  EXPECT_EQ(refused.status().index(), 1);
  EXPECT_EQ(refused.status().message(), "loop 1 has a coordinate of 1e+101; the largest is limited to 1e+100");
  const Result<RepairedLoops> turns = repair_loops(std::vector{test::rectangle(0, 100, 0, 1)}, unit_lines(true));
  EXPECT_EQ(turns.status().message(), "loop 0 runs over more than 64 periods of the surface");
}

}}  // namespace tessera
