#include "tess/edges/weld.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <optional>
#include <tuple>

#include "base/union_find.h"
#include "parallel/parallel_for.h"
#include "tess/edges/edge_places.h"
#include "tess/edges/numbered_borders.h"
#include "tess/edges/side_curve.h"
#include "tess/edges/thin_patches.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Calls visit(k) for each k below `count`, on all threads.
template <class Visit>
void for_all(std::size_t count, const Visit& visit) {
  constexpr std::size_t piece = 256;
  const Status status = parallel_for(count, piece, {}, [&](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) visit(begin);
  });
  if (!status.ok()) throw std::bad_alloc();
}

class Welder {
 public:
  Welder(const PatchSet::Impl& set, std::span<const PatchShape> shapes, const WeldRules& rules, SharedEdges& edges)
      : set_(set), shapes_(shapes), rules_(rules), edges_(edges) {}

  Weld run(std::span<const double> roundings) {
    // Where only edges with a single border are joined, most sets need no more than the list of these.
    const bool are_listed = rules_.is_relative && rules_.f64_patches.empty() && !rules_.only_borders.empty() &&
                            std::ranges::none_of(shapes_, &PatchShape::is_curve);
    if (are_listed) {
      leading_.assign(rules_.only_borders.begin(), rules_.only_borders.end());
      has_more_.assign(edges_.count(), 0);
    } else {
      find_leading();
    }
    const bool joins = rules_.reach > 0 && join_edges();
    const std::vector<std::uint32_t> points = rules_.reach > 0 ? find_points() : std::vector<std::uint32_t>();
    if (!joins && points.empty() && rules_.f64_patches.empty()) return {};
    if (are_listed) find_leading();
    if (joins) choose_givers();
    make_poles(points);
    weld_.shapes.assign(shapes_.begin(), shapes_.end());
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (is_pole_[canonical(edge)]) weld_.shapes[patch_of(border)].collapsed.add(side_of(border));
    });
    UnionFind corners(4 * set_.patches.size());
    join_corners(corners);
    list_copies(corners);
    weld_.displacements.assign(set_.patches.size(), 0);
    measure_displacements(
        set_, weld_, roundings, [](std::size_t) { return true; }, weld_.displacements);
    renumber();
    return std::move(weld_);
  }

 private:
  /// Finds the leading border of each edge, and which edges have more than one.
  void find_leading() {
    leading_.assign(edges_.count(), no_id);
    has_more_.assign(edges_.count(), 0);
    std::uint32_t* const leading = leading_.data();
    std::uint8_t* const has_more = has_more_.data();
    for_borders([=](std::uint32_t border, std::uint32_t edge) {
      has_more[edge] = leading[edge] != no_id;
      leading[edge] = std::min(leading[edge], border);
    });
    if (rules_.f64_patches.empty()) return;
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (is_f64(border) && leads(border, leading_[edge])) leading_[edge] = border;
    });
  }

  SideCurve curve(std::uint32_t border) const { return curve_of(set_, border); }
  std::uint32_t edge_of_border(std::uint32_t border) const { return edges_.edge(patch_of(border), side_of(border)); }
  /// Whether the vertices of a border or corner come from double control points.
  bool is_f64(std::uint32_t border) const {
    return !rules_.f64_patches.empty() && rules_.f64_patches[patch_of(border)];
  }
  /// Whether a border rather than another gives its points to both, in any order of the patches.
  bool leads(std::uint32_t border, std::uint32_t other) const {
    return is_f64(border) == is_f64(other) ? comes_before(curve(border), curve(other)) : is_f64(border);
  }

  /// Calls visit(border, edge) for borders of patches with an area.
  template <class Visit>
  void for_borders(Visit visit) const {
    const std::uint32_t* edges = edges_.of_borders().data();
    for (std::uint32_t patch = 0; patch < shapes_.size(); ++patch, edges += 4)
      for (std::uint32_t side = 0; side < 4 && !shapes_[patch].is_curve; ++side)
        if (edges[side] != no_id) visit(4 * patch + side, edges[side]);
  }

  /// The nearest edge to one with a single border.
  struct Nearest {
    std::uint32_t edge = no_id, other = no_id;
    bool reversed = false;
    double distance = 0;
  };

  /// Returns how far apart an edge and another that is joined to it may be.
  double reach(std::uint32_t edge) const {
    return rules_.is_relative ? std::min(rules_.reach, curve(leading_[edge]).box().diagonal() / 8) : rules_.reach;
  }
  /// Whether an edge is the opposite border of a border's patch, and none of the rows between them lies farther away
  /// than the reach.
  bool is_thin(std::uint32_t border, std::uint32_t edge) const {
    const std::uint32_t opposite = border / 4 * 4 + (border + 2) % 4;
    return edge_of_border(opposite) == edge &&
           tessera::is_thin(set_.patches[patch_of(border)], side_of(border), rules_.reach);
  }

  /// Compares an edge with another, and keeps the other if it is nearer than those before.
  void compare(std::uint32_t other, Nearest& nearest) const {
    const std::uint32_t a = leading_[nearest.edge], b = leading_[other];
    const SideCurve border = curve(a), met = curve(b);
    const double reach = std::min(this->reach(nearest.edge), this->reach(other));
    for (const bool turned : {false, true}) {
      const Vec3 first = turned ? met.last() : met.first(), last = turned ? met.first() : met.last();
      if (!(length(border.first() - first) <= reach && length(border.last() - last) <= reach)) continue;
      const double distance = distance_bound(border, met, turned);
      if (!(distance <= reach)) continue;
      const bool is_nearer = nearest.other == no_id || distance < nearest.distance ||
                             (distance == nearest.distance && comes_before(met, curve(leading_[nearest.other])));
      if (is_nearer && !is_thin(a, other)) nearest = {nearest.edge, other, turned, distance};
    }
  }

  /// Returns the edges that may be joined, in the order of their places.
  std::vector<EdgePlace> places() const {
    std::vector<EdgePlace> places;
    places.reserve(std::min<std::size_t>(64, leading_.size()));
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge) {
      const std::uint32_t border = leading_[edge];
      if (border == no_id || (rules_.is_relative && has_more_[edge])) continue;
      if (!rules_.stay.empty() && rules_.stay[border]) continue;
      const auto [first, last] = ends_of(border);
      const BezierPatch& patch = set_.patches[patch_of(first)];
      places.emplace_back(edge,
                          0.5 * (corner_of(patch, first) - set_.origin) + 0.5 * (corner_of(patch, last) - set_.origin));
    }
    sort_by_pieces(places);
    return places;
  }

  /// Finds the nearest edge to one at a place, if it has a single border.
  Nearest nearest_to(std::span<const EdgePlace> places, std::size_t k) const {
    const double reach = 1.001 * rules_.reach;  // compare() decides
    Nearest nearest{places[k].edge};
    if (has_more_[nearest.edge]) return nearest;
    const auto look = [&](const EdgePlace& other) {
      if (!(std::abs(other.along - places[k].along) <= reach)) return false;
      if (max_abs(other.middle - places[k].middle) <= reach) compare(other.edge, nearest);
      return true;
    };
    for (std::size_t n = k + 1; n < places.size() && look(places[n]); ++n) {
    }
    for (std::size_t n = k; n > 0 && look(places[n - 1]); --n) {
    }
    return nearest;
  }

  /// Joins each edge with a single border to the nearest edge. Returns whether there are any.
  bool join_edges() {
    const std::vector<EdgePlace> places = this->places();
    std::vector<Nearest> found(places.size());
    for_all(places.size(), [&](std::size_t k) { found[k] = nearest_to(places, k); });
    for (const Nearest& nearest : found) {
      if (nearest.other == no_id) continue;
      if (!joined_) joined_.emplace(edges_.count());
      joined_->unite(nearest.edge, nearest.other, nearest.reversed);
    }
    return joined_.has_value();
  }

  /// Finds the edge of each joined set whose leading border gives its points to all others.
  void choose_givers() {
    givers_.resize(leading_.size());
    std::iota(givers_.begin(), givers_.end(), std::uint32_t{0});
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge) {
      std::uint32_t& giver = givers_[joined_->find(edge).member];
      if (giver != edge && leading_[edge] != no_id && leads(leading_[edge], leading_[giver])) giver = edge;
    }
  }

  /// Returns the edge whose leading border gives its points to all edges joined to it.
  std::uint32_t canonical(std::uint32_t edge) { return joined_ ? givers_[joined_->find(edge).member] : edge; }
  /// Whether a border runs against the leading border of its canonical edge.
  bool runs_against(std::uint32_t border, std::uint32_t edge) {
    const bool turned = tessera::runs_against(set_, border, leading_[edge]);
    return joined_ ? turned != (joined_->find(edge).turned != joined_->find(canonical(edge)).turned) : turned;
  }

  /// Whether a border becomes a point.
  bool is_point(std::uint32_t border) const {
    const BezierPatch& patch = set_.patches[patch_of(border)];
    const auto [first, last] = ends_of(border);
    if (!(max_abs(corner_of(patch, first) - corner_of(patch, last)) <= rules_.reach)) return false;
    double most = rules_.reach;
    if (rules_.is_relative) {
      Box3 box;
      for (const Vec3& p : patch.points()) box.extend(p);
      most = std::min(most, WeldRules::point_share * box.diagonal());
    }
    return curve(border).box().diagonal() <= most;
  }
  /// Returns the borders that become points.
  std::vector<std::uint32_t> find_points() const {
    std::vector<std::uint32_t> blocks;  // those that may have any
    for (std::uint32_t block = 0; block < rules_.short_sides.size(); ++block)
      if (rules_.short_sides[block] != 0) blocks.push_back(block);
    std::vector<std::vector<std::uint32_t>> found(blocks.size());
    for_all(blocks.size(), [&](std::size_t k) {
      const std::uint32_t* const patches = set_.lane_patches.data() + blocks[k] * std::size_t{PatchSet::lanes};
      for (std::size_t lane = 0; lane < set_.lane_counts[blocks[k]]; ++lane)
        if ((rules_.short_sides[blocks[k]] >> lane & 1u) && !shapes_[patches[lane]].is_curve)
          for (std::uint32_t border = 4 * patches[lane]; border < 4 * patches[lane] + 4; ++border)
            if (edge_of_border(border) != no_id && is_point(border)) found[k].push_back(border);
    });
    std::vector<std::uint32_t> points;
    for (const std::vector<std::uint32_t>& borders : found) points.insert(points.end(), borders.begin(), borders.end());
    return points;
  }
  /// Makes the edges of borders points, unless too little would be left of their patches.
  void make_poles(std::span<const std::uint32_t> points) {
    is_pole_.assign(leading_.size(), 0);
    for (const std::uint32_t border : points) is_pole_[canonical(edge_of_border(border))] = 1;
    if (!points.empty()) keep_patches();
  }
  /// Whether a border is a point, by itself or by welding.
  bool is_made_point(std::uint32_t border) {
    const std::uint32_t edge = edge_of_border(border);
    return edge == no_id || is_pole_[canonical(edge)];
  }
  /// Whether welding leaves nothing of a patch but a line or a point: opposite borders become points, and the patch is
  /// a needle between them.
  bool vanishes(std::uint32_t patch) {
    const auto is_point = [&](std::uint32_t side) { return is_made_point(4 * patch + side); };
    const bool u = is_point(1) && is_point(3), v = is_point(0) && is_point(2);
    if (shapes_[patch].is_curve || (!u && !v)) return false;
    const auto is_along = [&](Side side) { return is_needle(set_.patches[patch], side, rules_.reach); };
    return (u && is_along(Side::v0)) || (v && is_along(Side::u0));
  }
  /// Keeps the borders of patches that would vanish, where no neighbour has triangles at what is left of them.
  void keep_patches() {
    std::vector<std::uint32_t> vanishing;
    std::vector<std::uint8_t> is_held(leading_.size(), 0);  // `[canonical edge]`: whether a patch that stays has it
    for (std::uint32_t patch = 0; patch < shapes_.size(); ++patch)
      if (vanishes(patch)) vanishing.push_back(patch);
    if (vanishing.empty()) return;
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (!std::ranges::binary_search(vanishing, border / 4)) is_held[canonical(edge)] = 1;
    });
    const auto sides = {0u, 1u, 2u, 3u};
    std::vector<std::uint32_t> kept;  // edges; all are decided by the same points
    for (const std::uint32_t patch : vanishing) {
      const bool is_point = std::ranges::all_of(sides, [&](auto side) { return is_made_point(4 * patch + side); });
      const auto holds = [&](std::uint32_t side) {
        const std::uint32_t border = 4 * patch + side, edge = edge_of_border(border);
        return edge != no_id && is_held[canonical(edge)] && (is_point || !is_made_point(border));
      };
      if (std::ranges::any_of(sides, holds)) continue;
      for (const std::uint32_t side : sides)
        if (const std::uint32_t edge = edge_of_border(4 * patch + side); edge != no_id) kept.push_back(canonical(edge));
    }
    for (const std::uint32_t edge : kept) is_pole_[edge] = 0;
  }

  void join_corners(UnionFind& corners) {
    for (std::size_t patch = 0; patch < set_.patches.size(); ++patch)
      for (const Side side : all_sides)
        if (weld_.shapes[patch].collapsed.has(side)) {
          const auto ends = ends_of(static_cast<std::uint32_t>(4 * patch) + static_cast<std::uint32_t>(side));
          corners.unite(ends[0], ends[1]);
        }
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      const auto ends = ends_of(border), met = ends_of(leading_[canonical(edge)]);
      const bool turned = runs_against(border, edge);
      corners.unite(ends[0], met[turned ? 1 : 0]);
      corners.unite(ends[1], met[turned ? 0 : 1]);
    });
  }

  /// Returns for each corner the one that gives it its point: of those that meet, that with the least coordinates;
  /// those of doubles come first.
  std::vector<std::uint32_t> corner_givers(UnionFind& corners) const {
    const auto rank = [&](std::uint32_t corner) {
      const Vec3 p = corner_of(set_.patches[patch_of(corner)], corner);
      return std::tuple(!is_f64(corner), p.x, p.y, p.z);
    };
    std::vector<std::uint32_t> givers(4 * set_.patches.size());
    std::iota(givers.begin(), givers.end(), std::uint32_t{0});
    for (std::uint32_t corner = 0; corner < givers.size(); ++corner) {
      std::uint32_t& giver = givers[corners.find(corner).member];
      if (giver != corner && rank(corner) < rank(giver)) giver = corner;
    }
    for (std::uint32_t corner = 0; corner < givers.size(); ++corner) {
      const std::uint32_t root = corners.find(corner).member;
      if (root != corner) givers[corner] = givers[root];
    }
    return givers;
  }

  void list_copies(UnionFind& corners) {
    const std::vector<std::uint32_t> givers = corner_givers(corners);
    for (std::size_t patch = 0; patch < set_.patches.size(); ++patch) {
      if (shapes_[patch].is_curve) continue;
      for (std::uint32_t side = 0; side < 4; ++side) {
        const std::uint32_t border = static_cast<std::uint32_t>(4 * patch) + side, edge = edge_of_border(border);
        const std::uint32_t corner = givers[border];
        const bool moves = !(packed_corner(set_, corner) == packed_corner(set_, border)),
                   takes = moves || (is_f64(corner) && corner != border);
        if (takes) weld_.corners.push_back({border, corner});
        const bool was_point = edge == no_id;
        if (was_point || is_pole_[canonical(edge)]) {
          if (!was_point || takes) weld_.poles.push_back({border, corner});
          if (!was_point || moves) ++weld_.joined_by_distance;
        } else if (canonical(edge) != edge || (is_f64(leading_[edge]) && leading_[edge] != border)) {
          weld_.borders.push_back({border, leading_[canonical(edge)], runs_against(border, edge)});
          if (canonical(edge) != edge) ++weld_.joined_by_distance;
        }
      }
    }
  }

  void renumber() {
    std::vector<std::uint32_t> numbers(leading_.size());
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge)
      numbers[edge] = is_pole_[canonical(edge)] ? no_id : canonical(edge);
    edges_.renumber(numbers);
  }

  const PatchSet::Impl& set_;
  std::span<const PatchShape> shapes_;  ///< before welding
  WeldRules rules_;
  SharedEdges& edges_;
  /// `[edge]`: its leading border: if there are any of doubles, one of these, else the first of a patch with an area.
  /// Until joins are found, none of edges with more borders where only single ones are joined.
  std::vector<std::uint32_t> leading_;
  std::vector<std::uint8_t> has_more_;  ///< `[edge]`: whether it has more than one border of patches with an area
  std::optional<UnionFind> joined_;     ///< sets of joined edges, if any are
  std::vector<std::uint32_t> givers_;   ///< `[edge]`: for the member that stands for a joined set, its canonical edge
  std::vector<std::uint8_t> is_pole_;   ///< `[canonical edge]`
  Weld weld_;
};

}  // namespace

Weld weld_borders(const PatchSet::Impl& set, std::span<const PatchShape> shapes, std::span<const double> roundings,
                  const WeldRules& rules, SharedEdges& edges) {
  return Welder(set, shapes, rules, edges).run(roundings);
}

}}  // namespace tessera::abi_0_1
