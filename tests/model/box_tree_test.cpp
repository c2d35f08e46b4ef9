// Trees over boxes find what a look at every box finds.

#include "model/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tessera::test { namespace {

/// Boxes on a grid of halves, so that many touch; every seventh is empty.
std::vector<Box3> random_boxes(std::size_t count, double x, std::mt19937& random) {
  std::uniform_int_distribution<int> place(0, 40), side(0, 2);
  std::vector<Box3> boxes(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 7 == 3) continue;
    const Vec3 lower{x + 0.5 * place(random), 0.5 * place(random), 0.5 * (place(random) % 4)};
    boxes[k] = {lower, lower + 0.5 * Vec3{double(side(random)), double(side(random)), double(side(random))}};
  }
  return boxes;
}

TEST(BoxTree, TouchesWhatAnyOfItsBoxesTouches) {
  std::mt19937 random(1);
  for (const double reach : {0.0, 0.5, 3.0})
    for (const std::size_t count : {0u, 1u, 2u, 50u, 400u}) {
      const std::vector<Box3> boxes = random_boxes(count, 0, random), others = random_boxes(300, 15, random);
      const BoxTree all(boxes), towards = tree_towards(others, boxes, reach);
      for (const Box3& other : others) {
        const bool is_near = std::ranges::any_of(boxes, [&](const Box3& box) { return are_near(other, box, reach); });
        EXPECT_EQ(all.touches(other, reach), is_near);
        EXPECT_EQ(towards.touches(other, reach), is_near);
      }
    }
}

/// A strip of boxes with others at both ends: the box of these is that of the strip.
TEST(BoxTree, FindsBothEndsOfAStrip) {
  std::vector<Box3> strip, others;
  for (int k = 0; k < 1000; ++k) strip.push_back({{double(k), 0, 0}, {k + 1.0, 1, 1}});
  for (const double x : {-1.0, 1000.0, -3.0, 1002.0}) others.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  const BoxTree tree = tree_towards(others, strip, 0.25);
  for (std::size_t k = 0; k < others.size(); ++k) EXPECT_EQ(tree.touches(others[k], 0.25), k < 2);
}

}}  // namespace tessera::test
