#include "ray/border/distinct_roots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "ray/border/root_fan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class Sameness {
 public:
  Sameness(const SetView& set, const Adjacency& adjacency) : set_(set), adjacency_(adjacency) {}

  bool operator()(const LeafRoot& a, const LeafRoot& b) const {
    return (a.patch == b.patch && on_one_patch(a, b)) || across_a_border(a, b) || at_a_vertex(a, b);
  }
  const SetView& set() const { return set_; }
  const Adjacency& adjacency() const { return adjacency_; }

 private:
  bool on_one_patch(const LeafRoot& a, const LeafRoot& b) const {
    if (same_place(a, b)) return true;
    if (on_other_sides(a, b)) return false;
    // All of a collapsed edge is one point.
    const double between = apart(a, b);
    for (int edge = 0; edge < 4; ++edge) {
      if (reaches_pole(set_, a, edge, between) && reaches_pole(set_, b, edge, between)) return true;
    }
    return false;
  }

  bool across_a_border(const LeafRoot& a, const LeafRoot& b) const {
    const double between = apart(a, b);
    for (int edge = 0; edge < 4; ++edge) {
      const EdgeLink& link = adjacency_.across(a.patch, edge);
      if (!link.exists() || link.patch != b.patch || !reaches_edge(a, edge, between) ||
          !reaches_edge(b, link.edge, between) || on_other_sides(carried_over(a, edge, link), b))
        continue;
      const int end_a = pole_of_edge(set_, a, edge, between), end_b = pole_of_edge(set_, b, link.edge, between);
      if (end_a >= 0 && end_b >= 0 && end_a == (link.reversed ? 1 - end_b : end_b)) return true;
      const double along_a = along_edge(a, edge), along_b = along_edge(b, link.edge);
      const double reach = reach_along(a, edge, between) + reach_along(b, link.edge, between);
      if (std::abs(along_a - (link.reversed ? 1 - along_b : along_b)) <= reach) return true;
    }
    return false;
  }

  /// Compares roots of patches around a vertex, side by side or not: a patch between them may have no root that links
  /// them.
  bool at_a_vertex(const LeafRoot& a, const LeafRoot& b) const {
    const double between = apart(a, b);
    return reaches_vertex(a, between) && reaches_vertex(b, between) &&
           (is_seen_at(a, b, between) || is_seen_at(b, a, between));
  }
  bool is_seen_at(const LeafRoot& a, const LeafRoot& b, double between) const {
    const RootFan fan(set_, adjacency_, a, between);
    return std::any_of(fan.beyond().begin(), fan.beyond().end(),
                       [&](const LeafRoot& place) { return place.patch == b.patch && same_place(place, b); });
  }

  const SetView& set_;
  const Adjacency& adjacency_;
};

/// Classes of equal roots. Certified and uncertified ones are kept apart, so that an unproven point never joins two
/// proven ones. The leader of each class is its first root.
class RootClasses {
 public:
  RootClasses(std::span<const LeafRoot> roots, const Sameness& same)
      : roots_(roots), same_(same), leader_(roots.size()) {
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
  }

  std::size_t leader(std::size_t k) {
    while (leader_[k] != k) k = leader_[k] = leader_[leader_[k]];
    return k;
  }
  void compare(std::size_t a, std::size_t b) {
    if (roots_[a].certified != roots_[b].certified) {
      if (same_(roots_[a], roots_[b])) covered_.push_back(roots_[a].certified ? std::pair(b, a) : std::pair(a, b));
      return;
    }
    const std::size_t x = leader(a), y = leader(b);
    if (x != y && same_(roots_[a], roots_[b])) leader_[std::max(x, y)] = std::min(x, y);
  }
  /// Returns the pairs of an uncertified root and a certified one that it may stand for.
  std::span<const std::pair<std::size_t, std::size_t>> covered() const { return covered_; }

 private:
  std::span<const LeafRoot> roots_;
  const Sameness& same_;
  std::vector<std::size_t> leader_;
  std::vector<std::pair<std::size_t, std::size_t>> covered_;
};

/// The range along one parameter in which a root may equal others.
struct Interval {
  double low, high;
  std::size_t root;
};

/// Compares roots whose intervals overlap.
void sweep(std::vector<Interval>& intervals, RootClasses& classes) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return std::tie(a.low, a.root) < std::tie(b.low, b.root); });
  std::vector<Interval> open;
  for (const Interval& next : intervals) {
    std::erase_if(open, [&](const Interval& before) { return before.high < next.low; });
    // The latest first: mostly all are in one class then, and the others are skipped.
    for (std::size_t k = open.size(); k-- > 0;) classes.compare(open[k].root, next.root);
    open.push_back(next);
  }
}

/// Compares roots in sweeps over the parameters of each patch and along each border, in time that grows with the number
/// of roots and of overlaps. A surface that runs along the ray has tens of thousands of roots.
class Sweeps {
 public:
  Sweeps(std::span<const LeafRoot> roots, const Sameness& same, RootClasses& classes)
      : roots_(roots), same_(same), classes_(classes) {
    for (std::size_t k = 0; k < roots.size(); ++k) {
      of_patch_[roots[k].patch].push_back(k);
      widest_ = std::max(widest_, roots[k].residual + roots[k].noise);
    }
  }

  void run() {
    for (const auto& [patch, all] : of_patch_) {
      inside(all);
      for (int edge = 0; edge < 4; ++edge) {
        collapsed(all, edge);
        const EdgeLink& link = same_.adjacency().across(patch, edge);
        const auto other = link.exists() ? of_patch_.find(link.patch) : of_patch_.end();
        if (other != of_patch_.end()) border(all, edge, other->second, link);
      }
    }
    vertices();
  }

 private:
  using Indices = std::vector<std::size_t>;

  /// Roots at one point. They are equal by themselves, so one of each kind stands for the others.
  class Pole {
   public:
    void add(std::size_t root, std::span<const LeafRoot> roots, RootClasses& classes) {
      std::optional<std::size_t>& first = first_[roots[root].certified];
      if (!first) first = root;
      for (const std::optional<std::size_t>& other : first_) {
        if (other && *other != root) classes.compare(*other, root);
      }
    }
    void join(const Pole& beyond, RootClasses& classes) const {
      for (const std::optional<std::size_t>& a : first_) {
        for (const std::optional<std::size_t>& b : beyond.first_) {
          if (a && b) classes.compare(*a, *b);
        }
      }
    }

   private:
    std::array<std::optional<std::size_t>, 2> first_;
  };

  /// Bounds the distance across the line of a root from any that it may equal.
  double farthest(const LeafRoot& root) const { return root.residual + root.noise + widest_; }

  /// Sweeps along the parameter over which the roots lie more apart.
  void inside(const Indices& all) {
    const auto spread = [&](double LeafRoot::*place, auto reach) {
      double low = roots_[all[0]].*place, high = low, covered = 0;
      for (const std::size_t k : all) {
        low = std::min(low, roots_[k].*place), high = std::max(high, roots_[k].*place);
        covered += reach(roots_[k], farthest(roots_[k]));
      }
      return (high - low) / covered;
    };
    const bool along_u = spread(&LeafRoot::u, reach_u) > spread(&LeafRoot::v, reach_v);
    intervals_.clear();
    for (const std::size_t k : all) {
      const LeafRoot& root = roots_[k];
      add(along_u ? root.u : root.v, along_u ? reach_u(root, farthest(root)) : reach_v(root, farthest(root)), k);
    }
    sweep(intervals_, classes_);
  }

  void collapsed(const Indices& all, int edge) {
    Pole pole;
    for (const std::size_t k : all) {
      if (reaches_pole(same_.set(), roots_[k], edge, farthest(roots_[k]))) pole.add(k, roots_, classes_);
    }
  }

  /// Sweeps along a border. Roots at a pole are equal on each side of the border by themselves, so one of each kind is
  /// enough.
  void border(const Indices& here, int edge, const Indices& there, const EdgeLink& link) {
    std::array<std::array<Pole, 2>, 2> poles;
    intervals_.clear();
    for (const bool beyond : {false, true}) {
      const int own_edge = beyond ? link.edge : edge;
      const bool reversed = beyond && link.reversed;
      for (const std::size_t k : beyond ? there : here) {
        const double far = farthest(roots_[k]);
        if (!reaches_edge(roots_[k], own_edge, far)) continue;
        const double along = along_edge(roots_[k], own_edge);
        add(reversed ? 1 - along : along, reach_along(roots_[k], own_edge, far), k);
        const int end = pole_of_edge(same_.set(), roots_[k], own_edge, far);
        if (end >= 0) poles[beyond][static_cast<std::size_t>(reversed ? 1 - end : end)].add(k, roots_, classes_);
      }
    }
    for (const std::size_t end : {0, 1}) poles[0][end].join(poles[1][end], classes_);
    sweep(intervals_, classes_);
  }

  /// Compares roots at vertices, whose patches need not be side by side.
  void vertices() {
    std::map<std::uint32_t, Indices> at_vertices;
    for (const auto& [patch, all] : of_patch_) {
      for (const std::size_t k : all) {
        if (reaches_vertex(roots_[k], farthest(roots_[k]))) at_vertices[patch].push_back(k);
      }
    }
    for (const auto& [patch, all] : at_vertices) {
      for (const std::size_t k : all) {
        const RootFan fan(same_.set(), same_.adjacency(), roots_[k], farthest(roots_[k]));
        for (const LeafRoot& place : fan.beyond()) {
          const auto there = at_vertices.find(place.patch);
          if (there == at_vertices.end()) continue;
          for (const std::size_t other : there->second) classes_.compare(k, other);
        }
      }
    }
  }

  void add(double place, double reach, std::size_t root) { intervals_.push_back({place - reach, place + reach, root}); }

  std::span<const LeafRoot> roots_;
  const Sameness& same_;
  RootClasses& classes_;
  std::map<std::uint32_t, Indices> of_patch_;
  double widest_ = 0;  // largest distance of any root from the line
  std::vector<Interval> intervals_;
};

/// Returns whether `a` is kept of two equal roots: the one nearer to the line. If both are as near, mostly at the same
/// point of a border, it is the one of the patch whose coordinates come first; the patches' order in the set has no
/// effect.
bool is_better(const SetView& set, const LeafRoot& a, const LeafRoot& b) {
  if (a.residual != b.residual || a.patch == b.patch) return a.residual < b.residual;
  const auto before = [](const Vec3& p, const Vec3& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); };
  const std::span<const Vec3> p = set.patch(a.patch).points(), q = set.patch(b.patch).points();
  return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(), before);
}

/// Up to this number of roots, each is compared with each.
constexpr std::size_t few = 64;

void compare_all(std::span<const LeafRoot> roots, const Sameness& same, RootClasses& classes) {
  if (roots.size() > few) return Sweeps(roots, same, classes).run();
  for (std::size_t b = 1; b < roots.size(); ++b) {
    for (std::size_t a = b; a-- > 0;) classes.compare(a, b);
  }
}

}  // namespace

void keep_distinct(const SetView& set, const Adjacency& adjacency, std::vector<LeafRoot>& roots) {
  if (roots.size() < 2) return;
  std::sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) {
    return std::tie(a.s, a.patch, a.u, a.v) < std::tie(b.s, b.patch, b.u, b.v);
  });
  const Sameness same(set, adjacency);
  RootClasses classes(roots, same);
  compare_all(roots, same, classes);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    LeafRoot& first = roots[classes.leader(k)];
    const LeafRoot& here = roots[k];
    const double from = std::min(first.from, here.from);
    if (is_better(set, here, first)) first = here;
    first.from = from;
  }
  std::vector<bool> dropped(roots.size());
  for (const auto& [uncertified, certified] : classes.covered()) {
    const std::size_t part = classes.leader(uncertified);
    LeafRoot& root = roots[classes.leader(certified)];
    root.from = std::min(root.from, roots[part].from);
    dropped[part] = true;
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    if (classes.leader(k) != k || dropped[k]) continue;
    roots[kept] = roots[k];
    if (roots[kept].from < roots[kept].s) roots[kept].certified = false;  // the part may hold an earlier root
    ++kept;
  }
  roots.resize(kept);
  std::stable_sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
}

}}  // namespace tessera::abi_0_1
