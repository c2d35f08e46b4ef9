#include "query/set_orientation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/infinity.h"
#include "base/point_tree.h"
#include "base/union_find.h"
#include "block/patch_edges.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"
#include "query/loop_borders.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The uses of each edge that is no point.
std::vector<std::vector<std::uint32_t>> uses_of_edges(const SetView& set, const std::vector<BorderUse>& uses) {
  if (!set.impl().edges) return {};
  const std::vector<PatchEdges::Edge>& edges = set.impl().edges->edges;
  std::vector<std::vector<std::uint32_t>> out(edges.size());
  for (std::uint32_t use = 0; use < uses.size(); ++use) {
    const auto& [edge, patch, along] = uses[use];
    if (edge != no_id && along != 0 && !edges[edge].degenerate) out[edge].push_back(use);
  }
  return out;
}

class Orientation {
 public:
  Orientation(const SetView& set, const Adjacency& links)
      : set_(set), links_(links), loops_(find_loop_borders(set)), turns_(set.patch_count()) {
    edges_ = uses_of_edges(set, loops_.uses);
  }

  void join() {
    for (std::uint32_t patch = 0; patch < set_.patch_count(); ++patch)
      if (loops_.face_of[patch] != no_id) turns_.unite(loops_.face_of[patch], patch);
    join_edges();
    join_links(false);
    join_links(true);
  }

  bool is_turned(std::uint32_t patch) { return turns_.find(patch).turned; }
  UnionFind& turns() { return turns_; }

  /// Lists the borders of each part along which nothing, or nothing that faces to the same side, is joined.
  std::vector<SetBorder> open_borders() {
    std::vector<std::int8_t> signs;
    for (std::uint32_t patch = 0; patch < set_.patch_count(); ++patch) signs.push_back(is_turned(patch) ? -1 : 1);
    std::vector<SetBorder> open;
    std::vector<std::uint8_t> is_open(loops_.uses.size(), 0);
    for (const std::vector<std::uint32_t>& uses : edges_) {
      std::map<std::uint32_t, int> sums;  // of parts: how often they run along the edge more than against it
      const auto sum_of = [&](const BorderUse& use) -> int& { return sums[turns_.find(use.patch).member]; };
      for (const std::uint32_t k : uses) {
        const BorderUse& use = loops_.uses[k];
        sum_of(use) += signs[use.patch] * (use.along > 0 ? 1 : -1);
      }
      for (const std::uint32_t k : uses) is_open[k] = sum_of(loops_.uses[k]) != 0;
    }
    for (const SetBorder& border : loops_.borders)
      if (border.use == no_id ? !is_seam(border) : is_open[border.use] != 0) open.push_back(border);
    for (std::uint32_t patch = 0; patch < set_.patch_count(); ++patch) add_open_sides(patch, signs, open);
    return open;
  }

 private:
  void join_edges() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t edge = 0; edge < edges_.size(); ++edge)
      if (edges_[edge].size() == 2) order.push_back(edge);
    const auto length_of = [&](std::uint32_t edge) { return -std::abs(loops_.uses[edges_[edge][0]].along); };
    std::ranges::stable_sort(order, {}, length_of);
    for (const std::uint32_t edge : order) {
      const BorderUse &a = loops_.uses[edges_[edge][0]], &b = loops_.uses[edges_[edge][1]];
      turns_.unite(a.patch, b.patch, (a.along > 0) == (b.along > 0));
    }
  }

  /// Whether two patches face to different sides if both face along their own normals.
  static bool is_against(int side, const EdgeLink& link) {
    const int there = direction_of(link_sides[link.edge]) * (link.reversed ? -1 : 1);
    return direction_of(link_sides[static_cast<std::size_t>(side)]) == there;
  }

  /// Whether a border is a side along which a face meets itself.
  bool is_seam(const SetBorder& border) const {
    if (border.piece) return false;
    const auto side = static_cast<int>(std::ranges::find(link_sides, border.side) - link_sides.begin());
    const EdgeLink& link = links_.across(border.patch, side);
    return link.exists() && loops_.face_of[link.patch] == loops_.face_of[border.patch] && !is_against(side, link);
  }

  void join_links(bool of_loops) {
    for (std::uint32_t patch = 0; patch < set_.patch_count(); ++patch)
      for (int side = 0; side < 4; ++side) {
        const EdgeLink& link = links_.across(patch, side);
        if (!link.exists()) continue;
        const bool has_loops = loops_.face_of[patch] != no_id || loops_.face_of[link.patch] != no_id;
        if (has_loops == of_loops) turns_.unite(patch, link.patch, is_against(side, link));
      }
  }

  void add_open_sides(std::uint32_t patch, const std::vector<std::int8_t>& signs, std::vector<SetBorder>& open) const {
    if (loops_.face_of[patch] != no_id) return;
    for (int side = 0; side < 4; ++side) {
      const Side at = link_sides[static_cast<std::size_t>(side)];
      if (set_.collapsed_sides(patch).has(at)) continue;
      const EdgeLink& link = links_.across(patch, side);
      const bool is_joined = link.exists() && loops_.face_of[link.patch] == no_id &&
                             signs[patch] * signs[link.patch] == (is_against(side, link) ? -1 : 1);
      if (is_joined) continue;
      open.push_back({.patch = patch, .side = at, .direction = direction_of(at)});
    }
  }

  const SetView& set_;
  const Adjacency& links_;
  LoopBorders loops_;
  std::vector<std::vector<std::uint32_t>> edges_;  ///< `[edge]`: uses
  UnionFind turns_;
};

/// Makes the arcs of borders, as their patches' own normals see them.
Status make_arcs(const SetView& set, std::span<const SetBorder> borders, double tolerance, const Execution& execution,
                 std::vector<BorderArc>& arcs) {
  constexpr std::size_t per_task = 64;
  std::vector<std::vector<BorderArc>> made((borders.size() + per_task - 1) / per_task);
  const auto make = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      append_arcs([&](double t) { return position_on(set, borders[k], t); }, tolerance, borders[k].patch,
                  borders[k].direction, made[begin / per_task]);
  };
  if (Status status = parallel_for(borders.size(), per_task, execution, make); !status.ok()) return status;
  for (std::vector<BorderArc>& some : made) {
    arcs.insert(arcs.end(), some.begin(), some.end());
    some = {};
  }
  return {};
}

/// A point of an arc, which stands for a part of it.
struct ArcPoint {
  std::size_t arc;
  Vec3 place;
  double share;  ///< the length of that part
};

/// Joins parts whose open borders run beside each other: first those that do so over the greatest length.
class BesideJoiner {
 public:
  BesideJoiner(const std::vector<BorderArc>& arcs, double reach) : arcs_(arcs), reach_(reach) {}

  void join(UnionFind& turns) {
    for (const BorderArc& arc : arcs_) roots_.push_back(turns.find(arc.patch));
    if (std::ranges::all_of(roots_, [&](const UnionFind::Root& root) { return root.member == roots_[0].member; }))
      return;
    find_votes();
    std::vector<std::pair<double, Pair>> order;
    for (std::size_t begin = 0, end = 0; begin < votes_.size(); begin = end) {
      double sum = 0;
      for (; end < votes_.size() && votes_[end].first == votes_[begin].first; ++end) sum += votes_[end].second;
      order.emplace_back(sum, votes_[begin].first);
    }
    std::ranges::stable_sort(order, {}, [](const auto& of) { return -std::abs(of.first); });
    for (const auto& [vote, parts] : order)
      if (vote != 0) turns.unite(parts.first, parts.second, vote < 0);
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// How far an arc of a length may be from another at most.
  double reach_of(double size) const { return std::min(reach_, 0.25 * size); }

  /// The distance of a point from an arc if that runs beside the point's, or infinity.
  double distance(const ArcPoint& point, const BorderArc& other) const {
    constexpr double least_cosine = 0.8;
    const Vec3 own = arcs_[point.arc].to() - arcs_[point.arc].from(), along = other.to() - other.from();
    const double square = dot(along, along), size = length(own);
    if (!(square > 0 && size > 0)) return infinity;
    const Vec3 off = point.place - other.from();
    const double found = length(off - std::clamp(dot(off, along) / square, 0.0, 1.0) * along);
    const bool is_parallel = std::abs(dot(own, along)) >= least_cosine * size * std::sqrt(square);
    return is_parallel && found <= reach_of(size) ? found : infinity;
  }

  /// Points two reaches from each other, so that one of them lies within one and a half of a point beside their arc.
  std::vector<ArcPoint> points() const {
    std::vector<ArcPoint> out;
    for (std::size_t arc = 0; arc < arcs_.size(); ++arc) {
      const Vec3 from = arcs_[arc].from(), to = arcs_[arc].to();
      const double size = length(to - from);
      constexpr double most = 64;
      if (!(size > 0)) continue;
      const int count = static_cast<int>(std::clamp(std::ceil(size / (2 * reach_of(size))), 1.0, most));
      for (int k = 0; k < count; ++k) {
        const double share = (k + 0.5) / count;
        out.push_back({arc, (1 - share) * from + share * to, size / count});
      }
    }
    return out;
  }

  void find_votes() {
    const std::vector<ArcPoint> of = points();
    std::vector<Vec3> places;
    places.reserve(of.size());
    for (const ArcPoint& point : of) places.push_back(point.place);
    const PointTree tree(places);
    for (const ArcPoint& point : of) {
      const UnionFind::Root own = roots_[point.arc];
      const double half = 1.5 * reach_of(length(arcs_[point.arc].to() - arcs_[point.arc].from()));
      const Box3 box{point.place - Vec3{half, half, half}, point.place + Vec3{half, half, half}};
      constexpr int max_looks = 32;  // where many arcs lie upon each other
      int looks = 0;
      double nearest = infinity;
      std::pair<Pair, double> vote;
      tree.visit_box_while(box, [&](std::uint32_t at) {
        const BorderArc& other = arcs_[of[at].arc];
        const UnionFind::Root root = roots_[of[at].arc];
        const double away = root.member == own.member ? infinity : distance(point, other);
        const bool goes_on = ++looks < max_looks;
        if (!(away < nearest)) return goes_on;
        nearest = away;
        const double same = dot(arcs_[point.arc].to() - arcs_[point.arc].from(), other.to() - other.from());
        vote = {std::minmax(root.member, own.member),
                ((same < 0) == (root.turned == own.turned) ? 1 : -1) * point.share};
        return goes_on;
      });
      if (nearest < infinity) votes_.push_back(vote);
    }
    std::ranges::stable_sort(votes_, {}, &std::pair<Pair, double>::first);
  }

  const std::vector<BorderArc>& arcs_;
  double reach_;
  std::vector<UnionFind::Root> roots_;  ///< `[arc]`: the first patch of its part
  std::vector<std::pair<Pair, double>> votes_;
};

}  // namespace

Result<SetOrientation> orient(const SetView& set, const Adjacency& borders, const Execution& execution) {
  Orientation orientation(set, borders);
  orientation.join();
  SetOrientation out;
  const Box3 box = set.box();
  const double size = box.diagonal();
  out.near = 1e-11 * size + 0x1p-44 * std::max(max_abs(box.lower), max_abs(box.upper));
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = make_arcs(set, orientation.open_borders(), out.near, quiet, out.arcs); !status.ok())
    return status;
  constexpr double largest_gap = 1e-2;
  BesideJoiner(out.arcs, largest_gap * size).join(orientation.turns());
  for (std::uint32_t patch = 0; patch < set.patch_count(); ++patch) {
    const UnionFind::Root root = orientation.turns().find(patch);
    out.signs.push_back(root.turned ? -1 : 1);
    out.parts.push_back(root.member);
  }
  for (BorderArc& arc : out.arcs) arc.sign = static_cast<std::int8_t>(arc.sign * out.signs[arc.patch]);
  return out;
}

}}  // namespace tessera::abi_0_1
