// The library's own tree of boxes: walks find every box that a ray meets, whatever the boxes are.

#include "ray/tree/box_nodes.h"

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <thread>

#include "kernel/table/kernel_table.h"
#include "ray/tree/tree_walk.h"
#include "ray_support.h"

namespace tessera::test { namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The levels below a node.
int levels_of(const kernel::TreeNode* nodes, std::uint32_t place) {
  int most = 0;
  for (const std::uint32_t child : nodes[place].child) {
    if ((child & kernel::TreeNode::leaf_bit) != 0) continue;
    EXPECT_GT(child, place);
    most = std::max(most, levels_of(nodes, child));
  }
  return most + 1;
}

BoxNodes tree_over(const std::vector<Box3>& boxes) {
  BoxNodes tree;
  const Status status = tree.build(boxes.size(), [&](std::size_t k) { return boxes[k]; }, {});
  EXPECT_TRUE(status.ok()) << status.message();
  if (!tree.empty()) {
    EXPECT_LE(levels_of(tree.nodes(), 0), kernel::TreeNode::max_levels);
  }
  return tree;
}

RayLine line_through(const Vec3& start, const Vec3& direction) {
  RayLine line;
  line.start = start, line.direction = normalized(direction);
  line.enter = -3, line.leave = 3, line.empty = false;
  return line;
}

std::vector<RayLine> random_lines(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<RayLine> lines;
  for (std::size_t k = 0; k < count; ++k)
    lines.push_back(line_through(0.8 * uniform_vector(random, -1, 1), random_direction(random)));
  for (int axis = 0; axis < 3; ++axis)
    lines.push_back(line_through({}, {double(axis == 0), double(axis == 1), double(axis == 2)}));
  return lines;
}

/// Whether the line passes through the box, in double.
bool passes(const RayLine& line, const Box3& box) {
  double enter = line.enter, leave = line.leave;
  for (int c = 0; c < 3; ++c) {
    const auto of = [&](const Vec3& v) { return c == 0 ? v.x : c == 1 ? v.y : v.z; };
    const double d = of(line.direction), low = of(box.lower) - of(line.start), high = of(box.upper) - of(line.start);
    if (d == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / d, high / d)), leave = std::min(leave, std::max(low / d, high / d));
  }
  return enter <= leave;
}

/// The leaves that a line visits, each once.
std::set<std::uint32_t> visited(const BoxNodes& tree, const RayLine& line, const kernel::RayKernels& kernels) {
  kernel::TreeWalk walk;
  start_walk(line, tree, walk);
  std::set<std::uint32_t> leaves;
  for (;;) {
    const std::uint32_t leaf = kernels.next_leaf(tree.nodes(), walk);
    if (leaf == kernel::TreeNode::none) return leaves;
    EXPECT_TRUE(leaves.insert(leaf).second);
  }
}

/// The boxes that a packet of lines visits, line by line.
std::vector<std::set<std::uint32_t>> visited_together(const BoxNodes& tree, std::span<const RayLine> lines,
                                                      const kernel::RayPacketKernels& kernels) {
  kernel::TreePacket walk;
  start_walk(
      lines.size(), [&](std::size_t k) -> const RayLine& { return lines[k]; }, tree, walk);
  std::vector<std::set<std::uint32_t>> leaves(lines.size());
  std::uint32_t leaf = 0;
  while (const unsigned lanes = kernels.next_packet_leaf(tree.nodes(), walk, leaf)) {
    EXPECT_EQ(lanes >> lines.size(), 0u);
    for (std::size_t k = 0; k < lines.size(); ++k)
      if ((lanes >> k & 1u) != 0) {
        EXPECT_TRUE(leaves[k].insert(leaf).second);
      }
  }
  return leaves;
}

/// Expects that walks visit all boxes that lines pass through, and few others.
void expect_found(const std::vector<Box3>& boxes, const BoxNodes& tree, double others = 0.02) {
  const kernel::RayKernels& kernels = ray_kernels(value_of(default_isa()));
  const std::vector<RayLine> lines = random_lines(45, 3);
  std::size_t in_vain = 0, met = 0;
  for (std::size_t first = 0; first < lines.size(); first += 16) {
    const std::span<const RayLine> some =
        std::span(lines).subspan(first, std::min<std::size_t>(16, lines.size() - first));
    std::vector<std::set<std::uint32_t>> together;
    if (kernels.packets != nullptr) together = visited_together(tree, some, *kernels.packets);
    for (std::size_t k = 0; k < some.size(); ++k) {
      const std::set<std::uint32_t> alone = visited(tree, some[k], kernels);
      for (std::uint32_t box = 0; box < boxes.size(); ++box) {
        const bool is_empty = !(boxes[box].lower.x <= boxes[box].upper.x && boxes[box].lower.y <= boxes[box].upper.y &&
                                boxes[box].lower.z <= boxes[box].upper.z);
        if (is_empty) {
          EXPECT_EQ(alone.count(box) + (together.empty() ? 0 : together[k].count(box)), 0u) << box;
        }
        if (is_empty || !passes(some[k], boxes[box])) continue;
        ++met;
        EXPECT_EQ(alone.count(box), 1u) << box;
        if (!together.empty()) {
          EXPECT_EQ(together[k].count(box), 1u) << box;
        }
      }
      in_vain += alone.size();
    }
  }
  EXPECT_LE(static_cast<double>(in_vain - met), others * static_cast<double>(met) + 20);
}

std::vector<Box3> random_boxes(std::size_t count, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box3> boxes;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 at = 0.9 * uniform_vector(random, -1, 1), half = size * uniform_vector(random, 0, 1);
    boxes.push_back({at - half, at + half});
  }
  return boxes;
}

TEST(BoxNodes, WalksFindAllBoxes) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 4u, 5u, 16u, 17u, 1000u, 5000u}) {
    const std::vector<Box3> boxes = random_boxes(count, 0.1, count);
    const BoxNodes tree = tree_over(boxes);
    EXPECT_EQ(tree.empty(), count == 0);
    expect_found(boxes, tree);
  }
}

TEST(BoxNodes, AllAlikeOrWithoutExtent) {
  for (const Box3& box : {Box3{{0, 0, 0}, {0, 0, 0}}, Box3{{-1, -1, -1}, {1, 1, 1}}, Box3{{-1, 0, 0}, {1, 0, 0}}}) {
    const std::vector<Box3> boxes(3000, box);
    expect_found(boxes, tree_over(boxes), 1);
  }
}

// By area alone such a tree is as deep as there are boxes.
TEST(BoxNodes, OneWithinAnother) {
  std::vector<Box3> boxes;
  for (int k = 0; k < 3000; ++k) {
    const double size = std::exp2(-k / 20.0);
    boxes.push_back({{-0.5 * size, -0.5 * size, -0.5 * size}, {size, size, size}});
    boxes.push_back({{size, size, size}, {size * 1.01, size * 1.01, size * 1.01}});
  }
  expect_found(boxes, tree_over(boxes), 1);
}

TEST(BoxNodes, NoNumberIsTooBadForIt) {
  std::vector<Box3> boxes = random_boxes(200, 0.1, 8);
  const double bad[] = {nan, infinite, -infinite, 1e308, -1e308, 5e-324, 0};
  Random random(4);
  for (int k = 0; k < 400; ++k) {
    Box3 box;
    for (double* side : {&box.lower.x, &box.lower.y, &box.lower.z, &box.upper.x, &box.upper.y, &box.upper.z})
      *side = random() % 3 == 0 ? bad[random() % 7] : uniform(random, -1, 1);
    boxes.push_back(box);
  }
  boxes.push_back({});
  boxes.push_back({{-infinite, -infinite, -infinite}, {infinite, infinite, infinite}});
  expect_found(boxes, tree_over(boxes), 0.05);
  EXPECT_TRUE(tree_over(std::vector<Box3>(9)).empty());
  EXPECT_TRUE(tree_over({Box3{{nan, 0, 0}, {1, 1, 1}}}).empty());
}

TEST(BoxNodes, FollowBoxesThatMove) {
  std::vector<Box3> boxes = random_boxes(3000, 0.05, 2);
  BoxNodes tree = tree_over(boxes);
  boxes = random_boxes(3000, 0.05, 77);
  boxes[5] = {};
  tree.refit([&](std::size_t k) { return boxes[k]; });
  expect_found(boxes, tree);
}

TEST(BoxNodes, ManyAreBuiltWithAnyNumberOfThreads) {
  const std::vector<Box3> boxes = random_boxes(70000, 0.004, 21);
  const BoxNodes tree = tree_over(boxes);
  expect_found(boxes, tree);
  EXPECT_LT(tree.memory_bytes(), 80 * boxes.size());
  std::atomic<bool> cancel = true;
  BoxNodes other;
  const Status status = other.build(boxes.size(), [&](std::size_t k) { return boxes[k]; }, {.cancel = &cancel});
  EXPECT_EQ(status.code(), StatusCode::cancelled);
  EXPECT_TRUE(other.empty());
}

}}  // namespace tessera::test
