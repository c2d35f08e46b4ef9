#include "join/piece_groups.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The largest distance of a third piece from two that are an edge, as a share of the distance.
constexpr double third_share = 1.0 / 8;

class Grouper {
 public:
  Grouper(const FreeCurves& free, std::span<const CurvePiece> pieces, std::span<const PiecePair> pairs,
          UnionFind& vertices)
      : free_(free),
        pieces_(pieces),
        vertices_(vertices),
        groups_(pieces.size()),
        next_(pieces.size()),
        has_other_(pieces.size(), false) {
    std::iota(next_.begin(), next_.end(), 0u);
    for (const PiecePair& pair : pairs)
      if (pair.is_strip) beyond_strip_.insert({{pair.a, pair.b}, {pair.b, pair.a}});
  }

  void join(const PiecePair& pair) {
    if (are_parted(pair.a, pair.b)) return;
    const bool first = !has_other_[pair.a] && !has_other_[pair.b];
    if (first || pair.distance <= third_share * free_.distance) unite(pair.a, pair.b, pair.turned);
  }

  /// Joins short pieces between the same vertices.
  void join_short() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    for (std::uint32_t k = 0; k < pieces_.size(); ++k) {
      if (has_other_[k] || pieces_[k].extent > free_.distance) continue;
      const std::uint32_t start = vertices_.find(start_vertex(k)).member, end = vertices_.find(end_vertex(k)).member;
      if (start == end) continue;
      const auto [place, is_new] = known.emplace(std::minmax(start, end), k);
      if (is_new) continue;
      const std::uint32_t other = place->second;
      if (are_parted(k, other)) continue;
      unite(k, other, vertices_.find(start_vertex(other)).member != start);
    }
  }

  std::vector<PieceGroup> groups() {
    std::map<std::uint32_t, PieceGroup> by_root;
    for (std::uint32_t k = 0; k < pieces_.size(); ++k) {
      if (!has_other_[k]) continue;
      const UnionFind::Root root = groups_.find(k);
      by_root[root.member].push_back({k, root.turned});
    }
    std::vector<PieceGroup> out;
    for (auto& [root, group] : by_root) {
      const auto leader = std::min_element(group.begin(), group.end(), [&](const GroupMember& a, const GroupMember& b) {
        return pieces_[a.piece].rank < pieces_[b.piece].rank;
      });
      std::iter_swap(group.begin(), leader);
      const bool turned = group.front().turned;
      for (GroupMember& member : group) member.turned = member.turned != turned;
      out.push_back(std::move(group));
    }
    return out;
  }

 private:
  const CurveNode& node(std::uint32_t piece, std::uint32_t after) const {
    return free_.curves[pieces_[piece].curve].nodes[pieces_[piece].node + after];
  }
  std::uint32_t start_vertex(std::uint32_t piece) const { return node(piece, 0).vertex; }
  std::uint32_t end_vertex(std::uint32_t piece) const { return node(piece, 1).vertex; }

  /// Whether one of the pieces that are an edge with `a`, and one of those with `b`, have a strip of a face between
  /// them.
  bool are_parted(std::uint32_t a, std::uint32_t b) {
    if (beyond_strip_.empty()) return false;
    const std::uint32_t of_b = groups_.find(b).member;
    std::uint32_t k = a;
    do {
      const auto [first, last] = beyond_strip_.equal_range(k);
      if (std::any_of(first, last, [&](const auto& strip) { return groups_.find(strip.second).member == of_b; }))
        return true;
      k = next_[k];
    } while (k != a);
    return false;
  }

  void unite(std::uint32_t a, std::uint32_t b, bool turned) {
    has_other_[a] = has_other_[b] = true;
    if (groups_.find(a).member != groups_.find(b).member) std::swap(next_[a], next_[b]);
    groups_.unite(a, b, turned);
    vertices_.unite(start_vertex(a), turned ? end_vertex(b) : start_vertex(b));
    vertices_.unite(end_vertex(a), turned ? start_vertex(b) : end_vertex(b));
  }

  const FreeCurves& free_;
  std::span<const CurvePiece> pieces_;
  UnionFind& vertices_;
  UnionFind groups_;
  std::vector<std::uint32_t> next_;  ///< by piece: the next one of its group, in a ring
  std::vector<bool> has_other_;
  std::multimap<std::uint32_t, std::uint32_t> beyond_strip_;  ///< by piece: those across a strip of its face
};

}  // namespace

std::vector<PieceGroup> group_pieces(const FreeCurves& free, std::span<const CurvePiece> pieces,
                                     std::vector<PiecePair> pairs, UnionFind& vertices) {
  std::sort(pairs.begin(), pairs.end(), [&](const PiecePair& p, const PiecePair& q) {
    const auto order = [&](const PiecePair& pair) {
      const std::uint32_t a = pieces[pair.a].rank, b = pieces[pair.b].rank;
      return std::tuple(pair.distance, std::min(a, b), std::max(a, b), pair.turned);
    };
    return order(p) < order(q);
  });
  Grouper grouper(free, pieces, pairs, vertices);
  for (const auto& [a, b] : free.same_vertices) vertices.unite(a, b);
  for (const PiecePair& pair : pairs) grouper.join(pair);
  grouper.join_short();
  return grouper.groups();
}

}}  // namespace tessera::abi_0_1
