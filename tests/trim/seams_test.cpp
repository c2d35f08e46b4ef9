// Regions of periodic surfaces: loops over seams and around the surface.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tessera/trim_region.h"
#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::value_of;

constexpr Domain unit{0, 1, 0, 1};

TrimSide side(bool inside) { return inside ? TrimSide::inside : TrimSide::outside; }

TEST(TrimRegion, SeamsOfPeriodicSurfaces) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<double> breaks{0, 0.25, 0.5, 0.75, 1};
  const double turn = 1;
  const std::vector<TrimLoop> loops{{{test::line({0.5, 0.1}, {0.5 + turn, 0.1})}},
                                    {{test::line({0.5 + turn, 0.9}, {0.5, 0.9})}},
                                    test::circle({0, 0.5}, 0.2, true),
                                    test::circle({3.5, 0.5}, 0.1, true)};
  const TrimRegion region = value_of(TrimRegion::make(loops, breaks, breaks, {.periodic_u = true}));
  EXPECT_TRUE(region.remarks().empty());
  for (int k = 0; k < 100000; ++k) {
    const double u = uniform(random), v = uniform(random);
    const double over_seam = std::hypot(std::min(u, 1 - u), v - 0.5), middle = std::hypot(u - 0.5, v - 0.5);
    ASSERT_EQ(region.locate(u, v), side(v > 0.1 && v < 0.9 && over_seam > 0.2 && middle > 0.1)) << u << ' ' << v;
  }
  EXPECT_EQ(region.patch(1, 1), TrimSide::border);
}

/// A window of a torus may lie where both seams cross, and in any copy of the domain.
TEST(TrimRegion, WindowsWhereBothSeamsCross) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<double> breaks{0, 0.25, 0.5, 0.75, 1};
  const TrimOptions torus{.periodic_u = true, .periodic_v = true};
  const auto around = [](double u, double v) { return std::hypot(std::min(u, 1 - u), std::min(v, 1 - v)); };
  for (const ParameterPoint center : {ParameterPoint{0, 0}, ParameterPoint{1, 0}, ParameterPoint{1, 1},
                                      ParameterPoint{0, 1}, ParameterPoint{-2, 3}}) {
    for (const bool hole : {false, true}) {
      std::vector<TrimLoop> loops{test::circle(center, 0.2, hole)};
      for (int ring = 0; ring < 2; ++ring) {
        const TrimRegion region = value_of(TrimRegion::make(loops, breaks, breaks, torus));
        EXPECT_TRUE(region.remarks().empty());
        for (int k = 0; k < 5000; ++k) {
          const double u = uniform(random), v = uniform(random), distance = around(u, v);
          const bool within = distance < 0.2 && (ring == 0 || distance > 0.1);
          ASSERT_EQ(region.locate(u, v), side(within != hole)) << center.u << ' ' << center.v << ": " << u << ' ' << v;
        }
        loops.push_back(test::circle({center.u + 1, center.v}, 0.1, hole));
      }
    }
  }
  // Beside the corner, over one seam: the corner is not enclosed.
  const TrimRegion beside =
      value_of(TrimRegion::make(std::vector{test::circle({1, 0.5}, 0.2, true)}, breaks, breaks, torus));
  EXPECT_EQ(beside.locate(0, 0), TrimSide::inside);
  EXPECT_EQ(beside.locate(0.1, 0.5), TrimSide::outside);
}

/// Windows at random places of a torus: a point is enclosed by as many copies of a loop as in the unrolled plane.
TEST(TrimRegion, WindowsAtRandomOnATorus) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> uniform(-1, 2);
  const std::vector<double> breaks{0, 0.3, 1};
  for (int k = 0; k < 300; ++k) {
    std::vector<TrimLoop> loops;
    for (int i = 0; i <= k % 3; ++i) {
      std::vector<ParameterPoint> corners;
      const double u = uniform(random), v = uniform(random);
      for (int c = 0; c < 5; ++c) corners.push_back({u + 0.3 * uniform(random), v + 0.3 * uniform(random)});
      loops.push_back(test::polygon(corners));
    }
    const TrimRegion region =
        value_of(TrimRegion::make(loops, breaks, breaks, {.periodic_u = true, .periodic_v = true}));
    const TrimRegion plane = value_of(TrimRegion::make(loops, Domain{-10, 10, -10, 10}));
    for (int i = 0; i < 100; ++i) {
      const double u = 0.5 * std::abs(uniform(random)), v = 0.5 * std::abs(uniform(random));
      bool inside = false, border = false;
      for (int a = -4; a <= 4; ++a)
        for (int b = -4; b <= 4; ++b) {
          inside ^= plane.locate(u + a, v + b) == TrimSide::inside;
          for (const double du : {-1e-12, 1e-12})  // rounded sums
            for (const double dv : {-1e-12, 1e-12})
              border = border || plane.locate(u + a + du, v + b + dv) != plane.locate(u + a, v + b);
        }
      if (border) continue;
      ASSERT_EQ(region.locate(u, v), side(inside)) << k << ": " << u << ' ' << v;
    }
  }
}

/// Curves that end beyond a seam by more than rounding, as OpenCASCADE writes them.
TEST(TrimRegion, GapsAcrossASeam) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<double> breaks{0, 0.25, 0.5, 0.75, 1};
  for (const double off : {1e-12, 1e-9, 1e-6, -1e-12, -1e-9, -1e-6})
    for (const bool left : {false, true}) {
      // A rectangle around the surface, bounded by the seam; one corner is off.
      TrimLoop loop;
      const double a = left ? off : 0, b = left ? 1 : 1 + off;
      loop.curves = {test::line({0, 0.25}, {1, 0.25}), test::line({b, 0.25}, {b, 0.75}),
                     test::line({b, 0.75}, {a, 0.75}), test::line({0, 0.75}, {0, 0.25})};
      const TrimRegion region = value_of(TrimRegion::make(std::span(&loop, 1), breaks, breaks, {.periodic_u = true}));
      for (int k = 0; k < 2000; ++k) {
        const double u = 2e-6 + (1 - 4e-6) * uniform(random), v = uniform(random);
        ASSERT_EQ(region.locate(u, v), side(v > 0.25 && v < 0.75)) << off << left << ": " << u << ' ' << v;
      }
    }
}

/// A torus cut open along both seams, with a window where they cross; parts of its outline are off by more than
/// rounding, as OpenCASCADE writes them.
TEST(TrimRegion, GapsWhereBothSeamsCross) {
  std::mt19937 random(16);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<double> breaks{0, 0.25, 0.5, 0.75, 1};
  for (const double off : {0.0, 1e-13, -1e-13, 1e-9, -1e-9})
    for (int part = 0; part < 64; ++part) {
      const auto at = [&](int bit) { return (part >> bit) % 2 == 1 ? off : 0; };
      TrimLoop loop;
      loop.curves = {test::line({0, at(0)}, {1, at(0)}),           test::line({1 + at(1), 0}, {0.75, 0.125}),
                     test::line({0.75, 0.125}, {1 + at(1), 0.25}), test::line({1 + at(2), 0.25}, {1 + at(2), 1}),
                     test::line({1, 1 + at(3)}, {0, 1 + at(3)}),   test::line({at(4), 1}, {at(4), 0.25}),
                     test::line({at(5), 0.25}, {0.25, 0.125}),     test::line({0.25, 0.125}, {at(5), 0})};
      const TrimRegion region =
          value_of(TrimRegion::make(std::span(&loop, 1), breaks, breaks, {.periodic_u = true, .periodic_v = true}));
      for (int k = 0; k < 300; ++k) {
        const double u = uniform(random), v = uniform(random);
        const double kept = std::min(u, 1 - u) - 2 * std::min(v, 0.25 - v);
        if (std::abs(kept) < 1e-7 || std::min({u, v, 1 - u, 1 - v}) < 1e-7) continue;
        ASSERT_EQ(region.locate(u, v), side(kept > 0)) << off << " in " << part << ": " << u << ' ' << v;
      }
    }
}

}}  // namespace tessera
