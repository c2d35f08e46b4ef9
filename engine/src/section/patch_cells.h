#pragma once
// A patch divided into cells with simple curves of equal height, for all planes of a call at once.
//
// Lines between cells carry their own division into intervals that a plane meets at most once (HeightLine). Both cells
// beside a line find a plane's point on it by the line alone, so curves go on from cell to cell whatever rounding does.
// The height of a line's end is told by the line that it ends on.

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "section/cell_net.h"
#include "section/height_line.h"

namespace tessera { inline namespace abi_0_1 {

/// A line between cells, or a side of the patch.
struct CellLine {
  const HeightLine* heights = nullptr;
  bool reversed = false;                 ///< whether the places of `heights` run from `to` to `from`
  bool along_u = false;                  ///< whether it runs along u
  double across = 0;                     ///< the patch's other parameter
  double from = 0, to = 1;               ///< the patch's parameter at its ends, growing
  std::array<std::uint32_t, 2> on = {};  ///< the lines that its ends lie on; none for sides of the patch
  std::size_t first_interval = 0;        ///< of all intervals of the patch's lines

  double place(double parameter) const {
    const double share = (parameter - from) / (to - from);
    return reversed ? 1 - share : share;
  }
  double parameter(double place) const { return from + (reversed ? 1 - place : place) * (to - from); }
};

/// A part of a line along a cell.
struct CellSide {
  std::uint32_t line = 0;
  double from = 0, to = 1;  ///< the patch's parameters, growing
};

struct CellNode {
  Domain domain;                    ///< in the patch's parameters from 0 to 1
  double low = 0, high = 0;         ///< heights
  std::uint32_t first_child = 0;    ///< of two that follow each other; 0: it is a cell
  bool divided_u = false;           ///< whether they are beside each other along u
  CellKind kind = CellKind::empty;  ///< if it is a cell
  bool is_shallow = false;          ///< whether its division was ended without a proof
  double bending = 0, slack = 0, diameter = 0;
  std::array<CellSide, 4> sides;  ///< as Side numbers them
};

/// A border of a patch: heights that patches beside it share.
struct PatchBorder {
  const HeightLine* heights;
  bool reversed;
};

class PatchCells {
 public:
  /// The borders must outlive the cells.
  PatchCells(const BezierPatch& patch, const Levels& levels, const std::array<PatchBorder, 4>& borders);

  std::span<const CellNode> nodes() const { return nodes_; }
  std::span<const CellLine> lines() const { return lines_; }
  std::size_t interval_count() const { return interval_count_; }
  /// Whether the division of a cell or a line was ended before anything was proven.
  bool is_proven() const { return is_proven_; }

  static constexpr std::size_t max_cells = 1 << 13;

 private:
  struct Part;
  void divide(Part part, const Levels& levels, std::deque<Part>& parts);
  std::uint32_t add_line(CellNet& lower, bool along_u, const CellNode& node, double at, const Levels& levels);

  std::vector<CellNode> nodes_;
  std::vector<CellLine> lines_;
  std::deque<HeightLine> own_lines_;  ///< they must stay where they are
  std::size_t interval_count_ = 0;
  bool is_proven_ = true;
};

}}  // namespace tessera::abi_0_1
