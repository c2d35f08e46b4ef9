#include "tess/closing/edge_stops.h"

#include <algorithm>

#include "tess/trimmed/patch_sides.h"

namespace tessera::inline abi_0_1 {
namespace {

/// Sorts parameters, and keeps the first of those that count as one.
void sort_distinct(std::vector<double>& list, double same) {
  std::ranges::sort(list);
  std::size_t count = 0;
  for (const double s : list)
    if (count == 0 || s - list[count - 1] > same) list[count++] = s;
  list.resize(count);
}

}  // namespace

void EdgeStops::find(const PatchSet::Impl& set, const EdgeRuns& runs, std::size_t edge,
                     FunctionRef<Segments(std::uint32_t patch, Side side)> segments,
                     FunctionRef<ChordLimits(std::uint32_t patch)> limits) {
  const std::span<const EdgeRun> of = runs.of(edge);
  std::vector<double>& list = stops_[edge];
  list.clear();
  const auto is_chord = [](const EdgeRun& run) { return !run.is_side; };
  if (!runs.meet(edge) || std::ranges::none_of(of, is_chord)) return;
  const Interval& range = runs.edges().edges[edge].range;
  const double same = same_share * (range.to - range.from);
  for (const EdgeRun& run : of) {
    const std::span<const TrimPiece> pieces = runs.pieces(run);
    const auto add = [&](double t) { list.push_back(runs.to_edge(run.face, pieces.front(), t)); };
    add(pieces.front().range.from);
    add(pieces.back().range.to);
    if (!run.is_side) continue;
    const bool along_u = runs_along_u(run.side);
    const Domain& domain = set.sources[run.patch].domain;
    const auto [low, high] =
        std::minmax({along_of(pieces.front().start(), along_u), along_of(pieces.back().end(), along_u)});
    const Segments along = segments(run.patch, run.side);
    for (int k = 0; k <= along.rate(); ++k) {
      const double at = line_at(along_u ? domain.u0 : domain.v0, along_u ? domain.u1 : domain.v1, along, k);
      if (at > low && at < high) add(parameter_at(pieces, along_u, at));
    }
  }
  sort_distinct(list, same);
  PieceChords chords;
  std::vector<double> own, found;
  std::vector<ParameterPoint> points;
  // Coedges in the edge's direction come first, so the stops do not depend on the order of faces.
  for (const bool reversed : {false, true}) {
    for (const EdgeRun& run : of) {
      const std::span<const TrimPiece> pieces = runs.pieces(run);
      if (run.is_side || runs.coedge(run.face, pieces.front())->reversed != reversed) continue;
      const ChordStops stops = this->list(runs, run.face, pieces, own);
      found.clear(), points.clear();
      (void)chords.append(pieces, stops, limits(run.patch), points, found);
      for (const double t : found) list.push_back(runs.to_edge(run.face, pieces.front(), t));
    }
    sort_distinct(list, same);
  }
}

ChordStops EdgeStops::list(const EdgeRuns& runs, std::uint32_t face, std::span<const TrimPiece> pieces,
                           std::vector<double>& list) const {
  list.clear();
  const TrimPiece& piece = pieces.front();
  const Coedge* const coedge = runs.coedge(face, piece);
  if (!coedge) return {};
  const std::vector<double>& stops = stops_[runs.edges().faces[face].first_edge + coedge->edge];
  const auto [from, to] =
      std::minmax({runs.to_edge(face, piece, piece.range.from), runs.to_edge(face, piece, pieces.back().range.to)});
  auto stop = std::ranges::lower_bound(stops, from);
  if (stop != stops.begin()) --stop;
  for (; stop != stops.end() && (*stop <= to || stop == stops.begin() || *(stop - 1) <= to); ++stop)
    list.push_back(runs.to_curve(face, piece, *stop));
  if (list.size() > 1 && list.front() > list.back()) std::ranges::reverse(list);
  const Interval& range = (*runs.edges().faces[face].loops)[piece.loop].curves[piece.curve_index].domain();
  return {list, same_share * (range.to - range.from)};
}

}  // namespace tessera::inline abi_0_1
