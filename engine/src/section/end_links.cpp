#include "section/end_links.h"

#include <algorithm>
#include <tuple>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The edge at an end, the use of it, and the edge's parameter; no edge if there is none.
std::tuple<std::uint32_t, std::uint32_t, double> edge_at(const EdgeRuns& runs, std::uint32_t patch,
                                                         const StrandEnd& end, const SectionPoint& point) {
  std::tuple<std::uint32_t, std::uint32_t, double> found(no_id, 0, 0);
  double least = 1e-6;  // of the domain's extent along the side
  runs.for_runs_of(patch, [&](const EdgeRun& run) {
    const std::span<const TrimPiece> pieces = runs.pieces(run);
    if (end.on == StrandEnd::On::loop && !run.is_side && end.line >= run.first && end.line < run.end) {
      const Interval& range = pieces[end.line - run.first].range;
      const double t = range.from + end.place * (range.to - range.from);
      found = {run.edge, run.use, runs.curve(run).to_edge(t)};
    }
    if (end.on != StrandEnd::On::border || !run.is_side || run.side != end.side) return;
    const double place = along_side(run.side, point);
    const auto [low, high] = ends_along(run.side, pieces);
    const double outside = std::max({low - place, place - high, 0.0}) / (high - low);
    if (outside >= least) return;
    least = outside;
    found = {run.edge, run.use, runs.curve(run).to_edge(parameter_at(pieces, run.side, std::clamp(place, low, high)))};
  });
  return found;
}

}  // namespace

const SectionPoint& EndLinks::point(std::uint32_t end) const {
  const Strand& strand = strands_[end / 2];
  return points_[strand.first + (end % 2 == 0 ? 0 : strand.count - 1)];
}

void EndLinks::join(std::span<const Strand> strands, std::span<const SectionPoint> points, const LinkOptions& options) {
  strands_ = strands;
  points_ = points;
  largest_gap_ = 0;
  other_.assign(2 * strands.size(), no_id);
  join_borders();
  if (options.runs) join_edges(options);
  join_near(options.near);
}

/// Joins the two strands that meet at a border's point. Where there are more, edges decide.
void EndLinks::join_borders() {
  ends_.clear();
  for (std::uint32_t end = 0; end < other_.size(); ++end)
    if (!strands_[end / 2].closed && at(end).on == StrandEnd::On::border) ends_.push_back(end);
  const auto key = [&](std::uint32_t end) { return std::tuple(at(end).line, at(end).interval); };
  std::ranges::sort(ends_, {}, [&](std::uint32_t end) { return std::tuple_cat(key(end), std::tuple(end)); });
  for (std::size_t first = 0; first < ends_.size();) {
    std::size_t next = first + 1;
    while (next < ends_.size() && key(ends_[next]) == key(ends_[first])) ++next;
    if (next == first + 2) link(ends_[first], ends_[first + 1]);
    first = next;
  }
}

/// Joins ends of different uses of one edge, the nearest first.
void EndLinks::join_edges(const LinkOptions& options) {
  on_edges_.clear();
  for (std::uint32_t end = 0; end < other_.size(); ++end) {
    if (strands_[end / 2].closed || other_[end] != no_id || at(end).on == StrandEnd::On::nothing) continue;
    const auto [edge, use, place] = edge_at(*options.runs, strands_[end / 2].patch, at(end), point(end));
    if (edge != no_id) on_edges_.push_back({edge, use, place, end});
  }
  std::ranges::sort(on_edges_, {}, [](const EdgeEnd& of) { return std::tuple(of.edge, of.place, of.end); });
  pairs_.clear();
  constexpr std::size_t most_neighbours = 16;
  for (std::size_t k = 0; k < on_edges_.size(); ++k)
    for (std::size_t other = k + 1; other < std::min(on_edges_.size(), k + most_neighbours); ++other) {
      const EdgeEnd &a = on_edges_[k], &b = on_edges_[other];
      if (a.edge != b.edge) break;
      const double distance = length(point(a.end).position - point(b.end).position);
      if (a.use != b.use && distance <= options.max_gap) pairs_.push_back({distance, a.end, b.end});
    }
  join_pairs();
}

/// Joins the nearest of the ends that are left.
void EndLinks::join_near(double distance) {
  ends_.clear();
  for (std::uint32_t end = 0; end < other_.size(); ++end)
    if (!strands_[end / 2].closed && other_[end] == no_id) ends_.push_back(end);
  // Sorting along an odd direction leaves few ends beside each other that are not near.
  const auto key = [&](std::uint32_t end) {
    const Vec3& p = point(end).position;
    return 0.7548776662466927 * p.x + 0.5698402909980532 * p.y + 0.3247179572447561 * p.z;
  };
  std::ranges::sort(ends_, {}, [&](std::uint32_t end) { return std::tuple(key(end), end); });
  pairs_.clear();
  for (std::size_t k = 0; k < ends_.size(); ++k)
    for (std::size_t next = k + 1; next < ends_.size() && key(ends_[next]) - key(ends_[k]) <= distance; ++next) {
      const double found = length(point(ends_[k]).position - point(ends_[next]).position);
      const bool is_own = ends_[k] / 2 == ends_[next] / 2;  // a strand no longer than this stays open
      if (found <= distance && !(is_own && strands_[ends_[k] / 2].count <= 2))
        pairs_.push_back({found, ends_[k], ends_[next]});
    }
  join_pairs();
}

void EndLinks::join_pairs() {
  std::ranges::sort(pairs_, {}, [](const Pair& of) { return std::tuple(of.distance, of.a, of.b); });
  for (const Pair& pair : pairs_) {
    if (other_[pair.a] != no_id || other_[pair.b] != no_id) continue;
    link(pair.a, pair.b);
    largest_gap_ = std::max(largest_gap_, pair.distance);
  }
}

}}  // namespace tessera::abi_0_1
