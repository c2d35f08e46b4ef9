#include "facts/borders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace tessera::cli {
namespace {

/// Numbers points; points within the tolerance of each other share the number of the first one. A hash of cells of that
/// size.
class Places {
 public:
  Places(const Vec3& origin, double tolerance) : origin_(origin), tolerance_(tolerance) {}

  std::uint32_t number_of(const Vec3& point) {
    const Cell cell = cell_of(point);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found = cells_.find({cell[0] + k / 9 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k % 3 - 1});
      if (found == cells_.end()) continue;
      for (const std::uint32_t number : found->second) {
        if (length(points_[number] - point) <= tolerance_) return number;
      }
    }
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    cells_[cell].push_back(number);
    return number;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : cell)
        hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u + (hash >> 29);
      return static_cast<std::size_t>(hash);
    }
  };

  Cell cell_of(const Vec3& p) const {
    const auto index = [this](double x) { return static_cast<std::int64_t>(std::floor(x / tolerance_)); };
    const Vec3 from = p - origin_;
    return {index(from.x), index(from.y), index(from.z)};
  }

  Vec3 origin_;
  double tolerance_;
  std::vector<Vec3> points_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
};

struct Candidate {
  Border border;
  Vec3 middle;
  double length = 0;  // of the control polygon
};

/// The border's control point k, from 0 to its degree.
const Vec3& border_point(const BezierPatch& patch, Side side, int k) {
  switch (side) {
    case Side::u0:
      return patch.point(0, k);
    case Side::u1:
      return patch.point(patch.degree_u(), k);
    case Side::v0:
      return patch.point(k, 0);
    case Side::v1:
      break;
  }
  return patch.point(k, patch.degree_v());
}

bool along_v(Side side) { return side == Side::u0 || side == Side::u1; }

Candidate candidate(const BezierPatch& patch, const Border& border) {
  Candidate out{border, {}, 0};
  const double end = border.side == Side::u1 || border.side == Side::v1 ? 1 : 0;
  out.middle = along_v(border.side) ? de_casteljau(patch, end, 0.5) : de_casteljau(patch, 0.5, end);
  const int degree = along_v(border.side) ? patch.degree_v() : patch.degree_u();
  for (int k = 0; k < degree; ++k)
    out.length += length(border_point(patch, border.side, k + 1) - border_point(patch, border.side, k));
  return out;
}

/// Splits groups of borders with the same ends by the middles of the borders.
void split(const std::vector<Candidate>& all, std::vector<std::vector<Border>>& groups) {
  constexpr double near = 0.05;                                   // of the length
  std::vector<std::pair<const Candidate*, std::size_t>> leaders;  // the first border of each new group, and the group
  for (const Candidate& one : all) {
    const auto leader = std::find_if(leaders.begin(), leaders.end(), [&](const auto& of) {
      return length(of.first->middle - one.middle) <= near * std::max(of.first->length, one.length);
    });
    if (leader != leaders.end()) {
      groups[leader->second].push_back(one.border);
    } else {
      leaders.emplace_back(&one, groups.size());
      groups.push_back({one.border});
    }
  }
}

}  // namespace

std::vector<std::vector<Border>> group_borders(const PatchSet& set, double tolerance) {
  Places places(set.box().lower, tolerance);
  std::unordered_map<std::uint64_t, std::size_t> by_ends;
  std::vector<std::vector<Candidate>> candidates;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    const SideMask collapsed = patch.collapsed_sides();
    for (const Side side : {Side::u0, Side::u1, Side::v0, Side::v1}) {
      if (collapsed.has(side)) continue;
      const int degree = along_v(side) ? patch.degree_v() : patch.degree_u();
      const std::uint32_t a = places.number_of(border_point(patch, side, 0));
      const std::uint32_t b = places.number_of(border_point(patch, side, degree));
      const std::uint64_t ends = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
      const auto [place, is_new] = by_ends.emplace(ends, candidates.size());
      if (is_new) candidates.emplace_back();
      candidates[place->second].push_back(candidate(patch, {static_cast<std::uint32_t>(k), side}));
    }
  }
  std::vector<std::vector<Border>> groups;
  for (const std::vector<Candidate>& same_ends : candidates) split(same_ends, groups);
  return groups;
}

}  // namespace tessera::cli
