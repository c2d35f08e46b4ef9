#pragma once
// Triangulates the part of a patch's grid that trimming loops keep.

#include <cstdint>
#include <span>
#include <vector>

#include "plane/band_cuts.h"
#include "plane/chord_marks.h"
#include "plane/grid_lines.h"
#include "plane/polygon_triangles.h"

namespace tessera { inline namespace abi_0_1 {

/// The triangles of the part of a grid that chords bound.
///
/// Cells that no chord comes close to are whole, or are left out. The others form the band between whole cells and
/// chords. It is divided along the grid's lines as far as no chord is in the way, and triangulated; so a triangle of
/// the band is about as large as a cell. All triangles share edges, counter-clockwise; each chord is an edge of one
/// triangle, if no point lies on it.
///
/// Vertices: first the given points of the loops, then `grid_vertices()`. Points that are a grid vertex exactly take
/// its place. Time: O(n log n + cells) if the box of each chord is at most a few cells. Repeated calls of one size
/// allocate nothing. An object serves one thread at a time.
class CutCells {
 public:
  using Triangle = PolygonTriangles::Triangle;

  /// Triangulates what lies inside, by parity, as PolygonTriangles does. `chords` must be closed loops within the
  /// grid's rectangle; where they run along its sides, these are chords as well. Returns false, and has no triangles,
  /// if chords cross or a loop is open.
  bool run(const GridLines& grid, std::span<const ParameterPoint> points, std::span<const PlaneSegment> chords);

  /// The grid vertices in use, as grid.vertex() counts them. Vertex k has the index `points` + k.
  std::span<const std::uint32_t> grid_vertices() const { return vertices_; }
  /// Whether a point lies inside a chord, or two chords lie on each other.
  bool has_divided_chords() const { return triangles_.has_divided_borders(); }
  /// The first of the points that are equal to one of those given.
  std::uint32_t first_equal(std::uint32_t point) const { return triangles_.first_equal(point); }
  std::span<const CellUse> uses() const { return uses_; }  ///< by cell
  /// Triangles of the band.
  std::span<const Triangle> band() { return triangles_.triangles(); }
  std::size_t whole_count() const { return whole_count_; }  ///< the number of whole cells
  /// Calls visit(i, j, a, b, c, d) for each whole cell, with the indices of its corners, counter-clockwise from (i, j).
  template <class Visit>
  void for_whole(Visit visit) const {
    const GridLines& grid = marks_.grid();
    for (std::uint32_t i = 0, cell = 0; i < grid.columns(); ++i) {
      const std::uint32_t* left = &corners_[grid.vertex(i, 0)];
      const std::uint32_t* right = &corners_[grid.vertex(i + 1, 0)];
      for (std::uint32_t j = 0; j < grid.rows(); ++j, ++cell)
        if (uses_[cell] == CellUse::whole) visit(i, j, left[j], right[j], right[j + 1], left[j + 1]);
    }
  }

 private:
  void choose_uses();
  void number_vertices();
  void add_borders();
  void add_vertex(std::uint32_t vertex);
  bool is_whole(std::uint32_t i, std::uint32_t j) const {
    const GridLines& grid = marks_.grid();
    return i < grid.columns() && j < grid.rows() && uses_[grid.cell(i, j)] == CellUse::whole;
  }

  ChordMarks marks_;
  BandCuts cuts_;
  PolygonTriangles triangles_;
  static constexpr std::uint8_t beside_cut = 1, beside_whole = 2;  // bits
  std::vector<std::uint8_t> beside_;                               ///< by vertex, which cells have it as a corner
  std::size_t points_ = 0, whole_count_ = 0, band_vertices_ = 0;
  std::vector<CellUse> uses_;
  std::vector<std::uint32_t> corners_, vertices_;
  std::vector<PlaneSegment> borders_;
  std::vector<ParameterPoint> sweep_points_;
};

}}  // namespace tessera::abi_0_1
