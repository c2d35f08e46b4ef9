// Patches with rates of their own on every border: a triangulation of the parameter square whose triangles keep within
// the cells that the rates promise.

#include "tess/cells/stitched_patch.h"
#include "tess/division_parameters.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>
#include <vector>

namespace tessera::test { namespace {

struct StitchedPatchPlace {
  double u, v;
};

std::vector<StitchedPatchPlace> places(const Division& division) {
  std::vector<StitchedPatchPlace> at;
  for_parameters(division, [&](double u, double v) { at.push_back({u, v}); });
  return at;
}

struct Corners {
  StitchedPatchPlace a, b, c;
  double twice_area() const { return (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v); }
  double low_u() const { return std::min({a.u, b.u, c.u}); }
  double high_u() const { return std::max({a.u, b.u, c.u}); }
  double low_v() const { return std::min({a.v, b.v, c.v}); }
  double high_v() const { return std::max({a.v, b.v, c.v}); }
};

/// A triangle crosses the middle of an even rate only at a border of an odd one, within that one's segment; in the
/// other direction it keeps to a half if that rate is even.
void expect_border_triangle(const Division& division, PatchSegments asked, Side side, std::array<double, 2> along,
                            std::array<double, 2> across) {
  const auto s = static_cast<std::size_t>(side);
  int widest = 0;  // the odd one with the widest segments
  for (const Segments border : {division.border[s], division.border[(s + 2) % 4]})
    if (!border.parts_halves()) widest = widest == 0 ? border.rate() : std::min<int>(widest, border.rate());
  ASSERT_GT(widest, 0);
  EXPECT_LE(along[1] - along[0], 1.0 / widest + 1e-12);
  const Segments across_asked = runs_along_u(side) ? asked.v : asked.u;
  EXPECT_TRUE(across_asked.rate() == 1 || across[0] == 0 || across[1] == 1);
  if (!across_asked.parts_halves()) return;
  EXPECT_TRUE(across[1] <= 0.5 || across[0] >= 0.5);
  const Segments border = division.border[across[0] == 0 ? (side == Side::v0 ? 0 : 3) : (side == Side::v0 ? 2 : 1)];
  EXPECT_FALSE(border.parts_halves());
}

/// The longest requested segment from `low` to `high`.
double longest(Segments asked, double low, double high) {
  double length = 0;
  for (int k = 0; k < asked.rate(); ++k)
    if (const double begin = asked.at(k).value(), end = asked.at(k + 1).value(); begin < high && end > low)
      length = std::max(length, end - begin);
  return length;
}

/// Checks all promises of the header for a patch without collapsed borders.
void expect_triangulation(const Division& division, PatchSegments asked) {
  const std::vector<StitchedPatchPlace> at = places(division);
  ASSERT_EQ(at.size(), division.vertex_count());
  std::vector<std::uint32_t> indices(3 * division.triangle_count() + 1, 77777);
  ASSERT_EQ(division.write_triangles(0, indices.data()), indices.data() + 3 * division.triangle_count());
  EXPECT_EQ(indices.back(), 77777u);
  double area = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < division.triangle_count(); ++t) {
    const std::uint32_t* corner = &indices[3 * t];
    for (int k = 0; k < 3; ++k) {
      ASSERT_LT(corner[k], at.size());
      ++edges[{corner[k], corner[(k + 1) % 3]}];
    }
    const Corners place{at[corner[0]], at[corner[1]], at[corner[2]]};
    ASSERT_GT(place.twice_area(), 0);
    area += place.twice_area() / 2;
    EXPECT_LE(place.high_u() - place.low_u(), longest(asked.u, place.low_u(), place.high_u()) + 1e-12);
    EXPECT_LE(place.high_v() - place.low_v(), longest(asked.v, place.low_v(), place.high_v()) + 1e-12);
    const auto straddles = [](double low, double high) { return low < 0.5 && high > 0.5; };
    if (asked.u.parts_halves() && straddles(place.low_u(), place.high_u()))
      expect_border_triangle(division, asked, Side::v0, {place.low_u(), place.high_u()},
                             {place.low_v(), place.high_v()});
    if (asked.v.parts_halves() && straddles(place.low_v(), place.high_v()))
      expect_border_triangle(division, asked, Side::u1, {place.low_v(), place.high_v()},
                             {place.low_u(), place.high_u()});
  }
  EXPECT_NEAR(area, 1, 1e-9);
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    open += !edges.contains({edge.second, edge.first});
  }
  EXPECT_EQ(open, division.ring_count());
  for (std::size_t k = 0; k < division.ring_count(); ++k) {
    const auto from = static_cast<std::uint32_t>(division.inner_count() + k);
    const auto to = static_cast<std::uint32_t>(division.inner_count() + (k + 1) % division.ring_count());
    EXPECT_TRUE(edges.contains({from, to}));
  }
}

TEST(StitchedPatch, TrianglesCoverTheSquareWithinTheCellsOfTheRates) {
  std::mt19937 random(1);
  const PatchShape plain{3, 3, {}, false};
  for (int repeat = 0; repeat < 3000 && !testing::Test::HasFailure(); ++repeat) {
    const int most = repeat % 3 == 0 ? 3 : repeat % 3 == 1 ? 9 : 40;
    std::uniform_int_distribution<int> rate(1, most), more(0, repeat % 2 ? most : 1);
    const Rates asked{rate(random), rate(random)};
    const auto border = [&](int n) {
      const int e = n + more(random);
      return n % 2 == 0 && repeat % 5 != 0 ? e + e % 2 : e;
    };
    const std::array<Segments, 4> borders{border(asked.u), border(asked.v), border(asked.u), border(asked.v)};
    SCOPED_TRACE(testing::Message() << asked.u << " x " << asked.v << ", borders " << borders[0].rate() << " "
                                    << borders[1].rate() << " " << borders[2].rate() << " " << borders[3].rate());
    expect_triangulation(Division::of(plain, asked, borders), asked);
  }
}

TEST(StitchedPatch, HalvesMayHaveSegmentsOfTheirOwn) {
  std::mt19937 random(2);
  const PatchShape plain{3, 3, {}, false};
  for (int repeat = 0; repeat < 3000 && !testing::Test::HasFailure(); ++repeat) {
    std::uniform_int_distribution<int> half(1, repeat % 3 == 0 ? 2 : repeat % 3 == 1 ? 5 : 20), more(0, repeat % 4);
    const PatchSegments asked{Segments::halves(half(random), half(random)),
                              Segments::halves(half(random), half(random))};
    const auto border = [&](Segments own) {
      return Segments::halves(own.lower_rate() / 2 + more(random), own.upper_rate() / 2 + more(random));
    };
    const std::array<Segments, 4> borders{border(asked.u), border(asked.v), border(asked.u), border(asked.v)};
    SCOPED_TRACE(testing::Message() << asked.u.lower_rate() << " + " << asked.u.upper_rate() << " x "
                                    << asked.v.lower_rate() << " + " << asked.v.upper_rate());
    expect_triangulation(Division::of(plain, asked, borders), asked);
  }
  // Beside a neighbour's border of this kind a patch may have odd rates.
  for (const Rates asked : {Rates{1, 1}, Rates{1, 3}, Rates{3, 1}, Rates{5, 3}, Rates{1, 2}}) {
    const Segments u = Segments::halves((asked.u + 1) / 2 + 1, (asked.u + 1) / 2);
    const Segments v = Segments::halves((asked.v + 1) / 2, (asked.v + 1) / 2 + 2);
    for (const std::array<Segments, 4>& borders : {std::array<Segments, 4>{u, asked.v, asked.u, asked.v},
                                                   {asked.u, v, asked.u, v},
                                                   {u, v, u.reversed(), v.reversed()}})
      expect_triangulation(Division::of(plain, asked, borders), asked);
  }
}

TEST(StitchedPatch, SegmentsBeginAtTheSameBitsEitherWay) {
  for (int lower = 1; lower < 40; ++lower)
    for (int upper = 1; upper < 40; ++upper) {
      const Segments along = Segments::halves(lower, upper), back = along.reversed();
      EXPECT_EQ(along.rate(), lower + upper);
      EXPECT_EQ(back.reversed(), along);
      EXPECT_EQ(along.at(lower).value(), 0.5);
      EXPECT_EQ(along.at(along.rate()).value(), 1);
      for (int k = 0; k <= along.rate(); ++k) {
        EXPECT_EQ(along.at(k).value(), back.at(along.rate() - k).rest());
        EXPECT_EQ(along.at(k).rest(), back.at(along.rate() - k).value());
        EXPECT_TRUE(k == 0 || along.at(k).value() > along.at(k - 1).value());
      }
    }
}

TEST(StitchedPatch, FewSegmentsNeedNoInnerPoints) {
  const PatchShape plain{3, 3, {}, false};
  for (const std::array<Segments, 4>& borders :
       {std::array<Segments, 4>{2, 1, 1, 1}, {3, 2, 2, 3}, {1, 4, 3, 5}, {2, 7, 3, 6}}) {
    const Division division = Division::of(plain, {1, 1}, borders);
    EXPECT_EQ(division.inner_count(), 0u);
    EXPECT_EQ(division.triangle_count(), division.ring_count() - 2);
  }
  EXPECT_EQ(Division::of(plain, {1, 1}, {4, 4, 1, 1}).inner_count(), 1u);
  EXPECT_EQ(Division::of(plain, {1, 1}, {1, 4, 4, 1}).inner_count(), 1u);
  EXPECT_EQ(Division::of(plain, {1, 6}, {4, 6, 1, 6}).inner_count(), 5u);
}

TEST(StitchedPatch, EqualRatesGiveTheCellsOfTheGrid) {
  for (const Rates rates : {Rates{1, 1}, Rates{1, 5}, Rates{6, 1}, Rates{2, 2}, Rates{4, 7}}) {
    const Division division = Division::of({3, 3, {}, false}, rates, {rates.u, rates.v, rates.u, rates.v});
    EXPECT_EQ(division.triangle_count(), static_cast<std::size_t>(2 * rates.u * rates.v));
    EXPECT_EQ(division.vertex_count(), rates.vertices());
  }
}

TEST(StitchedPatch, NoTriangleStandsOnACollapsedBorder) {
  for (const Side side : all_sides)
    for (const Rates asked : {Rates{1, 1}, Rates{1, 6}, Rates{5, 1}, Rates{4, 6}}) {
      PatchShape shape{3, 3, {}, false};
      shape.collapsed.add(side);
      const Division division = Division::of(shape, asked, {asked.u + 2, asked.v, asked.u, asked.v + 2});
      const std::vector<StitchedPatchPlace> at = places(division);
      std::vector<std::uint32_t> indices(3 * division.triangle_count());
      ASSERT_EQ(division.write_triangles(0, indices.data()), indices.data() + indices.size());
      const auto on_side = [&](std::uint32_t k) {
        const StitchedPatchPlace p = at[k];
        return side == Side::v0 ? p.v == 0 : side == Side::v1 ? p.v == 1 : side == Side::u0 ? p.u == 0 : p.u == 1;
      };
      const Division whole = Division::of({3, 3, {}, false}, asked, division.border);
      EXPECT_GE(division.triangle_count() + division.border[static_cast<std::size_t>(side)].rate(),
                whole.triangle_count());
      for (std::size_t t = 0; t < indices.size(); t += 3)
        EXPECT_LT(on_side(indices[t]) + on_side(indices[t + 1]) + on_side(indices[t + 2]), 2);
    }
}

TEST(StitchedPatch, ACurveHasNoTriangles) {
  PatchShape shape{3, 3, {}, true};
  const Division division = Division::of(shape, {4, 4}, {4, 4, 4, 4});
  EXPECT_EQ(division.triangle_count(), 0u);
  EXPECT_EQ(division.vertex_count(), 0u);
  std::uint32_t untouched = 5;
  EXPECT_EQ(division.write_triangles(0, &untouched), &untouched);
  EXPECT_EQ(untouched, 5u);
}

}}  // namespace tessera::test
