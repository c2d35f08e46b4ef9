#pragma once
// The arcs of a patch's section with one plane, cell by cell.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "section/patch_cells.h"

namespace tessera { inline namespace abi_0_1 {

/// Where a plane meets a line between cells, or a side of the patch.
struct LineCrossing {
  std::uint32_t line = 0, interval = 0;  ///< of PatchCells::lines(), and of its heights
  ParameterPoint at = {};                ///< in the patch's parameters from 0 to 1
  std::array<std::uint32_t, 2> arcs{no_id, no_id};
};

/// A part of the section within one cell.
struct CellArc {
  std::uint32_t cell = 0;                  ///< of PatchCells::nodes()
  std::array<std::uint32_t, 2> ends = {};  ///< crossings
};

/// Finds the arcs of one patch after the other, of one plane after the other; keeps its memory.
class PatchArcs {
 public:
  void find(const PatchCells& cells, const Level& level, double contact);

  std::span<const LineCrossing> crossings() const { return crossings_; }
  std::span<const CellArc> arcs() const { return arcs_; }
  /// Cells that are points, where the plane may be tangent to the patch; `touched`: those without arcs.
  std::span<const std::uint32_t> points() const { return points_; }
  std::span<const std::uint32_t> touched() const { return touched_; }
  /// Ends of intervals of lines that lie in the plane: there the limits from both sides may differ.
  std::span<const ParameterPoint> special() const { return special_; }

 private:
  void reset(const PatchCells& cells, const Level& level, double contact);
  void make(std::uint32_t line);
  bool is_above(std::uint32_t line, double parameter);
  void visit(std::uint32_t cell);
  void add_side(const CellSide& side, bool backward);
  std::uint32_t crossing(std::uint32_t line, std::size_t interval);
  void add_arc(std::uint32_t cell, std::uint32_t from, std::uint32_t to);
  void sort_over(const CellNode& cell);

  const PatchCells* cells_ = nullptr;
  Level level_{};
  double contact_ = 0;
  std::uint32_t turn_ = 0;                  ///< the number of this call
  std::vector<std::uint32_t> made_;         ///< by line: the last call that made it
  std::vector<std::uint8_t> above_;         ///< by line and place
  std::vector<double> roots_;               ///< by interval
  std::vector<std::uint32_t> crossing_of_;  ///< by interval
  std::vector<std::uint32_t> around_;       ///< crossings of a cell
  std::vector<std::uint32_t> to_visit_;
  std::vector<LineCrossing> crossings_;
  std::vector<CellArc> arcs_;
  std::vector<std::uint32_t> points_, touched_;
  std::vector<ParameterPoint> special_;
};

}}  // namespace tessera::abi_0_1
