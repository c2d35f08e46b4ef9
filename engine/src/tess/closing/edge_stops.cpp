#include "tess/closing/edge_stops.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
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

void EdgeStops::find(const PatchSet::Impl& set, std::size_t edge,
                     FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
                     FunctionRef<const ChordLimits&(std::uint32_t patch)> limits, Workspace& workspace) {
  const std::span<const EdgeRun> runs = runs_->of(edge);
  const auto whole = [&](const EdgeRun& run) { return run.is_side ? segments(run.patch, run.side) : std::nullopt; };
  const auto is_whole = [&](const EdgeRun& run) { return whole(run).has_value(); };
  if (!runs_->meet(edge) || std::ranges::all_of(runs, is_whole)) return;
  const Interval& range = runs_->edges().edges[edge].range;
  const double same = same_share_ * (range.to - range.from);
  std::vector<double>& stops = stops_[edge];
  for (const EdgeRun& run : runs) {
    const std::span<const TrimPiece> pieces = runs_->pieces(run);
    const CurveAlongEdge curve = runs_->curve(run);
    stops.push_back(curve.to_edge(pieces.front().range.from));
    stops.push_back(curve.to_edge(pieces.back().range.to));
    if (const auto along = whole(run)) add_vertices(run, set.sources[run.patch].domain, *along, stops);
  }
  sort_distinct(stops, same);
  const auto divide_along = [&](bool reversed) {
    workspace.found.clear();
    for (const EdgeRun& run : runs)
      if (!is_whole(run) && runs_->curve(run).coedge->reversed == reversed) divide(run, limits(run.patch), workspace);
    return workspace.found.size();
  };
  const auto add_found = [&] {
    stops.insert(stops.end(), workspace.found.begin(), workspace.found.end());
    sort_distinct(stops, same);
  };
  // The direction that needs more stops comes first: they often do for the other one. This does not depend on the order
  // of faces.
  const std::size_t along = divide_along(false), against = divide_along(true);
  const bool first = against > along;
  if (!first && along > 0) divide_along(false);
  if (along + against > 0) add_found();
  if (divide_along(!first) > 0) add_found();
  for (const EdgeRun& run : runs)
    if (!run.is_side && !is_laid(run, same)) lay(run, limits(run.patch), workspace);
}

void EdgeStops::keep(EdgeStops& before, std::size_t edge) {
  stops_[edge] = before.stops_[edge];
  for (const EdgeRun& run : runs_->of(edge)) {
    const std::size_t k = runs_->index(run);
    chords_[k] = std::move(before.chords_[k]);
  }
}

void EdgeStops::add_vertices(const EdgeRun& run, const Domain& domain, const Segments& segments,
                             std::vector<double>& found) {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const CurveAlongEdge curve = runs_->curve(run);
  const bool along_u = runs_along_u(run.side);
  const auto [low, high] = ends_of(pieces, along_u);
  std::vector<double>& parameters = chords_[runs_->index(run)].parameters;
  for (int k = 0; k <= segments.rate(); ++k) {
    const double at = line_at(along_u ? domain.u0 : domain.v0, along_u ? domain.u1 : domain.v1, segments, k);
    if (!(at > low && at < high)) continue;
    parameters.push_back(parameter_at(pieces, along_u, at));
    found.push_back(curve.to_edge(parameters.back()));
  }
}

void EdgeStops::divide(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace) {
  if (run.is_side) return add_segments(run, limits, workspace.found);
  lay(run, limits, workspace);
  const CurveAlongEdge curve = runs_->curve(run);
  for (const double t : chords_[runs_->index(run)].parameters) workspace.found.push_back(curve.to_edge(t));
}

void EdgeStops::lay(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace) {
  LaidChords& chords = chords_[runs_->index(run)];
  chords.points.clear(), chords.parameters.clear();
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const ChordStops stops = list(run.face, pieces, workspace.listed);
  chords.sliver = workspace.layer.append(pieces, stops, limits, chords.points, chords.parameters);
}

bool EdgeStops::is_laid(const EdgeRun& run, double same) const {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const CurveAlongEdge curve = runs_->curve(run);
  const auto [from, to] =
      std::minmax({curve.to_edge(pieces.front().range.from), curve.to_edge(pieces.back().range.to)});
  const std::vector<double>& stops = stops_[run.edge];
  const auto inside = std::ranges::lower_bound(stops, to - same) - std::ranges::upper_bound(stops, from + same);
  return inside + 1 == std::ssize(chords_[runs_->index(run)].parameters);
}

const LaidChords* EdgeStops::laid(std::uint32_t face, std::uint32_t first, std::size_t count) const {
  const EdgeRun* const run = runs_->run_of(face, first, count);
  if (!run || chords_[runs_->index(*run)].points.empty()) return nullptr;
  return &chords_[runs_->index(*run)];
}

void EdgeStops::add_segments(const EdgeRun& run, const ChordLimits& limits, std::vector<double>& found) const {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const bool along_u = runs_along_u(run.side);
  const double longest = (along_u ? limits.box.u : limits.box.v) * (1 + 0x1p-40);
  const auto [low, high] = ends_of(pieces, along_u);
  const CurveAlongEdge curve = runs_->curve(run);
  std::vector<double> places = places_on_side(run);
  places.push_back(high);
  double before = low;
  for (const double place : places) {
    const int count = static_cast<int>(std::ceil((place - before) / longest));
    for (int k = 1; k < count; ++k)
      found.push_back(curve.to_edge(parameter_at(pieces, along_u, before + (place - before) * k / count)));
    before = place;
  }
}

std::vector<double> EdgeStops::places_on_side(const EdgeRun& run) const {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const bool along_u = runs_along_u(run.side);
  const auto [low, high] = ends_of(pieces, along_u);
  std::vector<double> own, places;
  const ChordStops stops = list(run.face, pieces, own);
  for (const double t : stops.at) {
    if (t <= pieces.front().range.from + stops.same || t >= pieces.back().range.to - stops.same) continue;
    const double place = along_of(point_at(pieces, t), along_u);
    if (place > low && place < high) places.push_back(place);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void EdgeStops::put_on_side(std::uint32_t patch, Side side, std::vector<SidePoint>& points) const {
  const bool is_above = side == Side::u0 || side == Side::v0;
  runs_->for_runs_on(patch, side, [&](const EdgeRun& run) {
    if (stops_[run.edge].empty()) return;
    const auto [low, high] = ends_of(runs_->pieces(run), runs_along_u(side));
    const auto first = std::ranges::upper_bound(points, low, {}, &SidePoint::at);
    if (first == points.begin()) return;
    const SidePoint from = *(first - 1);
    // A run without length ends at the point before `first`, so the search for its end begins there.
    const auto last = std::ranges::lower_bound(first, points.end(), high, {}, &SidePoint::at);
    const auto is_other = [&](const SidePoint& of) { return of.below != from.below || of.above != from.above; };
    if ((is_above ? from.below : from.above) || std::any_of(first, last, is_other)) return;
    std::vector<SidePoint> inside;
    for (const double place : places_on_side(run)) inside.push_back({place, from.below, from.above});
    points.insert(points.erase(first, last), inside.begin(), inside.end());
  });
}

ChordStops EdgeStops::list(std::uint32_t face, std::span<const TrimPiece> pieces, std::vector<double>& list) const {
  list.clear();
  const CurveAlongEdge curve = runs_->curve(face, pieces.front());
  if (!curve.coedge) return {};
  const std::vector<double>& stops = stops_[runs_->edges().faces[face].first_edge + curve.coedge->edge];
  const auto [from, to] =
      std::minmax({curve.to_edge(pieces.front().range.from), curve.to_edge(pieces.back().range.to)});
  auto stop = std::ranges::lower_bound(stops, from);
  if (stop != stops.begin()) --stop;
  for (; stop != stops.end() && (*stop <= to || stop == stops.begin() || *(stop - 1) <= to); ++stop)
    list.push_back(curve.to_curve(*stop));
  if (list.size() > 1 && list.front() > list.back()) std::ranges::reverse(list);
  const Interval& range = curve.curve->domain();
  return {list, same_share_ * (range.to - range.from)};
}

}}  // namespace tessera::abi_0_1
