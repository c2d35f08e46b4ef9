#include "facts/joins.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <numbers>
#include <vector>

#include "console/progress.h"
#include "facts/borders.h"

namespace tessera::cli {
namespace {

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
  Progress progress("measuring joins");
  std::mutex mutex;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, joins.size(), [&](std::size_t k) {
    if (interrupted()) return;
    reports[k] = measure_join(side(set, joins[k].p), side(set, joins[k].q), join_tolerances);
    const std::lock_guard lock(mutex);
    progress.tell(static_cast<double>(++done) / static_cast<double>(joins.size()));
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
