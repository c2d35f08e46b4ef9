#include "plane/cut_cells.h"

namespace tessera { inline namespace abi_0_1 {

bool CutCells::run(const GridLines& grid, std::span<const ParameterPoint> points,
                   std::span<const PlaneSegment> chords) {
  points_ = points.size();
  marks_.set(grid, points, chords);
  choose_uses();
  number_vertices();
  cuts_.find(marks_, points_, uses_, corners_, vertices_);
  add_borders();
  sweep_points_.assign(points.begin(), points.end());
  for (const std::uint32_t vertex : std::span(vertices_).first(band_vertices_))
    sweep_points_.push_back(grid.point(grid.place_of_vertex(vertex)));
  return triangles_.run(sweep_points_, borders_, cuts_.cuts());
}

void CutCells::choose_uses() {
  const GridLines& grid = marks_.grid();
  uses_.resize(grid.cell_count());
  whole_count_ = 0;
  for (std::uint32_t cell = 0; cell < uses_.size(); ++cell) {
    const bool is_inside = marks_.is_cell_inside(cell);
    uses_[cell] = marks_.is_met(cell) ? CellUse::cut : is_inside ? CellUse::whole : CellUse::out;
    whole_count_ += uses_[cell] == CellUse::whole;
  }
}

// Vertices of the band come first: only they are points of the sweep.
void CutCells::number_vertices() {
  const GridLines& grid = marks_.grid();
  beside_.assign(grid.vertex_count(), 0);
  for (std::uint32_t i = 0, cell = 0; i < grid.columns(); ++i) {
    for (std::uint32_t j = 0; j < grid.rows(); ++j, ++cell) {
      const std::uint8_t use = uses_[cell] == CellUse::cut     ? beside_cut
                               : uses_[cell] == CellUse::whole ? beside_whole
                                                               : 0;
      const std::uint32_t left = grid.vertex(i, j), right = grid.vertex(i + 1, j);
      beside_[left] |= use, beside_[left + 1] |= use, beside_[right] |= use, beside_[right + 1] |= use;
    }
  }
  corners_.resize(grid.vertex_count());
  vertices_.clear();
  for (std::uint32_t vertex = 0; vertex < corners_.size(); ++vertex) {
    corners_[vertex] = marks_.point_at(vertex);
    if (corners_[vertex] != no_id || !(beside_[vertex] & beside_cut)) continue;
    const bool is_free = marks_.is_inside_along_v(vertex) && marks_.near_point(vertex) == no_id;
    if (is_free || (beside_[vertex] & beside_whole)) add_vertex(vertex);
  }
  band_vertices_ = vertices_.size();
  for (std::uint32_t vertex = 0; vertex < corners_.size(); ++vertex)
    if (corners_[vertex] == no_id && beside_[vertex] == beside_whole) add_vertex(vertex);
}

void CutCells::add_vertex(std::uint32_t vertex) {
  corners_[vertex] = static_cast<std::uint32_t>(points_ + vertices_.size());
  vertices_.push_back(vertex);
}

// The band lies between chords and the sides of whole cells. A chord along such a side leaves nothing between.
void CutCells::add_borders() {
  const GridLines& grid = marks_.grid();
  borders_.assign(marks_.chords().begin(), marks_.chords().end());
  for (std::uint32_t i = 0; i <= grid.columns(); ++i) {
    for (std::uint32_t j = 0; j <= grid.rows(); ++j) {
      const std::uint32_t vertex = grid.vertex(i, j);
      const bool is_inside = is_whole(i, j);
      if ((is_inside != (j > 0 && is_whole(i, j - 1))) != marks_.on_line_u(vertex))
        borders_.push_back({corners_[vertex], corners_[grid.vertex(i + 1, j)]});
      if ((is_inside != (i > 0 && is_whole(i - 1, j))) != marks_.on_line_v(vertex))
        borders_.push_back({corners_[vertex], corners_[vertex + 1]});
    }
  }
}

}}  // namespace tessera::abi_0_1
