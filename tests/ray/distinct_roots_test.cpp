// Equal roots, among few and among many.

#include "ray/border/distinct_roots.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ray_support.h"

namespace tessera::test { namespace {

/// A body of four pieces from pole to pole, each with both ends collapsed.
std::vector<BezierPatch> lunes() {
  constexpr double arc = 0.5522847498307936;  // a quarter of a circle as a cubic
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, north{0, 0, 1}, south{0, 0, -1};
  std::vector<BezierPatch> patches;
  for (const auto& [from, to] : {std::pair{x, y}, {y, -x}, {-x, -y}, {-y, x}}) {
    std::vector<Vec3> points;
    for (const Vec3& ring : {from, from + arc * to, to + arc * from, to})
      for (const Vec3& p : {north, ring + north, ring + south, south}) points.push_back(p);
    patches.push_back(value_of(BezierPatch::polynomial(3, 3, points)));
  }
  return patches;
}

TEST(DistinctRoots, ThePolesOfALuneAreTwo) {
  const PatchSet set = set_of(lunes());
  const SideMask collapsed = SetView(set).collapsed_sides(0);
  ASSERT_TRUE(collapsed.has(Side::v0) && collapsed.has(Side::v1));
  const RayScene scene = value_of(RayScene::make(set));
  HitLists found;
  ASSERT_TRUE(scene.all(std::vector{ray({0, 0, 3}, {0, 0, -1})}, found).ok());
  ASSERT_EQ(found.hits.size(), 2u);
  EXPECT_NEAR(found.hits[0].t, 2, 1e-6);
  EXPECT_NEAR(found.hits[1].t, 4, 1e-6);
}

/// On the borders and corners of a body mostly, and near one another.
LeafRoot random_root(Random& random, std::size_t patches) {
  const auto one_of = [&](std::initializer_list<double> values) { return values.begin()[random() % values.size()]; };
  const auto place = [&] { return one_of({0, 1, 1e-10, 0.5, 0.5 + 1e-7, uniform(random, 0, 1)}); };
  const auto gain = [&] { return one_of({0.5, 3, 1e3, 1e6}); };
  const auto part = [&] { return one_of({0, 1e-9, 1e-6, 0.05}); };
  LeafRoot root;
  root.patch = static_cast<std::uint32_t>(random() % patches);
  root.u = place(), root.v = place();
  root.s = uniform(random, -1, 1), root.residual = uniform(random, 0, 1e-12), root.noise = 1e-14;
  root.certified = random() % 2 == 0;
  root.gain_u = gain(), root.gain_v = gain();
  if (!root.certified) root.part_u = part(), root.part_v = part();
  return root;
}

/// Many bodies that don't touch: the roots kept of each do not depend on the others. A single body has so few roots
/// that each is compared with each.
TEST(DistinctRoots, OfManyAreThoseOfFew) {
  constexpr std::size_t bodies = 40;
  std::vector<BezierPatch> body = sphere();
  for (const BezierPatch& patch : lunes()) body.push_back(patch);
  std::vector<BezierPatch> patches;
  for (std::size_t k = 0; k < bodies; ++k)
    for (const BezierPatch& patch : placed(body, 1, {4.0 * static_cast<double>(k), 0, 0})) patches.push_back(patch);
  const PatchSet set = set_of(patches);
  const SetView view(set);
  const Adjacency adjacency(view);
  ASSERT_TRUE(adjacency.across(0, 0).exists());
  Random random(7);
  for (int times = 0; times < 20; ++times) {
    std::vector<LeafRoot> all, expected;
    for (std::size_t k = 0; k < bodies; ++k) {
      std::vector<LeafRoot> few(2 + random() % 60);
      for (LeafRoot& root : few) {
        root = random_root(random, body.size());
        root.patch += static_cast<std::uint32_t>(k * body.size());
      }
      all.insert(all.end(), few.begin(), few.end());
      const std::size_t before = few.size();
      keep_distinct(view, adjacency, few);
      EXPECT_LE(few.size(), before);
      expected.insert(expected.end(), few.begin(), few.end());
    }
    std::shuffle(all.begin(), all.end(), random);
    keep_distinct(view, adjacency, all);
    std::sort(expected.begin(), expected.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
    ASSERT_EQ(all.size(), expected.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(all[k].s, expected[k].s);
      EXPECT_EQ(all[k].residual, expected[k].residual);
    }
  }
}

/// A surface that runs along the ray. Comparing each root with each would take until the time limit of the test.
TEST(DistinctRoots, ALineOfThemEndsSoon) {
  const PatchSet set = set_of(sphere());
  const SetView view(set);
  const Adjacency adjacency(view);
  constexpr std::size_t count = 300000;
  for (const bool along_u : {true, false}) {
    std::vector<LeafRoot> roots(count);
    for (std::size_t k = 0; k < count; ++k) {
      const double place = static_cast<double>(k) / count;
      roots[k].u = along_u ? place : 0.5, roots[k].v = along_u ? 0.5 : place;
      roots[k].s = place, roots[k].part_u = roots[k].part_v = 0.75 / count;
      roots[k].residual = k == count / 3 ? 0 : 1e-13;
    }
    keep_distinct(view, adjacency, roots);
    ASSERT_EQ(roots.size(), 1u);
    EXPECT_EQ(roots[0].residual, 0);
  }
}

}}  // namespace tessera::test
