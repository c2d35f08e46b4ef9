#pragma once
// The sides of a face's patches: which parts of them are kept, and where their points lie.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tess/cells/segments.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns where segment k = 0 .. rate of a patch begins, in the surface's parameters; rate: the end.
inline double line_at(double from, double to, Segments along, int k) {
  return k == 0 ? from : k == along.rate() ? to : from + (to - from) * along.at(k).value();
}

/// A point of a side, and whether what follows it is kept on either side of the line.
struct SidePoint {
  double at;          ///< along the line
  bool below, above;  ///< on the side of smaller and of larger parameters across the line
};

/// The lines of one direction between patches, as sides of the patches along them. Both neighbours of a side have the
/// same points.
class PatchSides {
 public:
  /// Finds what is kept beside the lines.
  ///
  /// - `pieces`: cut at all lines, an even number of ends at each point.
  /// - `across`: the coordinate that is constant on these lines; `lines` its values, `along` those of the other lines.
  /// - `starts_inside`: whether points that no piece encloses are kept.
  ///
  /// Parity beside a line: the number of pieces on that side whose end on the line comes before the point.
  /// A piece along the line lies on neither side, so its ends are no points of the side.
  void set(std::span<const TrimPiece> pieces, double ParameterPoint::*across, std::span<const double> lines,
           std::span<const double> along, bool starts_inside);
  /// Puts segments on a side, on those parts of it that are kept. The side: line `line` from along[k] to along[k + 1].
  /// Points nearer to an end of a piece than a sixteenth of a segment are left out.
  std::vector<SidePoint> points(std::size_t line, std::size_t k, Segments segments) const;
  /// Whether the side is the domain's.
  bool is_outer(std::size_t line) const { return line == 0 || line + 1 == nodes_.size(); }

 private:
  struct Node {
    double at;
    bool below, above;  ///< whether a piece ends here on that side of the line
  };
  std::vector<std::vector<Node>> nodes_;  ///< by line, sorted
  std::span<const double> along_;
  bool starts_inside_ = false;
};

}}  // namespace tessera::abi_0_1
