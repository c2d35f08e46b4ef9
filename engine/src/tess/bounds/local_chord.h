#pragma once
// Chord bounds over many small pieces of a patch, for rates with fewer cells than bounds over halves prove.

#include <array>
#include <optional>

#include "base/function_ref.h"
#include "tess/bounds/chord_bound.h"
#include "tess/plan/segment_choices.h"
#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

struct DerivativeNets;

/// Bounds over rectangles that tile the patch, small where it bends most. A triangle's parameter box, at most h x k, has its
/// centre in one of them, and so lies within that one widened by h / 2 and k / 2: for this part of the patch it is bounded.
/// So, unlike bounds over halves, those of a whole patch know no difference between even and odd rates. Takes about 20 us of
/// a bicubic patch.
class LocalChord {
 public:
  static constexpr std::size_t max_pieces = 32;

  /// For rates of at least `least`; rectangles, at most so many, are chosen for rates of about `about`.
  LocalChord(const BezierPatch& patch, Rates least, Rates about, std::size_t pieces = max_pieces);
  /// For triangles inside a part of the patch alone.
  LocalChord(const DerivativeNets& patch, const Domain& part, Rates least, Rates about, std::size_t pieces);

  Rates least() const { return least_; }
  /// As ChordBound::distance, of rates not below least().
  double distance(Rates rates) const;
  bool keeps(Rates rates, double distance) const;

 private:
  struct Piece {
    Domain rectangle;
    SecondDerivatives bound;
    double chord = 0;  ///< by the rates that the pieces are chosen for
  };

  Rates least_;
  std::array<Piece, max_pieces> pieces_;  ///< those of the largest chord first
  std::size_t count_ = 0;
};

/// Adds segments with fewer cells than there are, that keep a distance and `also` hold at the coarsest rates; and others
/// with about as few.
void find_fewer(const BezierPatch& patch, double distance, FunctionRef<bool(Rates)> also, SegmentChoices& choices);
/// What they keep, so.
double local_distance(const BezierPatch& patch, PatchSegments segments);

}  // namespace tessera::inline abi_0_1
