#include "tess/edges/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "tess/edges/side_curve.h"
#include "tess/edges/union_find.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::uint32_t none = SharedEdges::none;

Side side_of(std::uint32_t border) { return all_sides[border % 4]; }
std::size_t patch_of(std::uint32_t border) { return border / 4; }

SideCurve curve_of(const PatchSet::Impl& set, std::uint32_t border) {
  return {set.patches[patch_of(border)], side_of(border)};
}

/// Returns a corner's vertex as it is packed in float.
std::array<float, 3> packed_corner(const PatchSet::Impl& set, std::uint32_t corner) {
  const Vec3 p = corner_of(set.patches[patch_of(corner)], corner) - set.origin + Vec3{};
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Edges in cells by the middle of their ends; finds the edges whose middle lies within the tolerance of a point.
class EdgeCells {
 public:
  EdgeCells(const Box3& box, double tolerance)
      : origin_(box.lower), tolerance_(tolerance), size_(std::max(2 * tolerance, 0x1p-20 * box.diagonal())) {}

  void add(const Vec3& middle, std::uint32_t edge) { cells_[key(index(middle, 0))].push_back(edge); }
  template <class Visit>
  void for_near(const Vec3& middle, Visit visit) const {
    const Index low = index(middle, -tolerance_), high = index(middle, tolerance_);
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          if (const auto cell = cells_.find(key({x, y, z})); cell != cells_.end())
            for (const std::uint32_t edge : cell->second) visit(edge);
  }

 private:
  using Index = std::array<std::int64_t, 3>;
  /// Packs a cell's index. 21 bits per axis suffice: a box has at most 2^20 cells along an axis.
  static std::uint64_t key(const Index& at) {
    const auto part = [&](std::size_t c) { return static_cast<std::uint64_t>(at[c] + 1) & 0x1fffff; };
    return part(0) << 42 | part(1) << 21 | part(2);
  }
  Index index(const Vec3& p, double shift) const {
    const Vec3 from = p - origin_;
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor((x + shift) / size_)); };
    return {cell(from.x), cell(from.y), cell(from.z)};
  }

  Vec3 origin_;
  double tolerance_, size_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

class Welder {
 public:
  Welder(const PatchSet::Impl& set, std::span<const PatchShape> shapes, double tolerance, SharedEdges& edges,
         bool every_edge)
      : set_(set),
        tolerance_(tolerance),
        every_edge_(every_edge),
        edges_(edges),
        joined_(edges.count()),
        leading_(edges.count(), none),
        borders_of_(edges.count(), 0),
        is_pole_(edges.count(), 0) {
    weld_.shapes.assign(shapes.begin(), shapes.end());
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (leading_[edge] == none) leading_[edge] = border;
      ++borders_of_[edge];
    });
  }

  Weld run(std::span<const double> roundings) {
    if (tolerance_ > 0) {
      join_edges();
      find_poles();
    }
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
  SideCurve curve(std::uint32_t border) const { return curve_of(set_, border); }
  std::uint32_t edge_of_border(std::uint32_t border) const { return edges_.edge(patch_of(border), side_of(border)); }

  /// Calls visit(border, edge) for borders of patches with an area.
  template <class Visit>
  void for_borders(Visit visit) const {
    for (std::size_t patch = 0; patch < set_.patches.size(); ++patch)
      for (std::uint32_t side = 0; side < 4 && !weld_.shapes[patch].is_curve; ++side)
        if (const std::uint32_t edge = edges_.edge(patch, all_sides[side]); edge != none)
          visit(static_cast<std::uint32_t>(4 * patch) + side, edge);
  }

  void join_edges() {
    EdgeCells cells(set_.box(), tolerance_);
    const auto middle = [&](std::uint32_t edge) {
      const SideCurve border = curve(leading_[edge]);
      return 0.5 * border.first() + 0.5 * border.last();
    };
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge)
      if (leading_[edge] != none) cells.add(middle(edge), edge);
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge) {
      if (leading_[edge] == none || borders_of_[edge] > 1) continue;
      const SideCurve border = curve(leading_[edge]);
      double least = tolerance_;
      std::uint32_t nearest = none;
      bool reversed = false;
      cells.for_near(middle(edge), [&](std::uint32_t other) {
        if (other == edge) return;
        const SideCurve met = curve(leading_[other]);
        for (const bool turned : {false, true}) {
          const Vec3 first = turned ? met.last() : met.first(), last = turned ? met.first() : met.last();
          if (!(length(border.first() - first) <= tolerance_ && length(border.last() - last) <= tolerance_)) continue;
          const double distance = distance_bound(border, met, turned);
          if (distance < least || (distance == least && other < nearest)) {
            least = distance;
            nearest = other;
            reversed = turned;
          }
        }
      });
      if (nearest != none) joined_.unite(edge, nearest, reversed);
    }
  }

  /// Whether a border runs against the leading border of its canonical edge.
  bool runs_against(std::uint32_t border, std::uint32_t edge) {
    const std::uint32_t lead = leading_[edge];
    const bool turned = tessera::runs_against(set_, border, lead);
    return turned != joined_.find(edge).turned;
  }
  /// Returns the edge whose leading border gives its points to all edges joined to it.
  std::uint32_t canonical(std::uint32_t edge) { return joined_.find(edge).member; }

  void find_poles() {
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge)
      if (leading_[edge] != none && curve(leading_[edge]).box().diagonal() <= tolerance_) is_pole_[canonical(edge)] = 1;
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (is_pole_[canonical(edge)]) weld_.shapes[patch_of(border)].collapsed.add(tessera::edge_of(side_of(border)));
    });
  }

  void join_corners(UnionFind& corners) {
    for (std::size_t patch = 0; patch < set_.patches.size(); ++patch)
      for (const Side side : all_sides)
        if (weld_.shapes[patch].collapsed.has(tessera::edge_of(side))) {
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

  void list_copies(UnionFind& corners) {
    for (std::size_t patch = 0; patch < set_.patches.size(); ++patch) {
      if (weld_.shapes[patch].is_curve) continue;
      for (std::uint32_t side = 0; side < 4; ++side) {
        const std::uint32_t border = static_cast<std::uint32_t>(4 * patch) + side, edge = edge_of_border(border);
        const std::uint32_t corner = corners.find(border).member;
        const bool moves = !(packed(corner) == packed(border)), takes = moves || (every_edge_ && corner != border);
        if (takes) weld_.corners.push_back({border, corner});
        const bool was_point = edge == none;
        if (was_point || is_pole_[canonical(edge)]) {
          if (!was_point || takes) weld_.poles.push_back({border, corner});
          if (!was_point || moves) ++weld_.joined_by_distance;
        } else if (canonical(edge) != edge || (every_edge_ && leading_[edge] != border)) {
          weld_.borders.push_back({border, leading_[canonical(edge)], runs_against(border, edge)});
          if (canonical(edge) != edge) ++weld_.joined_by_distance;
        }
      }
    }
  }
  std::array<float, 3> packed(std::uint32_t corner) const { return packed_corner(set_, corner); }

  void renumber() {
    std::vector<std::uint32_t> numbers(leading_.size());
    for (std::uint32_t edge = 0; edge < leading_.size(); ++edge)
      numbers[edge] = is_pole_[canonical(edge)] ? none : canonical(edge);
    edges_.renumber(numbers);
  }

  const PatchSet::Impl& set_;
  double tolerance_;
  bool every_edge_;
  SharedEdges& edges_;
  UnionFind joined_;                       ///< sets of joined edges
  std::vector<std::uint32_t> leading_;     ///< `[edge]`: its leading border, the first one of a patch with an area
  std::vector<std::uint32_t> borders_of_;  ///< `[edge]`: the number of its borders of patches with an area
  std::vector<std::uint8_t> is_pole_;      ///< `[canonical edge]`
  Weld weld_;
};

}  // namespace

Weld weld_borders(const PatchSet::Impl& set, std::span<const PatchShape> shapes, std::span<const double> roundings,
                  double tolerance, SharedEdges& edges, bool every_edge) {
  return Welder(set, shapes, tolerance, edges, every_edge).run(roundings);
}

std::array<std::uint32_t, 2> ends_of(std::uint32_t border) {
  constexpr std::uint32_t ends[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  const std::uint32_t patch = border - border % 4;
  return {patch + ends[border % 4][0], patch + ends[border % 4][1]};
}

Vec3 corner_of(const BezierPatch& patch, std::uint32_t corner) {
  const bool end_u = corner % 4 == 1 || corner % 4 == 2, end_v = corner % 4 >= 2;
  return patch.point(end_u ? patch.degree_u() : 0, end_v ? patch.degree_v() : 0);
}

void measure_displacements(const PatchSet::Impl& set, const VertexCopies& copies, std::span<const double> roundings,
                           FunctionRef<bool(std::size_t patch)> wanted, std::span<double> displacements,
                           bool same_bits_stay) {
  const auto moved = [&](std::uint32_t to, std::uint32_t from, double distance) {
    double& most = displacements[patch_of(to)];
    most = std::max(most, distance + roundings[patch_of(from)]);
  };
  const auto corner = [&](std::uint32_t at) { return corner_of(set.patches[patch_of(at)], at); };
  const auto packed = [&](std::uint32_t border) { return PackedBorder(set, patch_of(border), side_of(border)); };
  for (const VertexCopies::Border& copy : copies.borders) {
    if (!wanted(patch_of(copy.to))) continue;
    if (same_bits_stay && equal(packed(copy.to), packed(copy.from), copy.reversed)) continue;
    moved(copy.to, copy.from, distance_bound(curve_of(set, copy.to), curve_of(set, copy.from), copy.reversed));
  }
  for (const VertexCopies::Corner& copy : copies.corners) {
    if (!wanted(patch_of(copy.to))) continue;
    if (same_bits_stay && packed_corner(set, copy.to) == packed_corner(set, copy.from)) continue;
    moved(copy.to, copy.from, length(corner(copy.to) - corner(copy.from)));
  }
  for (const VertexCopies::Corner& pole : copies.poles) {
    if (!wanted(patch_of(pole.to))) continue;
    if (same_bits_stay && packed_corner(set, pole.to) == packed_corner(set, pole.from)) continue;
    const SideCurve border = curve_of(set, pole.to);
    for (int k = 0; k <= border.degree(); ++k) moved(pole.to, pole.from, length(border.point(k) - corner(pole.from)));
  }
}

}  // namespace tessera::inline abi_0_1
