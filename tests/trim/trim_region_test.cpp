#include "tessera/trim_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "trim/quad_winding.h"
#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::Quad;
using test::value_of;

constexpr Domain trim_region_unit{0, 1, 0, 1};

TrimSide trim_region_side(bool inside) { return inside ? TrimSide::inside : TrimSide::outside; }

/// A point at `distance` times a random number from the loops, which are in quadruple numbers.
ParameterPoint point_near(std::mt19937& random, std::span<const test::QuadBezier> curves, double distance) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto on = curves[random() % curves.size()].at(0.5 + 0.5 * uniform(random));
  return {static_cast<double>(on.u + distance * uniform(random)),
          static_cast<double>(on.v + distance * uniform(random))};
}

/// Compares a region with the checker at all distances from the loops. Returns how many points of the last distance,
/// 1e-15, were told to be on the border.
int compare(const TrimRegion& region, std::span<const TrimLoop> loops, std::mt19937& random, int points) {
  const auto curves = test::quad_beziers(loops);
  int border = 0;
  for (double distance = 1; distance > 0.9e-15; distance *= 0.1) {
    border = 0;
    for (int k = 0; k < points; ++k) {
      const ParameterPoint q = point_near(random, curves, distance);
      const TrimSide found = region.locate(q.u, q.v);
      if (!trim_region_unit.contains(q.u, q.v)) {
        EXPECT_EQ(found, TrimSide::outside);
        continue;
      }
      if (found == TrimSide::border) {
        const ParameterPoint band = region.band();
        EXPECT_TRUE(std::any_of(curves.begin(), curves.end(), [&](const test::QuadBezier& curve) {
          return test::passes(curve.points, q.u, q.v, band.u, band.v);
        })) << "too far from a loop";
        ++border;
        continue;
      }
      const std::optional<bool> expected = test::encloses(curves, q.u, q.v);
      if (!expected)
        ADD_FAILURE() << "a point on a loop is told to be beside it";
      else if (found != trim_region_side(*expected))
        ADD_FAILURE() << "(" << q.u << ", " << q.v << ") at " << distance;
      if (testing::Test::HasFailure()) return border;
    }
  }
  return border;
}

TEST(TrimRegion, CirclesInClosedForm) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<TrimLoop> loops;
  std::vector<std::array<double, 3>> circles;
  for (int k = 0; k < 20; ++k) {
    circles.push_back({0.1 + 0.2 * (k % 5), 0.13 + 0.25 * (k / 5), 0.06 + 0.03 * uniform(random)});
    loops.push_back(test::circle({circles[k][0], circles[k][1]}, circles[k][2], true));
  }
  const TrimRegion region = value_of(TrimRegion::make(loops, trim_region_unit));
  EXPECT_TRUE(region.remarks().empty());
  EXPECT_LE(region.band().u, 1e-15);
  for (double distance = 1; distance > 0.5e-15; distance *= 0.1) {
    for (int k = 0; k < 5000; ++k) {
      const auto& [u, v, radius] = circles[static_cast<std::size_t>(k) % 20];
      const double angle = std::numbers::pi * uniform(random), r = radius + distance * uniform(random);
      const double x = u + r * std::cos(angle), y = v + r * std::sin(angle);
      if (!trim_region_unit.contains(x, y)) continue;
      const TrimSide found = region.locate(x, y);
      bool inside = true, near = false;
      for (const auto& [cu, cv, cr] : circles) {
        const Quad square = (Quad(x) - cu) * (Quad(x) - cu) + (Quad(y) - cv) * (Quad(y) - cv);
        inside = inside && square > Quad(cr) * cr;
        near = near || std::abs(static_cast<double>(square - Quad(cr) * cr)) < 2 * cr * 1e-15;
      }
      if (near) continue;  // the rounded weights make a circle that is 1e-16 off
      ASSERT_EQ(found, trim_region_side(inside)) << distance;
    }
  }
}

TEST(TrimRegion, PolygonsAreExactToTheLastBit) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> whole(0, 64);
  for (int k = 0; k < 300; ++k) {
    const std::vector<double> breaks{0, k % 3 == 0 ? 0.25 : 0.2, k % 3 == 0 ? 0.5 : 0.55, 1};
    std::vector<ParameterPoint> corners;
    for (int i = 0; i < 3 + k % 9; ++i) corners.push_back({whole(random) / 64.0, whole(random) / 64.0});
    const std::vector<TrimLoop> loops{k % 2 == 0 ? test::polygon(corners) : test::polyline(corners)};
    const TrimRegion region = value_of(TrimRegion::make(loops, breaks, breaks));
    if (region.remarks().size() > 0) continue;  // edges that run over each other
    EXPECT_EQ(region.band(), ParameterPoint{});
    for (int i = 0; i < 400; ++i) {
      ParameterPoint q{whole(random) / 64.0, whole(random) / 64.0};
      if (i % 3 == 1) q = corners[static_cast<std::size_t>(i) % corners.size()];
      if (i % 2 == 1 && q.u > 0) q.u = std::nextafter(q.u, random() % 2 == 0 ? 2.0 : -2.0);
      if (!trim_region_unit.contains(q.u, q.v)) continue;
      bool inside = false, on = false;
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const ParameterPoint &a = corners[c], &b = corners[(c + 1) % corners.size()];
        const Quad d = (Quad(b.u) - a.u) * (Quad(q.v) - a.v) - (Quad(b.v) - a.v) * (Quad(q.u) - a.u);
        on = on || (d == 0 && q.u >= std::min(a.u, b.u) && q.u <= std::max(a.u, b.u) && q.v >= std::min(a.v, b.v) &&
                    q.v <= std::max(a.v, b.v));
        if ((a.v > q.v) != (b.v > q.v)) inside ^= (d > 0) == (b.v > a.v);
      }
      ASSERT_EQ(region.locate(q.u, q.v), on ? TrimSide::border : trim_region_side(inside)) << k << ' ' << i;
    }
  }
}

TEST(TrimRegion, RandomLoopsAgreeWithWindingNumbersIn128Bits) {
  std::mt19937 random(3);
  const std::vector<double> breaks_u{0, 0.35, 0.5, 1}, breaks_v{0, 0.8, 1};
  int border = 0;
  for (int k = 0; k < 12; ++k) {
    std::vector<TrimLoop> loops;
    for (int i = 0; i <= k % 4; ++i) loops.push_back(test::random_loop(random));
    const TrimRegion region = value_of(TrimRegion::make(loops, breaks_u, breaks_v));
    EXPECT_LE(std::max(region.band().u, region.band().v), 3e-14);
    border += compare(region, loops, random, 80);
    if (HasFailure()) return;
  }
  EXPECT_GT(border, 50) << "no point is so near that rounding decides";
}

TEST(TrimRegion, OrderOrientationAndSplittingChangeNothing) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 20; ++k) {
    std::vector<TrimLoop> loops{test::random_loop(random), test::random_loop(random), test::circle({0.5, 0.5}, 0.3)};
    const TrimRegion region = value_of(TrimRegion::make(loops, trim_region_unit));
    std::vector<TrimLoop> changed;
    for (const TrimLoop& loop : loops) {
      const Curve& curve = loop.curves[0];
      std::vector<Vec3> points(curve.points().rbegin(), curve.points().rend());
      std::vector<double> weights(curve.weights().rbegin(), curve.weights().rend()), knots;
      for (auto knot = curve.knots().rbegin(); knot != curve.knots().rend(); ++knot) knots.push_back(-*knot);
      const Interval whole{-curve.domain().to, -curve.domain().from};
      const double middle = 0.7 * whole.from + 0.3 * whole.to;
      const auto part = [&](const Interval& domain) {
        return weights.empty() ? value_of(Curve::b_spline(curve.degree(), points, knots, domain))
                               : value_of(Curve::nurbs(curve.degree(), points, weights, knots, domain));
      };
      changed.insert(changed.begin(), {{part({middle, whole.to}), part({whole.from, middle})}, loop.hole});
    }
    const TrimRegion other = value_of(TrimRegion::make(changed, trim_region_unit));
    for (int i = 0; i < 20000; ++i) {
      const double u = uniform(random), v = uniform(random);
      ASSERT_EQ(region.locate(u, v), other.locate(u, v)) << u << ' ' << v;
    }
  }
}

TEST(TrimRegion, WhatIsInsideWithoutAnOuterLoop) {
  const TrimLoop hole = test::circle({0.5, 0.5}, 0.25, true), disc = test::circle({0.5, 0.5}, 0.25);
  const auto at = [](std::vector<TrimLoop> loops, double u) {
    return value_of(TrimRegion::make(loops, trim_region_unit)).locate(u, 0.5);
  };
  EXPECT_EQ(at({}, 0.5), TrimSide::inside);
  EXPECT_EQ(at({}, 0), TrimSide::inside);
  EXPECT_EQ(at({hole}, 0.5), TrimSide::outside);
  EXPECT_EQ(at({hole}, 0.1), TrimSide::inside);
  EXPECT_EQ(at({disc}, 0.5), TrimSide::inside);
  EXPECT_EQ(at({disc}, 0.1), TrimSide::outside);
  EXPECT_EQ(at({disc}, 0.75), TrimSide::border);
  EXPECT_EQ(at({test::rectangle(0, 1, 0, 1), hole}, 0.5), TrimSide::outside);
  EXPECT_EQ(at({hole, test::rectangle(0, 1, 0, 1)}, 0.1), TrimSide::inside);
  EXPECT_EQ(at({test::rectangle(0, 1, 0, 1)}, 0), TrimSide::border);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinite, -infinite, -1e-300, std::nextafter(1.0, 2)}) {
    EXPECT_EQ(at({}, bad), TrimSide::outside);
    EXPECT_EQ(at({test::rectangle(0, 1, 0, 1)}, bad), TrimSide::outside);
  }
}

TEST(TrimRegion, AHundredHolesInACell) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double size : {1e-3, 1e-6, 1e-9}) {
    std::vector<TrimLoop> loops{test::rectangle(0, 1, 0, 1)};
    const auto place = [&](int k) { return ParameterPoint{0.3 + size * (k % 10), 0.7 + size * (k / 10)}; };
    for (int k = 0; k < 100; ++k) loops.push_back(test::circle(place(k), 0.4 * size));
    const TrimRegion region = value_of(TrimRegion::make(loops, trim_region_unit));
    for (int i = 0; i < 100000; ++i) {
      const double u = 0.3 + size * (10 * uniform(random) - 0.5), v = 0.7 + size * (10 * uniform(random) - 0.5);
      bool inside = true;
      double nearest = 1;
      for (int k = 0; k < 100; ++k) {
        const double r = std::hypot(u - place(k).u, v - place(k).v) - 0.4 * size;
        inside = inside && r > 0;
        nearest = std::min(nearest, std::abs(r));
      }
      if (nearest <= 1e-15) continue;
      ASSERT_EQ(region.locate(u, v), trim_region_side(inside)) << size << ' ' << u << ' ' << v;
    }
  }
}

TEST(TrimRegion, LoopsAtADistanceOf1e12) {
  const double gap = 1e-12;
  std::mt19937 random(6);
  const std::vector<TrimLoop> loops{test::circle({0.5, 0.5}, 0.3), test::circle({0.5, 0.5}, 0.3 + gap),
                                    test::rectangle(0.1, 0.2, 0.1, 0.2), test::rectangle(0.2 + gap, 0.3, 0.1, 0.2)};
  const TrimRegion region = value_of(TrimRegion::make(loops, trim_region_unit));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 20000; ++k) {
    const double angle = 2 * std::numbers::pi * uniform(random);
    const auto at = [&](double r) { return region.locate(0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle)); };
    ASSERT_EQ(at(0.3 + 0.5 * gap), TrimSide::inside);
    ASSERT_EQ(at(0.3 - 0.2 * gap), TrimSide::outside);
    ASSERT_EQ(at(0.3 + 1.2 * gap), TrimSide::outside);
  }
  EXPECT_EQ(region.locate(0.2 + 0.5 * gap, 0.15), TrimSide::outside);
  EXPECT_EQ(region.locate(0.2 - 0.1 * gap, 0.15), TrimSide::inside);
  EXPECT_EQ(region.locate(0.2 + 1.1 * gap, 0.15), TrimSide::inside);
}

TEST(TrimRegion, LoopsThatTouchTheDomainAndEachOther) {
  std::mt19937 random(7);
  // Holes that touch the border and each other, curves along lines between patches, a loop of one edge, coincident
  // ones.
  const std::vector<TrimLoop> loops{test::rectangle(0, 1, 0, 1),
                                    test::circle({0.25, 0.25}, 0.25),
                                    test::circle({0.75, 0.25}, 0.25),
                                    test::rectangle(0.5, 0.75, 0.5, 0.75),
                                    test::polygon({{0.5, 0.75}, {0.75, 0.75}, {0.625, 1}}),
                                    test::rectangle(0.1, 0.2, 0.6, 0.8),
                                    test::rectangle(0.1, 0.2, 0.6, 0.8)};
  const std::vector<double> breaks{0, 0.25, 0.5, 0.75, 1};
  const TrimRegion region = value_of(TrimRegion::make(loops, breaks, breaks));
  EXPECT_TRUE(region.remarks().empty());
  compare(region, loops, random, 200);
}

/// A comb of many needles whose chords all have their middles at one u; each is compared with its neighbours alone.
TEST(TrimRegion, ChordsWithTheirMiddlesAtOneU) {
  std::vector<ParameterPoint> corners;
  constexpr int needles = 20000;
  for (int k = 0; k <= needles; ++k) corners.push_back({k % 2 == 0 ? 0.499 : 0.501, 0.1 + 0.8 * k / needles});
  corners.push_back({0.9, 0.9});
  corners.push_back({0.9, 0.1});
  const TrimRegion region = value_of(TrimRegion::make(std::vector{test::polyline(corners)}, trim_region_unit));
  EXPECT_TRUE(region.remarks().empty());
  EXPECT_EQ(region.locate(0.8, 0.5), TrimSide::inside);
  EXPECT_EQ(region.locate(0.2, 0.5), TrimSide::outside);
}

TEST(TrimRegion, BadLoopsAreRepairedAndTold) {
  std::mt19937 random(8);
  const TrimLoop bow = test::polygon({{0.1, 0.1}, {0.9, 0.9}, {0.9, 0.1}, {0.1, 0.9}});
  const TrimLoop outside = test::rectangle(0.5, 1.5, 0.2, 0.8), clipped = test::rectangle(0.5, 1, 0.2, 0.8);
  const TrimLoop open{{test::line({0.1, 0.1}, {0.6, 0.1}), test::line({0.6, 0.1}, {0.3, 0.9})}};
  const TrimLoop closed = test::polygon({{0.1, 0.1}, {0.6, 0.1}, {0.3, 0.9}});
  const std::vector<std::pair<TrimLoop, TrimLoop>> cases{{bow, bow}, {outside, clipped}, {open, closed}};
  for (const auto& [loop, repaired] : cases) {
    const TrimRegion region = value_of(TrimRegion::make(std::span(&loop, 1), trim_region_unit));
    EXPECT_EQ(region.remarks().size(), &loop == &cases[0].first ? 0u : 1u);
    compare(region, std::span(&repaired, 1), random, 150);
  }
}

TEST(TrimRegion, PatchesAreWholeCutOrLeftOut) {
  const std::vector<double> breaks{0, 0.2, 0.4, 0.6, 0.8, 1};
  const TrimRegion region = value_of(TrimRegion::make(
      std::vector{test::rectangle(0.2, 0.8, 0.2, 0.8), test::circle({0.5, 0.5}, 0.05)}, breaks, breaks));
  EXPECT_FALSE(region.is_whole());
  for (std::size_t a = 0; a < 5; ++a)
    for (std::size_t b = 0; b < 5; ++b) {
      const bool rim = a == 0 || a == 4 || b == 0 || b == 4, middle = a == 2 && b == 2;
      EXPECT_EQ(region.patch(a, b), middle ? TrimSide::border : trim_region_side(!rim)) << a << ' ' << b;
    }
  EXPECT_TRUE(value_of(TrimRegion::make(std::vector{test::rectangle(0, 1, 0, 1)}, breaks, breaks)).is_whole());
  EXPECT_TRUE(value_of(TrimRegion::make({}, breaks, breaks)).is_whole());
}

TEST(TrimRegion, LocatesManyPointsAtOnce) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  const TrimRegion region = value_of(TrimRegion::make(std::vector{test::random_loop(random)}, trim_region_unit));
  std::vector<double> u(1000), v(1000);
  std::vector<TrimSide> sides(1000);
  for (double& x : u) x = uniform(random);
  for (double& x : v) x = uniform(random);
  ASSERT_TRUE(region.locate(u, v, sides).ok());
  for (std::size_t k = 0; k < u.size(); ++k) EXPECT_EQ(sides[k], region.locate(u[k], v[k]));
  const Status status = region.locate(u, v, std::span(sides).first(999));
  EXPECT_EQ(status.code(), StatusCode::count_mismatch);
  EXPECT_EQ(status.message(), "there are 1000 values of u, 1000 of v, and room for 999 sides");
}

TEST(TrimRegion, BadArguments) {
  const auto fault = [](std::vector<double> u, std::vector<double> v, const TrimOptions& options = {}) {
    return TrimRegion::make({}, u, v, options).status();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault({0}, {0, 1}).message(), "breaks_u must have at least 2 values, found 1");
  EXPECT_EQ(fault({0, 1}, {0, nan, 1}).message(), "breaks_v[1] is nan");
  EXPECT_EQ(fault({0, 1}, {0, nan, 1}).code(), StatusCode::non_finite);
  EXPECT_EQ(fault({0, 1}, {0, 1, 1}).message(), "breaks_v[2] does not increase: 1");
  EXPECT_EQ(fault({0, 1e200}, {0, 1}).message(), "breaks_u[1] is 1e+200; the largest is limited to 1e+100");
  EXPECT_EQ(fault({0, 1}, {0, 1}, {.snap = nan}).message(), "snap must be from 0 to 0.001, found nan");
  EXPECT_EQ(fault({0, 1}, {0, 1}, {.snap = 0.1}).message(), "snap must be from 0 to 0.001, found 0.1");
}

}}  // namespace tessera
