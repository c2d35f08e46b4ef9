#include "ray/distinct_roots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

namespace tessera {
namespace {

constexpr double rounding = 1e-12;

bool near(double a, double b, double radius) { return std::abs(a - b) <= radius + rounding; }

/// Whether a root reaches an edge of its patch (an index into all_edges), and where along it.
bool on_edge(const LeafRoot& root, int edge, double& along) {
  const double across = edge < 2 ? root.u : root.v;
  along = edge < 2 ? root.v : root.u;
  return near(across, edge % 2, edge < 2 ? root.radius_u : root.radius_v);
}

double reach(const LeafRoot& root, int edge) { return edge < 2 ? root.radius_v : root.radius_u; }

class Sameness {
 public:
  Sameness(const SetView& set, const Adjacency& adjacency) : set_(set), adjacency_(adjacency) {}

  bool operator()(const LeafRoot& a, const LeafRoot& b) const {
    return (a.patch == b.patch && on_one_patch(a, b)) || across_a_border(a, b);
  }

  /// The end of that edge, 0 or 1, that is a collapsed edge which the root is on; -1 if it is on none.
  int pole(const LeafRoot& root, int edge) const {
    for (int other = edge < 2 ? 2 : 0; other < (edge < 2 ? 4 : 2); ++other) {
      if (on_collapsed(root, other)) return other % 2;
    }
    return -1;
  }
  bool on_collapsed(const LeafRoot& root, int edge) const {
    double along = 0;
    return set_.collapsed_edges(root.patch).has(all_edges[static_cast<std::size_t>(edge)]) &&
           on_edge(root, edge, along);
  }
  const EdgeLink& across(std::uint32_t patch, int edge) const { return adjacency_.across(patch, edge); }

 private:
  bool on_one_patch(const LeafRoot& a, const LeafRoot& b) const {
    if (same_place(a, b)) return true;
    // All of a collapsed edge is one point.
    for (int edge = 0; edge < 4; ++edge) {
      if (on_collapsed(a, edge) && on_collapsed(b, edge)) return true;
    }
    return false;
  }

  bool across_a_border(const LeafRoot& a, const LeafRoot& b) const {
    for (int edge = 0; edge < 4; ++edge) {
      const EdgeLink& link = across(a.patch, edge);
      double along_a = 0, along_b = 0;
      if (!link.exists() || link.patch != b.patch || !on_edge(a, edge, along_a) || !on_edge(b, link.edge, along_b))
        continue;
      const int end_a = pole(a, edge), end_b = pole(b, link.edge);
      if (end_a >= 0 && end_b >= 0 && end_a == (link.reversed ? 1 - end_b : end_b)) return true;
      if (near(along_a, link.reversed ? 1 - along_b : along_b, reach(a, edge) + reach(b, link.edge))) return true;
    }
    return false;
  }

  const SetView& set_;
  const Adjacency& adjacency_;
};

/// Roots in sets of the same ones: the leader of each is its first.
class DisjointSets {
 public:
  DisjointSets(std::span<const LeafRoot> roots, const Sameness& same)
      : roots_(roots), same_(same), leader_(roots.size()) {
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
  }

  std::size_t leader(std::size_t k) {
    while (leader_[k] != k) k = leader_[k] = leader_[leader_[k]];
    return k;
  }
  void add(std::size_t a, std::size_t b) {
    const std::size_t x = leader(a), y = leader(b);
    if (x != y && same_(roots_[a], roots_[b])) leader_[std::max(x, y)] = std::min(x, y);
  }

 private:
  std::span<const LeafRoot> roots_;
  const Sameness& same_;
  std::vector<std::size_t> leader_;
};

/// Where a root may be the same as others, along one parameter.
struct Interval {
  double low, high;
  std::size_t root;
};

/// Compares what overlaps.
void sweep(std::vector<Interval>& intervals, DisjointSets& sets) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return std::tie(a.low, a.root) < std::tie(b.low, b.root); });
  std::vector<Interval> open;
  for (const Interval& next : intervals) {
    std::erase_if(open, [&](const Interval& before) { return before.high < next.low; });
    // The latest first: mostly they are in one set then, and the others are not looked at.
    for (std::size_t k = open.size(); k-- > 0;) sets.add(open[k].root, next.root);
    open.push_back(next);
  }
}

/// Where a surface runs along the ray it has tens of thousands of roots: what can be the same is found by sweeps over the
/// parameters of each patch and along each border, in time that grows with the roots and with how many overlap.
class Sweeps {
 public:
  Sweeps(std::span<const LeafRoot> roots, const Sameness& same, DisjointSets& sets)
      : roots_(roots), same_(same), sets_(sets) {
    for (std::size_t k = 0; k < roots.size(); ++k) of_patch_[roots[k].patch].push_back(k);
  }

  void run() {
    for (const auto& [patch, all] : of_patch_) {
      inside(all);
      for (int edge = 0; edge < 4; ++edge) {
        collapsed(all, edge);
        const EdgeLink& link = same_.across(patch, edge);
        const auto other = link.exists() ? of_patch_.find(link.patch) : of_patch_.end();
        if (other != of_patch_.end()) border(all, edge, other->second, link);
      }
    }
  }

 private:
  using Indices = std::vector<std::size_t>;

  /// Along the parameter over which they lie more apart.
  void inside(const Indices& all) {
    const auto apart = [&](double LeafRoot::*place, double LeafRoot::*radius) {
      double low = roots_[all[0]].*place, high = low, covered = 0;
      for (const std::size_t k : all) {
        low = std::min(low, roots_[k].*place), high = std::max(high, roots_[k].*place);
        covered += roots_[k].*radius + rounding;
      }
      return (high - low) / covered;
    };
    const bool along_u = apart(&LeafRoot::u, &LeafRoot::radius_u) > apart(&LeafRoot::v, &LeafRoot::radius_v);
    intervals_.clear();
    for (const std::size_t k : all) {
      const LeafRoot& root = roots_[k];
      add(along_u ? root.u : root.v, along_u ? root.radius_u : root.radius_v, k);
    }
    sweep(intervals_, sets_);
  }

  void collapsed(const Indices& all, int edge) {
    std::optional<std::size_t> first;
    for (const std::size_t k : all) {
      if (!same_.on_collapsed(roots_[k], edge)) continue;
      if (!first) first = k;
      sets_.add(*first, k);
    }
  }

  /// What is at a pole is the same on each side of the border by itself, so that one of each is enough.
  void border(const Indices& here, int edge, const Indices& there, const EdgeLink& link) {
    std::array<std::array<std::optional<std::size_t>, 2>, 2> poles;
    intervals_.clear();
    for (const bool beyond : {false, true}) {
      const int own_edge = beyond ? link.edge : edge;
      const bool reversed = beyond && link.reversed;
      for (const std::size_t k : beyond ? there : here) {
        double along = 0;
        if (!on_edge(roots_[k], own_edge, along)) continue;
        add(reversed ? 1 - along : along, reach(roots_[k], own_edge), k);
        const int end = same_.pole(roots_[k], own_edge);
        if (end >= 0) poles[beyond][static_cast<std::size_t>(reversed ? 1 - end : end)] = k;
      }
    }
    for (const std::size_t end : {0, 1}) {
      if (poles[0][end] && poles[1][end]) sets_.add(*poles[0][end], *poles[1][end]);
    }
    sweep(intervals_, sets_);
  }

  void add(double place, double radius, std::size_t root) {
    intervals_.push_back({place - radius - rounding, place + radius + rounding, root});
  }

  std::span<const LeafRoot> roots_;
  const Sameness& same_;
  DisjointSets& sets_;
  std::map<std::uint32_t, Indices> of_patch_;
  std::vector<Interval> intervals_;
};

/// Up to so many each is compared with each.
constexpr std::size_t few = 64;

void unite(std::span<const LeafRoot> roots, const Sameness& same, DisjointSets& sets) {
  if (roots.size() > few) return Sweeps(roots, same, sets).run();
  for (std::size_t b = 1; b < roots.size(); ++b) {
    for (std::size_t a = b; a-- > 0;) sets.add(a, b);
  }
}

}  // namespace

void keep_distinct(const SetView& set, const Adjacency& adjacency, std::vector<LeafRoot>& roots) {
  if (roots.size() < 2) return;
  std::sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) {
    return std::tie(a.s, a.patch, a.u, a.v) < std::tie(b.s, b.patch, b.u, b.v);
  });
  const Sameness same(set, adjacency);
  DisjointSets sets(roots, same);
  unite(roots, same, sets);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    LeafRoot& first = roots[sets.leader(k)];
    const LeafRoot& here = roots[k];
    const double from = std::min(first.from, here.from);
    if (std::tuple(!here.certified, here.residual) < std::tuple(!first.certified, first.residual)) first = here;
    first.from = from;
    if (from < first.s) first.certified = false;  // the part may hold a root that comes before
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    if (sets.leader(k) == k) roots[kept++] = roots[k];
  }
  roots.resize(kept);
  std::stable_sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
}

}  // namespace tessera
