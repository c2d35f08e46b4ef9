#include "tess/closing/edge_stops.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// The places along a side at which pieces end, the lesser one first.
std::pair<double, double> ends_of(std::span<const TrimPiece> pieces, bool along_u) {
  return std::minmax({along_of(pieces.front().start(), along_u), along_of(pieces.back().end(), along_u)});
}

}  // namespace

void EdgeStops::find(const PatchSet::Impl& set, const EdgeRuns& runs, std::size_t edge,
                     FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
                     FunctionRef<ChordLimits(std::uint32_t patch)> limits) {
  const std::span<const EdgeRun> of = runs.of(edge);
  std::vector<double>& list = stops_[edge];
  list.clear();
  const auto whole = [&](const EdgeRun& run) { return run.is_side ? segments(run.patch, run.side) : std::nullopt; };
  if (!runs.meet(edge) || std::ranges::all_of(of, [&](const EdgeRun& run) { return whole(run).has_value(); })) return;
  const Interval& range = runs.edges().edges[edge].range;
  const double same = same_share * (range.to - range.from);
  for (const EdgeRun& run : of) {
    const std::span<const TrimPiece> pieces = runs.pieces(run);
    const auto add = [&](double t) { list.push_back(runs.to_edge(run.face, pieces.front(), t)); };
    add(pieces.front().range.from);
    add(pieces.back().range.to);
    const std::optional<Segments> along = whole(run);
    if (!along) continue;
    const bool along_u = runs_along_u(run.side);
    const Domain& domain = set.sources[run.patch].domain;
    const auto [low, high] = ends_of(pieces, along_u);
    for (int k = 0; k <= along->rate(); ++k) {
      const double at = line_at(along_u ? domain.u0 : domain.v0, along_u ? domain.u1 : domain.v1, *along, k);
      if (at > low && at < high) add(parameter_at(pieces, along_u, at));
    }
  }
  sort_distinct(list, same);
  std::vector<double> found;
  // Coedges in the edge's direction come first, so the stops do not depend on the order of faces.
  for (const bool reversed : {false, true}) {
    found.clear();
    for (const EdgeRun& run : of) {
      if (whole(run) || runs.coedge(run.face, runs.pieces(run).front())->reversed != reversed) continue;
      run.is_side ? add_segments(runs, run, limits(run.patch), found) : add_chords(runs, run, limits(run.patch), found);
    }
    list.insert(list.end(), found.begin(), found.end());
    sort_distinct(list, same);
  }
}

void EdgeStops::add_chords(const EdgeRuns& runs, const EdgeRun& run, const ChordLimits& limits,
                           std::vector<double>& found) const {
  const std::span<const TrimPiece> pieces = runs.pieces(run);
  PieceChords chords;
  std::vector<double> own, ends;
  std::vector<ParameterPoint> points;
  (void)chords.append(pieces, list(runs, run.face, pieces, own), limits, points, ends);
  for (const double t : ends) found.push_back(runs.to_edge(run.face, pieces.front(), t));
}

void EdgeStops::add_segments(const EdgeRuns& runs, const EdgeRun& run, const ChordLimits& limits,
                             std::vector<double>& found) const {
  const std::span<const TrimPiece> pieces = runs.pieces(run);
  const bool along_u = runs_along_u(run.side);
  const double longest = (along_u ? limits.box.u : limits.box.v) * (1 + 0x1p-40);
  const auto [low, high] = ends_of(pieces, along_u);
  std::vector<double> places = places_on_side(runs, run);
  places.push_back(high);
  double before = low;
  for (const double place : places) {
    const int count = static_cast<int>(std::ceil((place - before) / longest));
    for (int k = 1; k < count; ++k) {
      const double t = parameter_at(pieces, along_u, before + (place - before) * k / count);
      found.push_back(runs.to_edge(run.face, pieces.front(), t));
    }
    before = place;
  }
}

std::vector<double> EdgeStops::places_on_side(const EdgeRuns& runs, const EdgeRun& run) const {
  const std::span<const TrimPiece> pieces = runs.pieces(run);
  const bool along_u = runs_along_u(run.side);
  const auto [low, high] = ends_of(pieces, along_u);
  std::vector<double> own, places;
  const ChordStops stops = list(runs, run.face, pieces, own);
  for (const double t : stops.at) {
    if (t <= pieces.front().range.from + stops.same || t >= pieces.back().range.to - stops.same) continue;
    const double place = along_of(point_at(pieces, t), along_u);
    if (place > low && place < high) places.push_back(place);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void EdgeStops::put_on_side(const EdgeRuns& runs, std::uint32_t patch, Side side,
                            std::vector<SidePoint>& points) const {
  const bool is_above = side == Side::u0 || side == Side::v0;
  runs.for_runs_on(patch, side, [&](const EdgeRun& run) {
    if (stops_[run.edge].empty()) return;
    const auto [low, high] = ends_of(runs.pieces(run), runs_along_u(side));
    const auto first = std::ranges::upper_bound(points, low, {}, &SidePoint::at);
    if (first == points.begin()) return;
    const SidePoint from = *(first - 1);
    const auto last = std::ranges::lower_bound(points, high, {}, &SidePoint::at);
    const auto is_other = [&](const SidePoint& of) { return of.below != from.below || of.above != from.above; };
    if ((is_above ? from.below : from.above) || std::any_of(first, last, is_other)) return;
    std::vector<SidePoint> inside;
    for (const double place : places_on_side(runs, run)) inside.push_back({place, from.below, from.above});
    points.insert(points.erase(first, last), inside.begin(), inside.end());
  });
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
