#pragma once
// One patch of a trimmed face: its polygon, its triangles and their bound.

#include <cstdint>
#include <span>
#include <vector>

#include "tess/trimmed/chord_crossings.h"
#include "tess/trimmed/cut_cells.h"
#include "tess/trimmed/patch_sides.h"
#include "tess/trimmed/piece_chords.h"
#include "tess/trimmed/speed_bound.h"
#include "tess/trimmed/vertex_merger.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera::inline abi_0_1 {

/// The facts that cutting a patch needs.
struct TrimmedPatch {
  Domain domain;           ///< in the surface's parameters, as those of loops and of cells
  SpeedBound speed;        ///< over the patch's own parameters
  PatchSegments segments;  ///< of its grid
  double sliver;           ///< the largest distance between chords and curves
  double room;             ///< the largest distance of a triangle, with that of the slivers; infinite: no limit
  bool in_cells;           ///< whether triangles must be no wider than cells
  double bend;             ///< see ChordLimits
  VertexRounding rounding;
  double chord_share = 1;  ///< the largest length of a chord, in cells
};

/// Cuts patches, one after the other.
class PatchCutter {
 public:
  /// Begins a polygon.
  void begin(const TrimmedPatch& patch);
  /// Adds the kept parts of a side: points at `along`, the other coordinate is `across`. `above`: the patch lies at
  /// larger parameters across the side. Returns the number of chords.
  std::size_t add_side(std::span<const SidePoint> side, double across, bool runs_along_u, bool above);
  /// Adds the pieces of loops with these indices, in the order of the loops. Returns the number of chords.
  std::size_t add_pieces(std::span<const TrimPiece> pieces, std::span<const std::uint32_t> indices);
  /// Triangulates the polygon. Returns false if chords cross.
  bool cut();
  /// Divides chords where they cross, and triangulates the polygon. Returns false if some still cross.
  bool cut_crossing();

  CutCells& cells() { return cells_; }
  /// The parameters of a vertex, in the surface and in the patch.
  ParameterPoint point(std::uint32_t vertex) const;
  ParameterPoint local(std::uint32_t vertex) const;
  std::size_t vertex_count() const { return points_.size() + cells_.grid_vertices().size(); }
  /// The vertices up to this one are points of loops and sides, the others those of the grid.
  std::size_t loop_vertex_count() const { return points_.size(); }
  /// The largest distance of a sliver, in the patch's lengths.
  double sliver_bound() const { return sliver_; }

 private:
  std::uint32_t add_point(const ParameterPoint& point);
  /// Whether a piece continues a chain of pieces from `start` to the end of `before` so that it stays monotone.
  bool continues(const ParameterPoint& start, const TrimPiece& before, const TrimPiece& next) const;

  TrimmedPatch patch_;
  ChordLimits limits_;
  PieceChords chords_of_pieces_;
  ChordCrossings crossings_;
  CutCells cells_;
  std::vector<ParameterPoint> points_;
  std::vector<PlaneSegment> chords_;
  std::vector<double> lines_u_, lines_v_;
  GridLines grid_;
  double sliver_ = 0;
};

}  // namespace tessera::inline abi_0_1
