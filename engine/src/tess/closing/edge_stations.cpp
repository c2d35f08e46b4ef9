#include "tess/closing/edge_stations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Sorts a list that consists of a few sorted parts, each growing or falling.
void sort_parts(std::vector<double>& list, std::vector<double>& room) {
  constexpr int max_merges = 8;
  auto middle = list.begin();  // the end of the sorted part
  for (int merges = 0; middle != list.end(); ++merges) {
    if (merges > max_merges) {
      std::ranges::sort(list);
      return;
    }
    auto end = std::is_sorted_until(middle, list.end());
    if (end == middle + 1 && end != list.end()) {
      end = std::is_sorted_until(middle, list.end(), std::greater<>());
      std::reverse(middle, end);
    }
    if (middle != list.begin() && *middle < *(middle - 1)) {
      room.assign(list.begin(), middle);  // so that no element is overwritten before it is read
      std::merge(room.begin(), room.end(), middle, end, list.begin());
    }
    middle = end;
  }
}

/// Sorts parameters, and keeps the first of those that count as one.
void sort_distinct(std::vector<double>& list, double same, std::vector<double>& room) {
  sort_parts(list, room);
  std::size_t count = 0;
  for (const double s : list)
    if (count == 0 || s - list[count - 1] > same) list[count++] = s;
  list.resize(count);
}

}  // namespace

void EdgeStations::find(const PatchSet::Impl& set, std::size_t edge,
                        FunctionRef<std::optional<Segments>(std::uint32_t patch, Side side)> segments,
                        FunctionRef<const ChordLimits&(std::uint32_t patch)> limits, Workspace& workspace) {
  const std::span<const EdgeRun> runs = runs_->of(edge);
  const auto whole = [&](const EdgeRun& run) { return run.is_side ? segments(run.patch, run.side) : std::nullopt; };
  const auto is_whole = [&](const EdgeRun& run) { return whole(run).has_value(); };
  if (!runs_->meet(edge) || std::ranges::all_of(runs, is_whole)) return;
  const Interval& range = runs_->edges().edges[edge].range;
  const double same = same_share_ * (range.to - range.from);
  std::vector<double>& stations = stations_[edge];
  for (const EdgeRun& run : runs) add_own(run, set.sources[run.patch].domain, whole(run), stations);
  sort_distinct(stations, same, workspace.room);
  const auto divide_along = [&](bool reversed) {
    workspace.found.clear();
    for (const EdgeRun& run : runs)
      if (!is_whole(run) && runs_->curve(run).coedge->reversed == reversed) divide(run, limits(run.patch), workspace);
    return workspace.found.size();
  };
  const auto add_found = [&] {
    stations.insert(stations.end(), workspace.found.begin(), workspace.found.end());
    sort_distinct(stations, same, workspace.room);
  };
  // The direction that needs more stations comes first: they often do for the other one. This does not depend on the
  // order of faces.
  const std::size_t along = divide_along(false);
  workspace.found_along.swap(workspace.found);
  const std::size_t against = divide_along(true);
  const bool first = against > along;
  if (!first) workspace.found.swap(workspace.found_along);
  if (along + against > 0) add_found();
  if (divide_along(!first) > 0) add_found();
  for (const EdgeRun& run : runs) {
    if (is_whole(run)) continue;
    if (run.is_side)
      list_along(run);
    else if (is_laid(run, same))
      list(run);
    else
      lay(run, limits(run.patch), workspace);
  }
}

void EdgeStations::keep(EdgeStations& before, std::size_t edge) {
  stations_[edge] = before.stations_[edge];
  for (const EdgeRun& run : runs_->of(edge)) of(run) = std::move(before.of(run));
}

void EdgeStations::add_own(const EdgeRun& run, const Domain& domain, const std::optional<Segments>& segments,
                           std::vector<double>& found) {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const CurveAlongEdge curve = runs_->curve(run);
  const double from = curve.to_edge(pieces.front().range.from), to = curve.to_edge(pieces.back().range.to);
  const bool is_backward =
      segments && along_side(run.side, pieces.front().start()) > along_side(run.side, pieces.back().end());
  found.push_back(is_backward ? to : from);
  if (segments) {
    const auto [low, high] = ends_along(run.side, pieces);
    const auto [begin, end] = range_along(run.side, domain);
    std::vector<double>& parameters = of(run).chords.parameters;
    parameters.reserve(static_cast<std::size_t>(segments->rate()) + 1);
    for (int k = 0; k <= segments->rate(); ++k) {
      const double at = line_at(begin, end, *segments, k);
      if (!(at > low && at < high)) continue;
      parameters.push_back(parameter_at(pieces, run.side, at));
      found.push_back(curve.to_edge(parameters.back()));
    }
  }
  found.push_back(is_backward ? from : to);
}

void EdgeStations::divide(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace) {
  if (run.is_side) return add_segments(run, limits, workspace.found);
  lay(run, limits, workspace);
  const CurveAlongEdge curve = runs_->curve(run);
  for (const double t : of(run).chords.parameters) workspace.found.push_back(curve.to_edge(t));
}

void EdgeStations::lay(const EdgeRun& run, const ChordLimits& limits, Workspace& workspace) {
  list(run);
  RunStations& stations = of(run);
  LaidChords& chords = stations.chords;
  chords.points.clear(), chords.parameters.clear();
  const std::size_t least = std::max<std::size_t>(stations.at.size(), 8);
  chords.points.reserve(least), chords.parameters.reserve(least);
  chords.sliver = workspace.layer.append(runs_->pieces(run), {stations.at, stations.same}, limits, chords.points,
                                         chords.parameters);
}

bool EdgeStations::is_laid(const EdgeRun& run, double same) const {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const CurveAlongEdge curve = runs_->curve(run);
  const auto [from, to] =
      std::minmax({curve.to_edge(pieces.front().range.from), curve.to_edge(pieces.back().range.to)});
  const std::vector<double>& stations = stations_[run.edge];
  const auto inside = std::ranges::lower_bound(stations, to - same) - std::ranges::upper_bound(stations, from + same);
  return inside + 1 == std::ssize(of_runs_[runs_->index(run)].chords.parameters);
}

void EdgeStations::add_segments(const EdgeRun& run, const ChordLimits& limits, std::vector<double>& found) {
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const double longest = along_side(run.side, limits.box) * (1 + 0x1p-40);
  const auto [low, high] = ends_along(run.side, pieces);
  const CurveAlongEdge curve = runs_->curve(run);
  list_along(run);
  std::vector<double> places = of(run).along;
  places.push_back(high);
  double before = low;
  for (const double place : places) {
    const int count = static_cast<int>(std::ceil((place - before) / longest));
    for (int k = 1; k < count; ++k)
      found.push_back(curve.to_edge(parameter_at(pieces, run.side, before + (place - before) * k / count)));
    before = place;
  }
}

void EdgeStations::list(const EdgeRun& run) {
  RunStations& of_run = of(run);
  of_run.first = run.first, of_run.end = run.end;
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const CurveAlongEdge curve = runs_->curve(run);
  const Interval& range = curve.curve->domain();
  of_run.same = same_share_ * (range.to - range.from);
  const std::vector<double>& stations = stations_[run.edge];
  const auto [from, to] =
      std::minmax({curve.to_edge(pieces.front().range.from), curve.to_edge(pieces.back().range.to)});
  auto station = std::ranges::lower_bound(stations, from);
  if (station != stations.begin()) --station;
  auto end = std::ranges::upper_bound(station, stations.end(), to);
  if (end != stations.end()) ++end;
  of_run.at.resize(static_cast<std::size_t>(end - station));
  std::transform(station, end, of_run.at.begin(), [&](double s) { return curve.to_curve(s); });
  if (of_run.at.size() > 1 && of_run.at.front() > of_run.at.back()) std::ranges::reverse(of_run.at);
}

void EdgeStations::list_along(const EdgeRun& run) {
  list(run);
  RunStations& of_run = of(run);
  const std::span<const TrimPiece> pieces = runs_->pieces(run);
  const auto [low, high] = ends_along(run.side, pieces);
  of_run.side = run.side, of_run.low = low, of_run.high = high;
  of_run.along.clear();
  for (const double t : of_run.at) {
    if (t <= pieces.front().range.from + of_run.same || t >= pieces.back().range.to - of_run.same) continue;
    const ParameterPoint at = point_at(pieces, t);
    const double place = along_side(run.side, at);
    if (place > low && place < high) of_run.along.push_back(place);
  }
  std::ranges::sort(of_run.along);
  of_run.along.erase(std::unique(of_run.along.begin(), of_run.along.end()), of_run.along.end());
}

PatchStations EdgeStations::of(std::uint32_t patch) const {
  PatchStations made;
  runs_->for_runs_of(patch, [&](const EdgeRun& run) {
    if (!stations_[run.edge].empty())
      (run.is_side ? made.on_sides : made.within).push_back(&of_runs_[runs_->index(run)]);
  });
  std::ranges::sort(made.within, {}, &RunStations::first);
  return made;
}

}}  // namespace tessera::abi_0_1
