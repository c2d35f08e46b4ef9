#pragma once
// Cuts the band between whole cells and chords into pieces of about a cell.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plane/chord_marks.h"

namespace tessera { inline namespace abi_0_1 {

/// The use of a cell.
enum class CellUse : std::uint8_t {
  out,    ///< left out
  whole,  ///< two triangles
  cut     ///< a part of the band
};

/// Finds segments along which the band is divided. Each follows a piece of a grid line that lies inside. Where a chord
/// ends the piece, an end of the chord takes the place of the crossing, because no new points are made. A segment that
/// would cross a chord, another cut, or a whole cell is left out, by exact signs; so cuts never cross.
class BandCuts {
 public:
  /// Finds the cuts of `marks` with as many `points`. `uses`: by cell. `corners`: by grid vertex, the index of the
  /// point that stands there, or no_id. `vertices`: the grid vertices that follow on the points.
  void find(const ChordMarks& marks, std::size_t points, std::span<const CellUse> uses,
            std::span<const std::uint32_t> corners, std::span<const std::uint32_t> vertices);
  /// The cuts, between points by their index.
  std::span<const PlaneSegment> cuts() const { return cuts_; }

 private:
  /// An end of a piece of a grid line, and the points that can take its place, the nearest first.
  struct PieceEnd {
    std::array<std::uint32_t, 2> points{no_id, no_id};
  };
  struct Crossing {
    double at;
    std::uint32_t chord;
  };

  ParameterPoint point(std::uint32_t index) const;
  GridPlace cell_of(std::uint32_t index) const;
  PieceEnd end_at(std::uint32_t vertex) const;
  PieceEnd end_at(const Crossing& crossing, bool along_v) const;
  void follow_side(std::uint32_t i, std::uint32_t j, bool along_v);
  void cut(const PieceEnd& a, const PieceEnd& b);
  bool try_cut(std::uint32_t a, std::uint32_t b);
  bool is_blocked(const ParameterPoint& a, const ParameterPoint& b, std::uint32_t i, std::uint32_t j) const;
  const PlaneSegment& segment(std::uint32_t number) const {
    const std::size_t chords = marks_->chords().size();
    return number < chords ? marks_->chords()[number] : cuts_[number - chords];
  }

  const ChordMarks* marks_ = nullptr;
  std::span<const CellUse> uses_;
  std::span<const std::uint32_t> corners_, vertices_;
  std::size_t points_ = 0;
  std::vector<PlaneSegment> cuts_;
  NumberLists cuts_of_cells_;
  std::vector<Crossing> crossings_;
};

}}  // namespace tessera::abi_0_1
