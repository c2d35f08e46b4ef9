#include "ray/tree/box_nodes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "parallel/parallel_for.h"
#include "ray/tree/box_padding.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using kernel::TreeNode;

constexpr std::size_t max_bins = 16;
constexpr int levels_by_area = 40;  // below, parts are halved: 2^31 boxes have 16 more levels
constexpr std::size_t min_task = 1024, max_tasks = 64;
constexpr float farthest_side = 4;
constexpr float nothing = std::numeric_limits<float>::infinity();
static_assert(levels_by_area + 17 <= TreeNode::max_levels);

/// A box in float; empty at first. Its sides are stored so that the larger number is always the outer one.
struct FloatBox {
  std::array<float, 8> out{-nothing, -nothing, -nothing, -nothing, -nothing, -nothing, -nothing, -nothing};

  /// Pads a box. One that is empty or has NaN becomes empty.
  static FloatBox padded(const Box3& box) {
    FloatBox made;
    const Vec3 &l = box.lower, &u = box.upper;
    if (!(l.x <= u.x && l.y <= u.y && l.z <= u.z)) return made;
    const auto narrow = [](double x) {
      return static_cast<float>(std::clamp(x, -double{farthest_side}, double{farthest_side})) + box_pad;
    };
    made.out = {narrow(-l.x), narrow(-l.y), narrow(-l.z), 0, narrow(u.x), narrow(u.y), narrow(u.z), 0};
    return made;
  }
  float lower(std::size_t axis) const { return -out[axis]; }
  float upper(std::size_t axis) const { return out[4 + axis]; }
  void set(std::size_t axis, float low, float high) { out[axis] = -low, out[4 + axis] = high; }
  bool empty() const { return !(lower(0) <= upper(0)); }
  void extend(const FloatBox& other) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = out[k] > other.out[k] ? out[k] : other.out[k];
  }
  /// Half the surface; 0 if empty.
  float area() const {
    if (empty()) return 0;
    const float x = upper(0) - lower(0), y = upper(1) - lower(1), z = upper(2) - lower(2);
    return x * y + y * z + z * x;
  }
  /// Twice the middle.
  float middle(std::size_t axis) const { return lower(axis) + upper(axis); }
};

struct Item {
  FloatBox box;
  std::uint32_t index;
};

struct Part {
  std::span<Item> items;
  FloatBox box;
  /// How much a division pays: by area and number, or by number alone. Negative for a single box.
  float cost(bool by_number) const {
    const auto number = static_cast<float>(items.size());
    return items.size() < 2 ? -1 : by_number ? number : box.area() * number;
  }
};

Part part_of(std::span<Item> items) {
  Part part{items, {}};
  for (const Item& item : items) part.box.extend(item.box);
  return part;
}

/// The bins of the middles of boxes along an axis.
struct Bins {
  std::size_t used = 0;      ///< number of bins
  float low = 0, scale = 0;  ///< scale 0: the middles are one
  FloatBox box[max_bins];
  std::uint32_t count[max_bins];

  std::size_t bin_of(float middle) const {
    return static_cast<std::size_t>(std::clamp((middle - low) * scale, 0.0f, static_cast<float>(used - 1)));
  }
};

struct Cut {
  float cost = nothing;
  std::size_t axis = 0, bin = 0;  ///< the first bin of the second part
};

/// Few boxes get few bins.
void set_bins(std::span<const Item> items, std::array<Bins, 3>& bins) {
  std::array<float, 3> low{nothing, nothing, nothing}, high{-nothing, -nothing, -nothing};
  for (const Item& item : items) {
    for (std::size_t c = 0; c < 3; ++c)
      low[c] = std::min(low[c], item.box.middle(c)), high[c] = std::max(high[c], item.box.middle(c));
  }
  const std::size_t used = std::min(max_bins, 4 + items.size() / 4);
  for (std::size_t c = 0; c < 3; ++c) {
    constexpr float least = 1e-20f;
    bins[c].used = used, bins[c].low = low[c];
    bins[c].scale = high[c] - low[c] > least ? static_cast<float>(used) / (high[c] - low[c]) : 0;
    std::fill_n(bins[c].box, used, FloatBox());
    std::fill_n(bins[c].count, used, 0);
  }
  for (const Item& item : items) {
    for (Bins& along : bins) {
      const std::size_t bin = along.bin_of(item.box.middle(static_cast<std::size_t>(&along - bins.data())));
      along.box[bin].extend(item.box);
      ++along.count[bin];
    }
  }
}

/// Lowers the cost of a cut to the least one along an axis.
void find_cut(const Bins& bins, std::size_t axis, Cut& best) {
  if (bins.scale == 0) return;
  float behind[max_bins];  // cost of the bins from each on
  FloatBox box;
  std::size_t count = 0;
  for (std::size_t k = bins.used; k-- > 1;) {
    box.extend(bins.box[k]);
    count += bins.count[k];
    behind[k] = box.area() * static_cast<float>(count);
  }
  box = {}, count = 0;
  for (std::size_t k = 1; k < bins.used; ++k) {
    box.extend(bins.box[k - 1]);
    count += bins.count[k - 1];
    const float cost = box.area() * static_cast<float>(count) + behind[k];
    if (cost < best.cost) best = {cost, axis, k};
  }
}

/// Divides at least two boxes into two parts that are not empty. `halve`: by their number.
std::pair<Part, Part> divide(std::span<Item> items, bool halve) {
  Cut cut;
  std::size_t first = 0;
  if (!halve) {
    std::array<Bins, 3> bins;
    set_bins(items, bins);
    for (std::size_t c = 0; c < 3; ++c) find_cut(bins[c], c, cut);
    if (cut.cost < nothing) {
      const Bins& along = bins[cut.axis];
      const auto middle = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return along.bin_of(item.box.middle(cut.axis)) < cut.bin;
      });
      first = static_cast<std::size_t>(middle - items.begin());
    }
  }
  if (first == 0 || first == items.size()) first = items.size() / 2;
  return {part_of(items.first(first)), part_of(items.subspan(first))};
}

void set_box(TreeNode& node, std::size_t lane, const FloatBox& box) {
  for (std::size_t c = 0; c < 3; ++c) node.side[0][c][lane] = box.lower(c), node.side[1][c][lane] = box.upper(c);
}

FloatBox box_of_node(const TreeNode& node) {
  FloatBox box;
  for (std::size_t lane = 0; lane < TreeNode::size; ++lane) {
    FloatBox child;
    for (std::size_t c = 0; c < 3; ++c) child.set(c, node.side[0][c][lane], node.side[1][c][lane]);
    box.extend(child);
  }
  return box;
}

/// A subtree that is built later, for a place in a node.
struct Task {
  Part part;
  int level;
  std::size_t node, lane;
};

/// Makes nodes of boxes, parents before their children.
class NodeMaker {
 public:
  /// Parts of at most `task_size` boxes become tasks; 0: none do.
  explicit NodeMaker(std::size_t task_size) : task_size_(task_size) {}

  /// Returns the index of the node.
  std::uint32_t add(std::span<Item> items, int level) {
    std::array<Part, TreeNode::size> parts;
    std::size_t count = items.size() <= parts.size() ? items.size() : 1;
    if (count > 1) {
      for (std::size_t lane = 0; lane < count; ++lane) parts[lane] = part_of(items.subspan(lane, 1));
    } else {
      parts[0] = part_of(items);
    }
    const bool halve = level >= levels_by_area;
    for (; count < parts.size(); ++count) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                           [&](const Part& a, const Part& b) { return a.cost(halve) < b.cost(halve); });
      if (largest->items.size() < 2) break;
      std::tie(*largest, parts[count]) = divide(largest->items, halve);
    }
    const std::size_t place = nodes.size();
    TreeNode& node = nodes.emplace_back();
    for (std::size_t lane = 0; lane < parts.size(); ++lane)
      set_box(node, lane, parts[lane].box), node.child[lane] = TreeNode::none;
    for (std::size_t lane = 0; lane < count; ++lane) add_child(parts[lane], level + 1, place, lane);
    return static_cast<std::uint32_t>(place);
  }

  std::vector<TreeNode> nodes;
  std::vector<Task> tasks;

 private:
  void add_child(const Part& part, int level, std::size_t place, std::size_t lane) {
    if (part.items.size() == 1) {
      nodes[place].child[lane] = TreeNode::leaf_bit | part.items[0].index;
    } else if (part.items.size() <= task_size_) {
      tasks.push_back({part, level, place, lane});
    } else {
      const std::uint32_t child = add(part.items, level);
      nodes[place].child[lane] = child;
    }
  }

  std::size_t task_size_;
};

/// Appends the nodes of a task's subtree.
void append(const std::vector<TreeNode>& subtree, const Task& task, std::vector<TreeNode>& nodes) {
  const auto first = static_cast<std::uint32_t>(nodes.size());
  nodes[task.node].child[task.lane] = first;
  for (TreeNode node : subtree) {
    for (std::uint32_t& child : node.child)
      if ((child & TreeNode::leaf_bit) == 0) child += first;
    nodes.push_back(node);
  }
}

/// Halving counts by the number of boxes, so that levels have a limit even if all boxes are one.
Status build_nodes(std::span<Item> items, const Execution& execution, std::vector<TreeNode>& nodes) {
  NodeMaker top(std::max(min_task, items.size() / max_tasks));
  top.add(items, 0);
  std::vector<std::vector<TreeNode>> subtrees(top.tasks.size());
  Status status = parallel_for(top.tasks.size(), 1, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      NodeMaker maker(0);
      maker.add(top.tasks[k].part.items, top.tasks[k].level);
      subtrees[k] = std::move(maker.nodes);
    }
  });
  if (!status.ok()) return status;
  std::size_t count = top.nodes.size();
  for (const std::vector<TreeNode>& subtree : subtrees) count += subtree.size();
  top.nodes.reserve(count);
  for (std::size_t k = 0; k < subtrees.size(); ++k) {
    append(subtrees[k], top.tasks[k], top.nodes);
    subtrees[k] = {};
  }
  nodes = std::move(top.nodes);
  return {};
}

}  // namespace

Status BoxNodes::build(std::size_t count, BoxOf box_of, const Execution& execution) {
  nodes_ = {};
  if (count > max_boxes)
    return Status(StatusCode::unsupported, "more than the 2^31 - 2 boxes of a tree without Embree");
  std::vector<Item> items;
  items.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const FloatBox box = FloatBox::padded(box_of(k));
    if (!box.empty()) items.push_back({box, static_cast<std::uint32_t>(k)});
  }
  return items.empty() ? Status() : build_nodes(items, execution, nodes_);
}

void BoxNodes::refit(BoxOf box_of) {
  for (std::size_t place = nodes_.size(); place-- > 0;) {
    TreeNode& node = nodes_[place];
    for (std::size_t lane = 0; lane < TreeNode::size && node.child[lane] != TreeNode::none; ++lane) {
      const std::uint32_t child = node.child[lane];
      const bool is_leaf = (child & TreeNode::leaf_bit) != 0;
      set_box(node, lane, is_leaf ? FloatBox::padded(box_of(child & ~TreeNode::leaf_bit)) : box_of_node(nodes_[child]));
    }
  }
}

}}  // namespace tessera::abi_0_1
