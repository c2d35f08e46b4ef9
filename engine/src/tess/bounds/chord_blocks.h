#pragma once
// Holds the chord bounds of all patches of a set, block by block as the patches are packed.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "tess/bounds/chord_bound.h"

namespace tessera { inline namespace abi_0_1 {

/// ChordBound in float, rounded up, for the patches of a set with float Bernstein blocks.
///
/// Bounds come from the packed coefficients, sixteen patches at a time, and include their rounding. Rational patches
/// are also bounded from double, by exact numerators, and take the bound with fewer cells; so do scaled sweeps and flat
/// quadrilaterals (ChordBound) of any kind. Homogeneous bounds of rational patches are found one by one if the patch
/// has a high degree or uneven weights or is small beside the model.
class ChordBlocks {
 public:
  template <class T>
  using Lanes = std::array<T, PatchSet::lanes>;

  /// Where a lane's bounds come from.
  enum class Source : std::uint8_t {
    packed,  ///< the block's kernel
    alone,   ///< the homogeneous patch, in double
    exact,   ///< exact numerators; without products
    sweep,   ///< like `packed`, for a scaled sweep: uv is 0, and so are its products
  };
  /// `by_doubles`: bounds all patches one by one, from double, for sets that reach so far that the rounding of packed
  /// coefficients would be most of the bounds. `reach`: see short_sides(); 0 for none.
  explicit ChordBlocks(const PatchSet::Impl& set, bool by_doubles = false, double reach = 0);

  /// Finds the bounds of a block, at least of the lanes whose bits are set. Threads: any number, each with its own
  /// block.
  void bound(const PatchSet::Impl& set, std::size_t block, std::uint32_t wanted = ~0u);
  /// Returns the largest |x|, |y| or |z| of the control points relative to the origin, rounded up; empty if bound() has
  /// not found it.
  std::optional<double> size(std::size_t block, std::size_t lane) const {
    const float size = size_[block * lanes + lane];
    if (size < 0) return {};
    return (1 + 0x1p-22) * double(size);  // because the packed control points were rounded
  }
  /// `[block]`: a bit for each lane, set for all patches that have a border no longer than the reach from end to end,
  /// by its largest coordinate, and for others about which bound() does not know.
  std::span<const std::uint16_t> short_sides() const { return short_sides_; }
  Source source(std::size_t block, std::size_t lane) const { return source_[block * lanes + lane]; }
  /// Returns the length to add to the chord: twice the distance of a patch from the sweep or the quadrilateral that it
  /// is bounded as.
  double slack(std::size_t block, std::size_t lane) const { return double(slack_[block * lanes + lane]); }
  /// Bounds on the products of second derivatives of one block, found on request.
  class Products {
   public:
    /// Finds them; further calls do nothing. The block must not have changed since ChordBlocks::bound().
    void find(const ChordBlocks& chords, const PatchSet::Impl& set, std::size_t block);
    /// Laid out as pieces_, in units of unit_ squared; null before find().
    const float* values() const { return is_found_ ? values_.data() : nullptr; }

   private:
    bool is_found_ = false;
    alignas(cache_line) std::array<float, 9 * 3 * PatchSet::lanes> values_;
  };

  /// Returns one patch's bound; `products`, if not null, sharpen it.
  ChordBound chord(std::size_t block, std::size_t lane, const Products* products = nullptr) const;

  /// Returns one of ChordBound::pieces().
  SecondDerivatives piece(std::size_t block, std::size_t lane, std::size_t which,
                          const Products* products = nullptr) const;
  /// Returns ChordBound::distance_of().
  double distance_of(PatchSegments segments, std::size_t block, std::size_t lane, const Products* products) const;

  struct Choice {
    Lanes<Rates> rates;           ///< 0 where no rates up to the most keep the distance
    Lanes<double> distance{};     ///< the distance that the rates keep
    std::uint32_t sharpened = 0;  ///< the lanes whose rates are proven by products, one bit each
  };
  /// Returns rates with about the fewest cells, up to `most`, that keep a distance to each of a block's first `count`
  /// patches. The rates are equal on every instruction set, and those of a patch do not depend on the others. Products
  /// are used for the patches for which they save more time than they take.
  Choice cheapest(const PatchSet::Impl& set, std::size_t block, std::size_t count, const Lanes<double>& distance,
                  int most, Products& products) const;

 private:
  /// The bounds of a block's lanes that are found in double.
  struct Exact;

  /// Bounds one lane's homogeneous patch in double (Source::alone).
  void bound_alone(const BezierPatch& patch, std::size_t block, std::size_t lane);
  /// Sets the lane's unit: the power of two at or below the largest bound, so that float holds squares of the others.
  void set_unit(std::size_t block, std::size_t lane, double most);
  /// Writes bound(piece, which of uu, uv, vv), given in lengths, in the lane's unit.
  template <class Bound>
  void store(std::size_t block, std::size_t lane, const Bound& bound);
  /// Takes the bounds of sweeps and flat quadrilaterals, and those of exact numerators where they are smaller. `hints`:
  /// see kernel::ChordHint.
  void bound_exactly(const PatchSet::Impl& set, std::size_t block, const Lanes<float>& hints, std::uint32_t wanted);
  double homogeneous_cells(const BezierPatch& patch, std::size_t block, std::size_t lane) const;
  static void find_exact(const PatchSet::Impl& set, std::size_t block, bool any_patch, Exact& exact);
  void take_sweep(const Exact& exact, std::size_t block, std::size_t lane);
  void take_flat(const BezierPatch& patch, std::size_t block, std::size_t lane);
  void take_exact(const BezierPatch& patch, const Exact& exact, bool may_gain, std::size_t block, std::size_t lane);

  /// Returns the lanes among `asked` for which products save more time than they take, one bit each.
  std::uint32_t gaining_by_products(const PatchSet::Impl& set, std::size_t block, const Choice& choice,
                                    std::uint32_t asked) const;
  /// Finds rates by the kernel, and one by one where it has found none.
  Choice search(std::size_t block, std::size_t count, const Lanes<double>& distance, int most,
                const Products* products) const;

  static constexpr std::size_t lanes = PatchSet::lanes, piece_count = 9, block_pieces = piece_count * 3 * lanes;

  bool by_doubles_;
  float reach_;
  const kernel::KernelTable* kernels_;
  UnsetVector<float> pieces_;   ///< `[block][piece][uu, uv, vv][lane]`, in units of unit_
  AlignedVector<float> unit_;   ///< `[block][lane]`, powers of two
  AlignedVector<float> size_;   ///< `[block][lane]`, negative where unknown
  std::vector<float> slack_;    ///< `[block][lane]`
  std::vector<Source> source_;  ///< `[block][lane]`
  std::vector<std::uint16_t> short_sides_;
};

}}  // namespace tessera::abi_0_1
