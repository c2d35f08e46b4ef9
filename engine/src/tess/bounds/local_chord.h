#pragma once
// Bounds chords over many small pieces of a patch, for rates with fewer cells than bounds over halves prove.

#include <array>
#include <optional>

#include "base/function_ref.h"
#include "tess/bounds/chord_bound.h"
#include "tess/edges/segment_choices.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

struct DerivativeNets;

/// Bounds over rectangles that tile the patch, small where it bends most.
///
/// A triangle's parameter box, at most h x k, has its centre in one of the rectangles. So it lies within this rectangle
/// widened by h / 2 and k / 2, and the bound is made for this part of the patch. Unlike bounds over halves, those of a
/// whole patch make no difference between even and odd rates. Time: some 10 us per bicubic patch.
class LocalChord {
 public:
  static constexpr std::size_t max_pieces = 32;

  /// Makes bounds for triangles that lie inside a part of the patch, for rates of at least `least`, over at most
  /// `pieces` rectangles that suit rates near `about`.
  LocalChord(const DerivativeNets& patch, const Domain& part, Rates least, Rates about, std::size_t pieces);

  Rates least() const { return least_; }
  /// Returns the largest distance, as ChordBound::distance(), for rates not below least().
  double distance(Rates rates) const;
  bool keeps(Rates rates, double distance) const;

 private:
  struct Piece {
    Domain rectangle;
    SecondDerivatives bound;
    double chord = 0;  ///< at the rates that the pieces are chosen for
  };

  Rates least_;
  std::array<Piece, max_pieces> pieces_;  ///< in the order of chords, largest first
  std::size_t count_ = 0;
};

/// Adds segments to `choices` that keep the distance with fewer cells than its present ones, or about as few. `also`
/// must hold for them.
void find_fewer(const BezierPatch& patch, double distance, FunctionRef<bool(PatchSegments)> also,
                SegmentChoices& choices);
/// Returns the distance that segments keep by such bounds.
double local_distance(const BezierPatch& patch, PatchSegments segments);

}}  // namespace tessera::abi_0_1
