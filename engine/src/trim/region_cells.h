#pragma once
// Cells of a region: most hold no piece and answer at once, the others list the pieces that pass through them.
//
// The parity of a point is that of the pieces that a ray towards larger u crosses. In a cell it is a constant plus the
// crossings of the listed pieces: pieces that pass on the right, end to end, change nothing within a row of cells. Only
// where a listed piece ends on the right of the cell, in its row, would the count jump at that height. There the listed
// piece counts as if it went on along a vertical line beyond every point of the cell, and the constant makes up for
// that. Which cell holds a point, or an end, is decided by the same monotone function of its coordinates, so all this
// holds whatever its rounding.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tessera/trim_region.h"
#include "trim/piece_side.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// A piece in a cell. The part of the piece within the cell lies in the strip lower <= a u + b v + c <= upper, which is
/// as much wider as its reach and rounding take; a <= 0, so that points with larger values see it on their right.
struct alignas(64) CellEntry {
  double a, b, c, lower, upper;
  double from_v, to_v;  ///< the heights at which it counts: [from_v, to_v)
  std::uint32_t piece;
  std::uint32_t is_last;  ///< whether it is the last entry of its cell
};

/// A rectangle of cells: [row][column].
struct CellGrid {
  double u0, v0;        ///< the lower corner
  double per_u, per_v;  ///< cells per unit of the parameters
  std::int32_t columns, rows;
  std::uint32_t first_cell;

  std::int32_t column(double u) const { return index((u - u0) * per_u, columns); }
  std::int32_t row(double v) const { return index((v - v0) * per_v, rows); }

 private:
  static std::int32_t index(double x, std::int32_t count) {
    const double last = static_cast<double>(count - 1);
    return static_cast<std::int32_t>(x < 0 ? 0 : x > last ? last : x);
  }
};

/// The content of a cell: the kind in the lowest three bits, above them the index of its first entry or finer grid.
struct Cell {
  enum Kind : std::uint32_t { outside = 0, inside = 1, list = 2, list_inside = 3, grid = 4 };
  std::uint32_t bits = outside;

  static Cell make(Kind kind, std::size_t index = 0) {
    return {static_cast<std::uint32_t>(kind) | static_cast<std::uint32_t>(index) << 3};
  }
  std::uint32_t kind() const { return bits & 7; }
  std::size_t index() const { return bits >> 3; }
};

class RegionCells {
 public:
  /// Makes the cells. In `pieces`, an even number of ends meet at every point, and all lie within the domain.
  static RegionCells make(const std::vector<TrimPiece>& pieces, const Domain& domain, bool starts_inside);

  /// The side of all points of a rectangle within the domain. `border`: the cell that holds it, or the two or four that
  /// it lies across, do not tell.
  TrimSide locate_all(const Domain& box) const {
    const CellGrid* grid = grids_.data();
    for (;;) {
      const std::int32_t row = grid->row(box.v0), column = grid->column(box.u0);
      const std::int32_t rows = grid->row(box.v1) - row, columns = grid->column(box.u1) - column;
      const Cell* const first = &cells_[grid->first_cell + static_cast<std::size_t>(row * grid->columns + column)];
      if ((rows | columns) != 0)
        return rows <= 1 && columns <= 1 ? side_of_all(first, rows * grid->columns, columns) : TrimSide::border;
      if (first->kind() <= Cell::inside) return static_cast<TrimSide>(first->kind());
      if (first->kind() != Cell::grid) return locate_all_in_list(*first, box);
      grid = &grids_[first->index()];
    }
  }

  /// The side of a point of the domain.
  TrimSide locate(const std::vector<TrimPiece>& pieces, double u, double v) const {
    const CellGrid* grid = grids_.data();
    for (;;) {
      const auto place = static_cast<std::size_t>(grid->row(v) * grid->columns + grid->column(u));
      const Cell cell = cells_[grid->first_cell + place];
      if (cell.kind() <= Cell::inside) return static_cast<TrimSide>(cell.kind());
      if (cell.kind() != Cell::grid) return locate_in_list(pieces, cell, u, v);
      grid = &grids_[cell.index()];
    }
  }

  std::size_t memory_bytes() const {
    return grids_.capacity() * sizeof(CellGrid) + cells_.capacity() * sizeof(Cell) +
           entries_.capacity() * sizeof(CellEntry);
  }

 private:
  friend class CellsBuilder;
  TrimSide locate_in_list(const std::vector<TrimPiece>& pieces, Cell cell, double u, double v) const {
    std::uint32_t parity = cell.kind() & 1;
    for (const CellEntry* entry = &entries_[cell.index()];; ++entry) {
      const double strip = entry->a * u + entry->b * v + entry->c;
      const std::uint32_t at_height = static_cast<std::uint32_t>(v >= entry->from_v) & (v < entry->to_v);
      if (strip > entry->upper) {
        parity ^= at_height;
      } else if (!(strip < entry->lower)) {
        const PieceSide side = side_of(pieces[entry->piece], {u, v});
        if (side == PieceSide::near) return TrimSide::border;
        parity ^= side == PieceSide::left || (side == PieceSide::beside && at_height != 0);
      }
      if (entry->is_last != 0) return static_cast<TrimSide>(parity);
    }
  }

  /// The side that a cell, those `right` and `above` of it, and the one in the corner have in common.
  static TrimSide side_of_all(const Cell* cell, std::int32_t above, std::int32_t right) {
    const std::uint32_t kind = cell->kind();
    const bool is_one = kind <= Cell::inside && cell[right].kind() == kind && cell[above].kind() == kind &&
                        cell[above + right].kind() == kind;
    return is_one ? static_cast<TrimSide>(kind) : TrimSide::border;
  }
  /// Locates as locate_all() does, by strips alone. A strip's value falls with u (a <= 0).
  TrimSide locate_all_in_list(Cell cell, const Domain& box) const {
    std::uint32_t parity = cell.kind() & 1;
    for (const CellEntry* entry = &entries_[cell.index()];; ++entry) {
      const bool rises = entry->b > 0;
      const double least = entry->a * box.u1 + entry->b * (rises ? box.v0 : box.v1) + entry->c;
      const double most = entry->a * box.u0 + entry->b * (rises ? box.v1 : box.v0) + entry->c;
      if (least > entry->upper) {
        const bool counts = box.v0 >= entry->from_v && box.v1 < entry->to_v;
        if (!counts && box.v1 >= entry->from_v && box.v0 < entry->to_v) return TrimSide::border;
        parity ^= static_cast<std::uint32_t>(counts);
      } else if (!(most < entry->lower)) {
        return TrimSide::border;
      }
      if (entry->is_last != 0) return static_cast<TrimSide>(parity);
    }
  }

  std::vector<CellGrid> grids_;  ///< the first covers the domain
  std::vector<Cell> cells_;
  std::vector<CellEntry> entries_;
};

}}  // namespace tessera::abi_0_1
