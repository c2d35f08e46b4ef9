#include "plane/band_cuts.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Whether two segments cross within both.
bool cross(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c, const ParameterPoint& d) {
  const int to_c = orientation(a, b, c), to_d = orientation(a, b, d);
  if (to_c * to_d >= 0) return false;
  const int to_a = orientation(c, d, a), to_b = orientation(c, d, b);
  return to_a * to_b < 0;
}

/// Whether a segment runs through the inside of a cell.
bool crosses_cell(const ParameterPoint& a, const ParameterPoint& b, const GridLines& grid, std::uint32_t i,
                  std::uint32_t j) {
  const double u0 = grid.u(i), u1 = grid.u(i + 1), v0 = grid.v(j), v1 = grid.v(j + 1);
  if (std::max(a.u, b.u) <= u0 || std::min(a.u, b.u) >= u1) return false;
  if (std::max(a.v, b.v) <= v0 || std::min(a.v, b.v) >= v1) return false;
  int left = 0, right = 0;
  for (const ParameterPoint& corner : {ParameterPoint{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}) {
    const int side = orientation(a, b, corner);
    left += side > 0, right += side < 0;
  }
  return left > 0 && right > 0;
}

constexpr double share_met = 1e-9;  // far above rounding

}  // namespace

ParameterPoint BandCuts::point(std::uint32_t index) const {
  if (index < points_) return marks_->point(index);
  const GridLines& grid = marks_->grid();
  return grid.point(grid.place_of_vertex(vertices_[index - points_]));
}

GridPlace BandCuts::cell_of(std::uint32_t index) const {
  if (index < points_) return marks_->cell_of(index);
  const GridLines& grid = marks_->grid();
  const GridPlace place = grid.place_of_vertex(vertices_[index - points_]);
  return {std::min(place.i, grid.columns() - 1), std::min(place.j, grid.rows() - 1)};
}

BandCuts::PieceEnd BandCuts::end_at(std::uint32_t vertex) const {
  return {{corners_[vertex] != no_id ? corners_[vertex] : marks_->near_point(vertex), no_id}};
}

BandCuts::PieceEnd BandCuts::end_at(const Crossing& crossing, bool along_v) const {
  const PlaneSegment& chord = marks_->chords()[crossing.chord];
  const ParameterPoint &p = marks_->point(chord.start), &q = marks_->point(chord.end);
  const double share = along_v ? (crossing.at - p.v) / (q.v - p.v) : (crossing.at - p.u) / (q.u - p.u);
  if (share > 0.5) return {{chord.end, chord.start}};
  return {{chord.start, chord.end}};
}

void BandCuts::find(const ChordMarks& marks, std::size_t points, std::span<const CellUse> uses,
                    std::span<const std::uint32_t> corners, std::span<const std::uint32_t> vertices) {
  marks_ = &marks;
  points_ = points;
  uses_ = uses;
  corners_ = corners;
  vertices_ = vertices;
  cuts_.clear();
  const GridLines& grid = marks.grid();
  cuts_of_cells_.clear(grid.cell_count());
  for (std::uint32_t i = 0, cell = 0; i < grid.columns(); ++i) {
    for (std::uint32_t j = 0; j < grid.rows(); ++j, ++cell) {
      if (uses[cell] != CellUse::cut) continue;
      if (i > 0 && uses[grid.cell(i - 1, j)] == CellUse::cut) follow_side(i, j, true);
      if (j > 0 && uses[cell - 1] == CellUse::cut) follow_side(i, j, false);
    }
  }
}

// Goes along the side of a cell, from crossing to crossing, and cuts along each piece that lies inside.
void BandCuts::follow_side(std::uint32_t i, std::uint32_t j, bool along_v) {
  const GridLines& grid = marks_->grid();
  const std::uint32_t first = grid.vertex(i, j), last = along_v ? first + 1 : grid.vertex(i + 1, j);
  crossings_.clear();
  (along_v ? marks_->across_v() : marks_->across_u()).any(first, [&](std::uint32_t number) {
    const PlaneSegment& chord = marks_->chords()[number];
    const ParameterPoint &p = marks_->point(chord.start), &q = marks_->point(chord.end);
    const double at = along_v ? p.v + (grid.u(i) - p.u) * (q.v - p.v) / (q.u - p.u)
                              : p.u + (grid.v(j) - p.v) * (q.u - p.u) / (q.v - p.v);
    crossings_.push_back({at, number});
    return false;
  });
  std::ranges::sort(crossings_, {}, &Crossing::at);
  bool is_inside = along_v ? marks_->is_inside_after_v(first) : marks_->is_inside_after_u(first);
  PieceEnd from = end_at(first);
  for (const Crossing& crossing : crossings_) {
    const PieceEnd to = end_at(crossing, along_v);
    if (is_inside) cut(from, to);
    is_inside = !is_inside;
    from = to;
  }
  if (is_inside) cut(from, end_at(last));
}

void BandCuts::cut(const PieceEnd& a, const PieceEnd& b) {
  for (const auto& [from, to] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
    const std::uint32_t start = a.points[static_cast<std::size_t>(from)];
    const std::uint32_t end = b.points[static_cast<std::size_t>(to)];
    if (start != no_id && end != no_id && try_cut(start, end)) return;
  }
}

// Returns whether the cut is made or needed no more.
bool BandCuts::try_cut(std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  const ParameterPoint start = point(a), end = point(b);
  const GridPlace of_start = cell_of(a), of_end = cell_of(b);
  bool is_free = true;
  marks_->for_cells(start, of_start, end, of_end, share_met,
                    [&](std::uint32_t i, std::uint32_t j) { is_free = is_free && !is_blocked(start, end, i, j); });
  if (!is_free) return false;
  const std::uint32_t number = static_cast<std::uint32_t>(marks_->chords().size() + cuts_.size());
  cuts_.push_back({a, b});
  marks_->for_cells(start, of_start, end, of_end, share_met,
                    [&](std::uint32_t i, std::uint32_t j) { cuts_of_cells_.add(marks_->grid().cell(i, j), number); });
  return true;
}

bool BandCuts::is_blocked(const ParameterPoint& a, const ParameterPoint& b, std::uint32_t i, std::uint32_t j) const {
  const std::uint32_t cell = marks_->grid().cell(i, j);
  if (uses_[cell] == CellUse::whole) return crosses_cell(a, b, marks_->grid(), i, j);
  const auto blocks = [&](std::uint32_t number) {
    const PlaneSegment& other = segment(number);
    return cross(a, b, point(other.start), point(other.end));
  };
  return marks_->of_cells().any(cell, blocks) || cuts_of_cells_.any(cell, blocks);
}

}}  // namespace tessera::abi_0_1
