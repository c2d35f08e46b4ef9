#include "tess/trimmed/trimmed_patch.h"

#include <algorithm>

namespace tessera::inline abi_0_1 {
namespace {

void divide(std::vector<double>& lines, double from, double to, Segments along) {
  lines.clear();
  for (int k = 0; k <= along.rate(); ++k) lines.push_back(line_at(from, to, along, k));
}

/// The length of a grid's cell: of the shortest one.
double shortest(const std::vector<double>& lines) {
  double least = lines.back() - lines.front();
  for (std::size_t k = 1; k < lines.size(); ++k) least = std::min(least, lines[k] - lines[k - 1]);
  return least;
}

}  // namespace

void PatchCutter::begin(const TrimmedPatch& patch) {
  patch_ = patch;
  points_.clear();
  chords_.clear();
  sliver_ = 0;
  divide(lines_u_, patch.domain.u0, patch.domain.u1, patch.segments.u);
  divide(lines_v_, patch.domain.v0, patch.domain.v1, patch.segments.v);
  grid_ = {lines_u_, lines_v_};
  const double width = patch.domain.u1 - patch.domain.u0, height = patch.domain.v1 - patch.domain.v0;
  limits_ = {patch.sliver,
             {patch.chord_share * shortest(lines_u_), patch.chord_share * shortest(lines_v_)},
             {patch.speed.u / width, patch.speed.v / height},
             patch.bend};
}

std::uint32_t PatchCutter::add_point(const ParameterPoint& point) {
  points_.push_back(point);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

std::size_t PatchCutter::add_side(std::span<const SidePoint> side, double across, bool runs_along_u, bool above) {
  const auto at = [&](double along) {
    return runs_along_u ? ParameterPoint{along, across} : ParameterPoint{across, along};
  };
  const std::size_t before = chords_.size();
  std::uint32_t last = no_place;
  for (std::size_t k = 0; k + 1 < side.size(); ++k) {
    if (!(above ? side[k].above : side[k].below)) {
      last = no_place;
      continue;
    }
    if (last == no_place) last = add_point(at(side[k].at));
    const std::uint32_t next = add_point(at(side[k + 1].at));
    chords_.push_back({last, next});
    last = next;
  }
  return chords_.size() - before;
}

// Neighbours need the ends on the patch's sides. Chords that had to become finer keep all ends, as they may cross.
bool PatchCutter::continues(const ParameterPoint& start, const TrimPiece& before, const TrimPiece& next) const {
  const ParameterPoint &at = next.start(), &to = next.end();
  const auto is_monotone = [](double x, double y, double z) { return (x <= y && y <= z) || (x >= y && y >= z); };
  const Domain& d = patch_.domain;
  return patch_.chord_share == 1 && before.end() == at && is_monotone(start.u, at.u, to.u) &&
         is_monotone(start.v, at.v, to.v) && at.u != d.u0 && at.u != d.u1 && at.v != d.v0 && at.v != d.v1;
}

std::size_t PatchCutter::add_pieces(std::span<const TrimPiece> pieces, std::span<const std::uint32_t> indices) {
  const std::size_t before = chords_.size();
  for (std::size_t k = 0; k < indices.size();) {
    const std::size_t first = indices[k];
    std::size_t count = 1;
    while (k + count < indices.size() && indices[k + count] == first + count &&
           continues(pieces[first].start(), pieces[first + count - 1], pieces[first + count]))
      ++count;
    k += count;
    std::uint32_t last = add_point(pieces[first].start());
    sliver_ = std::max(sliver_, chords_of_pieces_.append(pieces.subspan(first, count), limits_, points_));
    for (; last + 1 < points_.size(); ++last) chords_.push_back({last, last + 1});
  }
  return chords_.size() - before;
}

bool PatchCutter::cut_crossing() { return crossings_.divide(points_, chords_) && cut(); }

bool PatchCutter::cut() { return cells_.run(grid_, points_, chords_); }

ParameterPoint PatchCutter::point(std::uint32_t vertex) const {
  if (vertex < points_.size()) return points_[vertex];
  return grid_.point(grid_.place_of_vertex(cells_.grid_vertices()[vertex - points_.size()]));
}

ParameterPoint PatchCutter::local(std::uint32_t vertex) const {
  const ParameterPoint at = point(vertex);
  return {patch_.domain.local_u(at.u), patch_.domain.local_v(at.v)};
}

}  // namespace tessera::inline abi_0_1
