#include "facts/joins.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "console/progress.h"

namespace tessera::cli {
namespace {

// Borders of patches that lie at the same place.

/// A side of a patch of a set.
struct Border {
  std::uint32_t patch = 0;
  Side side = Side::u0;
};

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

/// Groups all borders that are not collapsed, in the order of the groups' first members. Borders of a group have the
/// same ends (within `tolerance`, at least 1e-9 of the model's size) and about the same middle (within a twentieth of
/// their length). O(borders) if few share their ends.
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

struct Join {
  Border p, q;
  bool between_surfaces = false;
};

JoinedPatch side(const PatchSet& set, const Border& border) {
  return {set.patch(border.patch), border.side, set.source(border.patch).domain};
}

/// Measures joins on all threads; an element without a value is a join that cannot be measured (none is known).
std::vector<Result<JoinReport>> measure(const PatchSet& set, std::span<const Join> joins) {
  std::vector<Result<JoinReport>> reports(joins.size(), Status(StatusCode::cancelled, "interrupted"));
  PartsProgress progress("measuring joins", joins.size());
  tbb::parallel_for(std::size_t{0}, joins.size(), [&](std::size_t k) {
    if (interrupted()) return;
    reports[k] = measure_join(side(set, joins[k].p), side(set, joins[k].q), join_tolerances);
    progress.tell(k, 1);
  });
  return reports;
}

void count(const JoinReport& report, JoinCounts& counts) {
  ++counts.measured;
  if (report.continuity == Continuity::none) {
    ++counts.gaps;
    counts.largest_gap = std::max(counts.largest_gap, report.position_gap);
    return;
  }
  counts.largest_angle = std::max(counts.largest_angle, report.normal_angle);
  counts.c1 += report.continuity == Continuity::c1;
  counts.g1 += report.continuity == Continuity::g1;
  counts.c0 += report.continuity == Continuity::c0;
}

std::string counts_text(const JoinCounts& counts) {
  std::string text = std::to_string(counts.joins);
  if (counts.measured == 0) return text + (counts.joins == 0 ? "" : ", not measured");
  if (counts.measured < counts.joins) text += ", of which " + std::to_string(counts.measured) + " measured";
  std::string classes;
  const auto add = [&](std::size_t number, const char* name) {
    if (number > 0) classes += (classes.empty() ? "" : ", ") + std::to_string(number) + " " + name;
  };
  add(counts.c1, "C1");
  add(counts.g1, "G1");
  add(counts.c0, "C0");
  add(counts.gaps, counts.gaps == 1 ? "gap" : "gaps");
  text += ": " + classes;
  std::string worst;
  if (counts.c0 > 0) worst = "largest angle " + readable(counts.largest_angle * 180 / std::numbers::pi, 3) + " deg";
  if (counts.gaps > 0) worst += (worst.empty() ? "largest gap " : ", largest gap ") + readable(counts.largest_gap, 3);
  return worst.empty() ? text : text + " (" + worst + ")";
}

Json counts_json(const JoinCounts& counts) {
  return {{"joins", counts.joins},
          {"measured", counts.measured},
          {"c1", counts.c1},
          {"g1", counts.g1},
          {"c0", counts.c0},
          {"gaps", counts.gaps},
          {"largest_angle_degrees", counts.largest_angle * 180 / std::numbers::pi},
          {"largest_gap", counts.largest_gap}};
}

}  // namespace

Result<Joins> find_joins(const PatchSet& set, std::size_t most) {
  constexpr double same_place = 1e-4;  // of the model's size
  Joins found;
  const double size = set.box().diagonal();
  if (!(size > 0)) return found;
  std::vector<Join> joins;
  for (const std::vector<Border>& group : group_borders(set, same_place * size)) {
    found.open_borders += group.size() == 1;
    found.crowded_borders += group.size() > 2;
    if (group.size() != 2) continue;
    const bool between = set.source(group[0].patch).surface != set.source(group[1].patch).surface;
    ++(between ? found.between_surfaces : found.within_surfaces).joins;
    joins.push_back({group[0], group[1], between});
  }
  std::stable_partition(joins.begin(), joins.end(), [](const Join& join) { return join.between_surfaces; });
  joins.resize(std::min(joins.size(), most));
  const std::vector<Result<JoinReport>> reports = measure(set, joins);
  if (interrupted()) return Status(StatusCode::cancelled, "interrupted");
  for (std::size_t k = 0; k < joins.size(); ++k) {
    if (reports[k]) count(*reports[k], joins[k].between_surfaces ? found.between_surfaces : found.within_surfaces);
  }
  return found;
}

void add_joins(Report& report, const std::optional<Joins>& joins) {
  if (!joins) return report.add("joins", {}, "\n  joins            left out, as --joins 0 says");
  report.add("joins",
             {{"between_surfaces", counts_json(joins->between_surfaces)},
              {"within_surfaces", counts_json(joins->within_surfaces)},
              {"open_borders", joins->open_borders},
              {"crowded_borders", joins->crowded_borders}},
             "\n  joins            between surfaces " + counts_text(joins->between_surfaces) +
                 "\n                   within surfaces " + counts_text(joins->within_surfaces) +
                 "\n  open borders     " + std::to_string(joins->open_borders));
  if (joins->crowded_borders > 0)
    report.say("\n  crowded borders  " + std::to_string(joins->crowded_borders) + ", of three patches or more");
}

}  // namespace tessera::cli
