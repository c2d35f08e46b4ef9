#pragma once
// The chord bounds of all patches of a set, block by block as the patches are packed.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "tess/chord_bound.h"

namespace tessera {

/// ChordBound in float, rounded up, of a set with float Bernstein blocks. Bounds of polynomial patches come from the packed
/// coefficients, sixteen patches at a time, and include their rounding; those of rational ones, one by one, from double.
class ChordBlocks {
 public:
  template <class T>
  using Lanes = std::array<T, PatchSet::lanes>;

  explicit ChordBlocks(const PatchSet::Impl& set);

  /// Finds the bounds of a block, of those lanes at least whose bits are set. Threads: any number, each a block of its own.
  void bound(const PatchSet::Impl& set, std::size_t block, std::uint32_t wanted = ~0u);
  /// The largest |x|, |y|, |z| of the control points relative to the origin, as found on the way, rounded up.
  std::optional<double> size(std::size_t block, std::size_t lane) const {
    const float size = size_[block * lanes + lane];
    if (size < 0) return {};
    return (1 + 0x1p-22) * double(size);  // the control points were rounded
  }
  /// One patch's bound.
  ChordBound chord(std::size_t block, std::size_t lane) const;

  struct Choice {
    Lanes<Rates> rates;       ///< 0 where no rates up to the most keep the distance
    Lanes<double> distance{}; ///< what they keep
  };
  /// Rates with about the fewest cells that keep a distance to each of a block's first `count` patches. The same on every
  /// instruction set.
  Choice cheapest(std::size_t block, std::size_t count, const Lanes<double>& distance, int most) const;

 private:
  static constexpr std::size_t lanes = PatchSet::lanes, piece_count = 9, block_pieces = piece_count * 3 * lanes;

  AlignedVector<float> pieces_;  ///< `[block][piece][uu, uv, vv][lane]`, in units of unit_
  AlignedVector<float> unit_;    ///< `[block][lane]`, powers of two
  AlignedVector<float> size_;    ///< `[block][lane]`, negative where not known
};

}  // namespace tessera
