#pragma once
// Lays chords along the pieces of trimming loops.

#include <array>
#include <limits>
#include <vector>

#include "tess/trimmed/speed_bound.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera::inline abi_0_1 {

/// The limits of a chord, in parameters of the surface and lengths of the model.
struct ChordLimits {
  double sliver = 0;   ///< the largest distance on the surface between a chord and its piece of curve
  ParameterPoint box;  ///< the largest box of a chord
  SpeedBound speed;    ///< bounds on the surface's first derivatives around the piece
  /// The largest sliver over the length of its chord, both in these speeds: an eighth of the angle by which an arc of a
  /// circle turns.
  double bend = std::numeric_limits<double>::infinity();
};

/// Divides monotone pieces into chords by halving.
///
/// Sliver bound: along a part of a piece with the ends a and b and control points q, each point x between curve and
/// chord meets the curve if it moves along v alone, as the part is monotone. It moves by at most
/// max |(b - a) x (q - a)| / |b.u - a.u|, because the cross product of a point of the curve is a mean of those of the
/// control points. On the surface that is at most speed.v times as long. The same holds along u; the smaller of both
/// counts.
class PieceChords {
 public:
  /// Appends the points of a piece but its start. Returns the largest sliver bound, which is at most limits.sliver,
  /// unless a piece would need more than 2^20 chords. The piece's own error counts as a part of the sliver.
  double append(const TrimPiece& piece, const ChordLimits& limits, std::vector<ParameterPoint>& points);

 private:
  struct Control {
    double u, v, w;  ///< homogeneous, relative to the start of the piece
    ParameterPoint point() const { return {u / w, v / w}; }
  };
  using Net = std::array<Control, max_degree + 1>;
  void divide(const Net& net, int depth);

  const TrimPiece* piece_ = nullptr;
  const ChordLimits* limits_ = nullptr;
  std::vector<ParameterPoint>* points_ = nullptr;
  int degree_ = 0;
  double most_ = 0, error_ = 0;
};

}  // namespace tessera::inline abi_0_1
