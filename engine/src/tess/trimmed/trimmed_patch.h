#pragma once
// One patch of a trimmed face: its polygon, its triangles and their bound.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/bounds/chord_bound.h"
#include "tess/trimmed/cut_cells.h"
#include "tess/trimmed/patch_sides.h"
#include "tess/trimmed/piece_chords.h"
#include "tess/trimmed/speed_bound.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera::inline abi_0_1 {

/// The facts that cutting a patch needs, in the surface's parameters.
struct TrimmedPatch {
  Domain domain;
  const ChordBound* chord;
  SpeedBound speed;    ///< over the patch's own parameters
  Rates rates;         ///< of its grid
  double sliver;       ///< the largest distance between chords and curves
  double chord_share;  ///< the largest length of a chord, in cells
};

/// Cuts patches, one after the other.
class PatchCutter {
 public:
  /// Begins a polygon.
  void begin(const TrimmedPatch& patch);
  /// Adds the kept parts of a side: points at `along`, the other coordinate is `across`. `above`: the patch lies at
  /// larger parameters across the side.
  void add_side(std::span<const SidePoint> side, double across, bool runs_along_u, bool above);
  void add_piece(const TrimPiece& piece);
  /// Triangulates the polygon. False if chords cross.
  bool cut();

  const CutCells& cells() const { return cells_; }
  CutCells& cells() { return cells_; }
  /// The parameters of a vertex, in the surface and in the patch.
  ParameterPoint point(std::uint32_t vertex) const;
  ParameterPoint local(std::uint32_t vertex) const;
  const GridLines& grid() const { return grid_; }
  /// The lines of the grid in the patch's own parameters.
  void local_lines(std::vector<double>& u, std::vector<double>& v) const;
  std::size_t vertex_count() const { return points_.size() + cells_.grid_vertices().size(); }
  /// The largest distance of a triangle, and of a sliver.
  double chord_bound();
  double sliver_bound() const { return sliver_; }

 private:
  double triangle_bound(const CutCells::Triangle& triangle) const;
  std::uint32_t add_point(const ParameterPoint& point);

  TrimmedPatch patch_;
  PieceChords chords_of_pieces_;
  CutCells cells_;
  std::vector<ParameterPoint> points_;
  std::vector<PlaneSegment> chords_;
  std::vector<double> lines_u_, lines_v_;
  GridLines grid_;
  double sliver_ = 0;
};

}  // namespace tessera::inline abi_0_1
