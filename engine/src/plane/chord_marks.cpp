#include "plane/chord_marks.h"

#include <algorithm>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Sets one over the smaller cell beside each line.
void set_scales(std::vector<double>& scales, std::uint32_t cells, auto line) {
  scales.resize(cells + 1);
  for (std::uint32_t k = 0; k <= cells; ++k) {
    const double before = line(std::max(k, 1u)) - line(std::max(k, 1u) - 1);
    const double after = line(std::min(k + 1, cells)) - line(std::min(k + 1, cells) - 1);
    scales[k] = 1 / std::min(before, after);
  }
}

/// Turns marks where the side changes into sides, along v.
void accumulate(std::vector<std::uint8_t>& changes, std::uint32_t lists, std::uint32_t length) {
  for (std::uint32_t i = 0, k = 0; i < lists; ++i) {
    std::uint8_t side = 0;
    for (std::uint32_t j = 0; j < length; ++j, ++k) changes[k] = side ^= changes[k];
  }
}

}  // namespace

void ChordMarks::clear(std::size_t points) {
  const std::size_t cells = grid_.cell_count(), vertices = grid_.vertex_count();
  cells_of_points_.resize(points);
  vertices_of_points_.resize(points);
  chords_.clear();
  met_.assign(cells, 0);
  cells_inside_.assign(cells, 0);
  inside_along_v_.assign(vertices, 0);
  inside_along_u_.assign(vertices, 0);
  on_line_u_.assign(vertices, 0);
  on_line_v_.assign(vertices, 0);
  points_at_.assign(vertices, no_id);
  near_points_.assign(vertices, no_id);
  near_squares_.assign(vertices, near_share * near_share);
  of_cells_.clear(cells);
  across_u_.clear(vertices);
  across_v_.clear(vertices);
  set_scales(scale_u_, grid_.columns(), [&](std::uint32_t i) { return grid_.u(i); });
  set_scales(scale_v_, grid_.rows(), [&](std::uint32_t j) { return grid_.v(j); });
}

void ChordMarks::find_points() {
  GridPlace cell;
  for (std::uint32_t k = 0; k < points_.size(); ++k) {
    const ParameterPoint& at = points_[k];
    cell = grid_.find(at, cell);
    cells_of_points_[k] = cell;
    vertices_of_points_[k] = no_id;
    const std::uint32_t i = at.u == grid_.u(cell.i + 1) ? cell.i + 1 : cell.i;
    const std::uint32_t j = at.v == grid_.v(cell.j + 1) ? cell.j + 1 : cell.j;
    if (at.u != grid_.u(i) || at.v != grid_.v(j)) continue;
    const std::uint32_t vertex = vertices_of_points_[k] = grid_.vertex(i, j);
    if (points_at_[vertex] == no_id) points_at_[vertex] = k;
  }
}

void ChordMarks::set(const GridLines& grid, std::span<const ParameterPoint> points,
                     std::span<const PlaneSegment> chords) {
  grid_ = grid;
  points_ = points;
  clear(points.size());
  find_points();
  for (const PlaneSegment& chord : chords) {
    const ParameterPoint &p = points[chord.start], &q = points[chord.end];
    if (p == q) continue;
    const bool is_side = mark_side(chord);
    if (!is_side) {
      const std::uint32_t number = static_cast<std::uint32_t>(chords_.size());
      chords_.push_back(chord);
      for_cells(p, cell_of(chord.start), q, cell_of(chord.end), margin, [&](std::uint32_t i, std::uint32_t j) {
        met_[grid_.cell(i, j)] = 1;
        of_cells_.add(grid_.cell(i, j), number);
      });
      mark_near(chord);
    }
    cross_u(chord, is_side);
    cross_v(chord, is_side);
  }
  accumulate(cells_inside_, grid_.columns(), grid_.rows());
  accumulate(inside_along_v_, grid_.columns() + 1, grid_.rows() + 1);
  for (std::size_t vertex = grid_.rows() + 1; vertex < inside_along_u_.size(); ++vertex)
    inside_along_u_[vertex] ^= inside_along_u_[vertex - grid_.rows() - 1];
}

// A chord that is a side of cells cuts none of them.
bool ChordMarks::mark_side(const PlaneSegment& chord) {
  std::uint32_t first = vertex_at(chord.start), last = vertex_at(chord.end);
  if (first == no_id || last == no_id) return false;
  if (first > last) std::swap(first, last);
  const GridPlace a = grid_.place_of_vertex(first), b = grid_.place_of_vertex(last);
  if (a.i == b.i && a.j + 1 == b.j) return on_line_v_[first] ^= 1, true;
  if (a.i + 1 == b.i && a.j == b.j) return on_line_u_[first] ^= 1, true;
  return false;
}

void ChordMarks::mark_near(const PlaneSegment& chord) {
  const ParameterPoint &p = points_[chord.start], &q = points_[chord.end];
  const GridPlace a = cell_of(chord.start), b = cell_of(chord.end);
  for (std::uint32_t i = std::min(a.i, b.i); i <= std::max(a.i, b.i) + 1; ++i) {
    const double along_u = (q.u - p.u) * scale_u_[i], to_u = (grid_.u(i) - p.u) * scale_u_[i];
    for (std::uint32_t j = std::min(a.j, b.j); j <= std::max(a.j, b.j) + 1; ++j) {
      const double along_v = (q.v - p.v) * scale_v_[j], to_v = (grid_.v(j) - p.v) * scale_v_[j];
      const double share = (to_u * along_u + to_v * along_v) / (along_u * along_u + along_v * along_v);
      const double at = std::min(std::max(share, 0.0), 1.0);
      const double off_u = to_u - at * along_u, off_v = to_v - at * along_v;
      const double square = off_u * off_u + off_v * off_v;
      const std::uint32_t vertex = grid_.vertex(i, j);
      if (!(square < near_squares_[vertex])) continue;
      near_squares_[vertex] = square;
      near_points_[vertex] = at < 0.5 ? chord.start : chord.end;
    }
  }
}

// Counts chords along lines u = const: through the cells' middles for cells, through vertices for these. Chords of
// which a point lies on the line count by half-open intervals.
void ChordMarks::cross_u(const PlaneSegment& chord, bool is_side) {
  const ParameterPoint &p = points_[chord.start], &q = points_[chord.end];
  const GridPlace a = cell_of(chord.start), b = cell_of(chord.end);
  const double slope = (q.v - p.v) / (q.u - p.u);
  const auto row_at = [&](double u, double& v) {
    v = p.v + (u - p.u) * slope;
    return grid_.find_row(v, a.j);
  };
  double v = 0;
  for (std::uint32_t i = std::min(a.i, b.i); i <= std::max(a.i, b.i) + 1; ++i) {
    if (const double u = grid_.u(i); (p.u <= u) != (q.u <= u)) {
      const std::uint32_t row = row_at(u, v);
      inside_along_v_[grid_.vertex(i, row + 1)] ^= 1;
      if (!is_side) across_v_.add(grid_.vertex(i, row), static_cast<std::uint32_t>(chords_.size() - 1));
    }
    if (i == grid_.columns()) break;
    const double middle = (grid_.u(i) + grid_.u(i + 1)) / 2;
    if ((p.u <= middle) == (q.u <= middle)) continue;
    std::uint32_t row = row_at(middle, v);
    if (v > (grid_.v(row) + grid_.v(row + 1)) / 2) ++row;
    if (row < grid_.rows()) cells_inside_[grid_.cell(i, row)] ^= 1;
  }
}

void ChordMarks::cross_v(const PlaneSegment& chord, bool is_side) {
  const ParameterPoint &p = points_[chord.start], &q = points_[chord.end];
  const GridPlace a = cell_of(chord.start), b = cell_of(chord.end);
  const double slope = (q.u - p.u) / (q.v - p.v);
  for (std::uint32_t j = std::min(a.j, b.j); j <= std::max(a.j, b.j) + 1; ++j) {
    const double v = grid_.v(j);
    if ((p.v <= v) == (q.v <= v)) continue;
    const std::uint32_t column = grid_.find_column(p.u + (v - p.v) * slope, a.i);
    inside_along_u_[grid_.vertex(column + 1, j)] ^= 1;
    if (!is_side) across_u_.add(grid_.vertex(column, j), static_cast<std::uint32_t>(chords_.size() - 1));
  }
}

}}  // namespace tessera::abi_0_1
