#include "tess/trimmed/trimmed_patch.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

void divide(std::vector<double>& lines, double from, double to, Segments along) {
  lines.clear();
  for (int k = 0; k <= along.rate(); ++k) lines.push_back(line_at(from, to, along, k));
}

/// The length of a grid's cell: of the shortest one.
double shortest(double from, double to, Segments along) {
  double least = to - from, before = from;
  for (int k = 1; k <= along.rate(); ++k) {
    const double line = line_at(from, to, along, k);
    least = std::min(least, line - before);
    before = line;
  }
  return least;
}

}  // namespace

ChordLimits chord_limits(const TrimmedPatch& patch) {
  const Domain& d = patch.domain;
  return {patch.sliver,
          {patch.chord_share * shortest(d.u0, d.u1, patch.segments.u),
           patch.chord_share * shortest(d.v0, d.v1, patch.segments.v)},
          patch.speed.over(d.u1 - d.u0, d.v1 - d.v0),
          patch.bend,
          patch.cancel};
}

void PatchCutter::begin(const TrimmedPatch& patch) {
  patch_ = patch;
  points_.clear();
  chords_.clear(), loop_chords_.clear(), marks_.clear();
  sliver_ = 0;
  divide(lines_u_, patch.domain.u0, patch.domain.u1, patch.segments.u);
  divide(lines_v_, patch.domain.v0, patch.domain.v1, patch.segments.v);
  grid_ = {lines_u_, lines_v_};
  limits_ = chord_limits(patch);
}

std::uint32_t PatchCutter::add_point(const ParameterPoint& point) {
  points_.push_back(point);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

std::size_t PatchCutter::add_side(std::span<const SidePoint> points, Side side) {
  const auto at = [&](double along) { return point_beside(side, along, line_of(side, patch_.domain)); };
  const std::size_t before = chords_.size();
  std::uint32_t last = no_id;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    if (!(is_far(side) ? points[k].below : points[k].above)) {
      last = no_id;
      continue;
    }
    if (last == no_id) last = add_point(at(points[k].at));
    const std::uint32_t next = add_point(at(points[k + 1].at));
    chords_.push_back({last, next});
    marks_.push_back(no_id);
    last = next;
  }
  return chords_.size() - before;
}

// Neighbours need the ends on the patch's sides. Chords that had to become finer keep all ends, as they may cross.
bool PatchCutter::continues(const ParameterPoint& start, const TrimPiece& before, const TrimPiece& next) const {
  const ParameterPoint &at = next.start(), &to = next.end();
  const auto is_monotone = [](double x, double y, double z) { return (x <= y && y <= z) || (x >= y && y >= z); };
  const Domain& d = patch_.domain;
  if (patch_.stations && (before.loop != next.loop || before.curve_index != next.curve_index)) return false;
  const bool has_turned = !is_monotone(start.u, at.u, to.u) || !is_monotone(start.v, at.v, to.v);
  return patch_.chord_share == 1 && before.end() == at && (patch_.stations || !has_turned) && at.u != d.u0 &&
         at.u != d.u1 && at.v != d.v0 && at.v != d.v1;
}

std::size_t PatchCutter::add_pieces(std::span<const TrimPiece> pieces, std::span<const std::uint32_t> indices) {
  std::size_t chord_count = 0;
  for (std::size_t k = 0; k < indices.size();) {
    const std::size_t first = indices[k];
    std::size_t count = 1;
    while (k + count < indices.size() && indices[k + count] == first + count &&
           continues(pieces[first].start(), pieces[first + count - 1], pieces[first + count]))
      ++count;
    k += count;
    std::uint32_t last = add_point(pieces[first].start());
    parameters_.assign(1, pieces[first].range.from);
    const std::span<const TrimPiece> chain = pieces.subspan(first, count);
    sliver_ = std::max(sliver_, add_chords(chain, static_cast<std::uint32_t>(first)));
    for (std::size_t n = 0; last + 1 < points_.size(); ++last, ++n) {
      chord_count += !(points_[last] == points_[last + 1]);
      chords_.push_back({last, last + 1});
      marks_.push_back(static_cast<std::uint32_t>(loop_chords_.size()));
      loop_chords_.push_back({static_cast<std::uint32_t>(first), last, last + 1, parameters_[n], parameters_[n + 1]});
    }
  }
  return chord_count;
}

double PatchCutter::add_chords(std::span<const TrimPiece> chain, std::uint32_t first) {
  if (!patch_.stations) return chords_of_pieces_.append(chain, limits_, points_, parameters_);
  const RunStations* const run = patch_.stations->run_of(first);
  if (!run) return chords_of_pieces_.append(chain, CurveStations(), limits_, points_, parameters_);
  const bool is_whole = run->first == first && run->end - run->first == chain.size();
  if (!is_whole || run->chords.points.empty() || patch_.chord_share != 1)
    return chords_of_pieces_.append(chain, {run->at, run->same}, limits_, points_, parameters_);
  points_.insert(points_.end(), run->chords.points.begin(), run->chords.points.end());
  parameters_.insert(parameters_.end(), run->chords.parameters.begin(), run->chords.parameters.end());
  return run->chords.sliver;
}

bool PatchCutter::cut_crossing() { return crossings_.divide(points_, chords_, marks_) && cut(); }

double PatchCutter::parameter(const LoopChord& chord, std::uint32_t point) const {
  if (point == chord.start) return chord.from;
  const ParameterPoint a = points_[chord.start], b = points_[chord.end];
  if (point == chord.end) return a == b ? chord.from : chord.to;
  const ParameterPoint at = this->point(point);
  if (at == a) return chord.from;
  if (at == b) return chord.to;
  const ParameterPoint all = distance(a, b), part = distance(a, at);
  return chord.from + (chord.to - chord.from) * (all.u > all.v ? part.u / all.u : part.v / all.v);
}

bool PatchCutter::cut() { return cells_.run(grid_, points_, chords_); }

ParameterPoint PatchCutter::point(std::uint32_t vertex) const {
  if (vertex < points_.size()) return points_[vertex];
  return grid_.point(grid_.place_of_vertex(cells_.grid_vertices()[vertex - points_.size()]));
}

ParameterPoint PatchCutter::local(std::uint32_t vertex) const {
  const ParameterPoint at = point(vertex);
  return {patch_.domain.local_u(at.u), patch_.domain.local_v(at.v)};
}

}}  // namespace tessera::abi_0_1
