#include "ray/distinct_roots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace tessera {
namespace {

bool near(double a, double b, double radius) { return std::abs(a - b) <= radius + 1e-12; }

/// Whether a root reaches an edge of its patch (an index into all_edges), and where along it.
bool on_edge(const LeafRoot& root, int edge, double& along) {
  const double across = edge < 2 ? root.u : root.v;
  along = edge < 2 ? root.v : root.u;
  return near(across, edge % 2, edge < 2 ? root.radius_u : root.radius_v);
}

class Sameness {
 public:
  Sameness(const SetView& set, const Adjacency& adjacency) : set_(set), adjacency_(adjacency) {}

  bool operator()(const LeafRoot& a, const LeafRoot& b) const {
    return (a.patch == b.patch && on_one_patch(a, b)) || across_a_border(a, b);
  }

 private:
  bool on_one_patch(const LeafRoot& a, const LeafRoot& b) const {
    if (same_place(a, b)) return true;
    // All of a collapsed edge is one point.
    const EdgeMask collapsed = set_.collapsed_edges(a.patch);
    for (int edge = 0; edge < 4; ++edge) {
      double along = 0;
      if (collapsed.has(all_edges[static_cast<std::size_t>(edge)]) && on_edge(a, edge, along) &&
          on_edge(b, edge, along))
        return true;
    }
    return false;
  }

  bool across_a_border(const LeafRoot& a, const LeafRoot& b) const {
    for (int edge = 0; edge < 4; ++edge) {
      const EdgeLink& link = adjacency_.across(a.patch, edge);
      double along_a = 0, along_b = 0;
      if (!link.exists() || link.patch != b.patch || !on_edge(a, edge, along_a) || !on_edge(b, link.edge, along_b))
        continue;
      const double reach_a = edge < 2 ? a.radius_v : a.radius_u, reach_b = link.edge < 2 ? b.radius_v : b.radius_u;
      if (at_pole(a, edge) && at_pole(b, link.edge)) return true;
      if (near(along_a, link.reversed ? 1 - along_b : along_b, reach_a + reach_b)) return true;
    }
    return false;
  }

  /// Whether the root is at the end of that edge where a collapsed edge begins.
  bool at_pole(const LeafRoot& root, int edge) const {
    const EdgeMask collapsed = set_.collapsed_edges(root.patch);
    for (int other = edge < 2 ? 2 : 0; other < (edge < 2 ? 4 : 2); ++other) {
      double along = 0;
      if (collapsed.has(all_edges[static_cast<std::size_t>(other)]) && on_edge(root, other, along)) return true;
    }
    return false;
  }

  const SetView& set_;
  const Adjacency& adjacency_;
};

}  // namespace

void keep_distinct(const SetView& set, const Adjacency& adjacency, std::vector<LeafRoot>& roots) {
  if (roots.size() < 2) return;
  std::sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) {
    return std::tie(a.s, a.patch, a.u, a.v) < std::tie(b.s, b.patch, b.u, b.v);
  });
  const Sameness same(set, adjacency);
  // Union of sets: leader[k] is the first root that k is the same as.
  std::vector<std::size_t> leader(roots.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto root_of = [&](std::size_t k) {
    while (leader[k] != k) k = leader[k] = leader[leader[k]];
    return k;
  };
  for (std::size_t b = 1; b < roots.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const std::size_t x = root_of(a), y = root_of(b);
      if (x != y && same(roots[a], roots[b])) leader[std::max(x, y)] = std::min(x, y);
    }
  }
  for (std::size_t k = 0; k < roots.size(); ++k) {
    LeafRoot& first = roots[root_of(k)];
    const LeafRoot& here = roots[k];
    const double from = std::min(first.from, here.from);
    if (std::tuple(!here.certified, here.residual) < std::tuple(!first.certified, first.residual)) first = here;
    first.from = from;
    if (from < first.s) first.certified = false;  // the part may hold a root that comes before
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    if (leader[k] == k) roots[kept++] = roots[k];
  }
  roots.resize(kept);
  std::stable_sort(roots.begin(), roots.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
}

}  // namespace tessera
