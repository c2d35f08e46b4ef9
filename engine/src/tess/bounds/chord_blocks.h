#pragma once
// The chord bounds of all patches of a set, block by block as the patches are packed.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "tess/bounds/chord_bound.h"

namespace tessera::inline abi_0_1 {

/// ChordBound in float, rounded up, of a set with float Bernstein blocks. Bounds come from the packed coefficients, sixteen
/// patches at a time, and include their rounding. Rational patches are bounded from double as well, by exact numerators, and
/// keep the bound with fewer cells; so do scaled sweeps and flat quadrilaterals (ChordBound) of any kind. Homogeneous bounds
/// of rational patches of high degrees or uneven weights, or which are small beside the model, are found one by one.
class ChordBlocks {
 public:
  template <class T>
  using Lanes = std::array<T, PatchSet::lanes>;

  /// Kinds of a lane's bounds.
  enum class Source : std::uint8_t {
    packed,  ///< of the block's kernel
    alone,   ///< of the homogeneous patch, in double
    exact,   ///< of exact numerators; without products
    sweep,   ///< as `packed`, of a scaled sweep: uv is 0, and so are its products
  };
  /// `by_doubles`: all patches one by one, from double. For sets that reach so far that the rounding of packed coefficients
  /// would be most of the bounds.
  explicit ChordBlocks(const PatchSet::Impl& set, bool by_doubles = false);

  /// Finds the bounds of a block, of those lanes at least whose bits are set. Threads: any number, each a block of its own.
  void bound(const PatchSet::Impl& set, std::size_t block, std::uint32_t wanted = ~0u);
  /// The largest |x|, |y|, |z| of the control points relative to the origin, as found on the way, rounded up.
  std::optional<double> size(std::size_t block, std::size_t lane) const {
    const float size = size_[block * lanes + lane];
    if (size < 0) return {};
    return (1 + 0x1p-22) * double(size);  // the control points were rounded
  }
  Source source(std::size_t block, std::size_t lane) const { return source_[block * lanes + lane]; }
  /// Returns the length that counts beside the chord: twice the distance of a patch from the sweep or the quadrilateral that it is bounded as.
  double slack(std::size_t block, std::size_t lane) const { return double(slack_[block * lanes + lane]); }
  /// Bounds on the products of second derivatives, found where they are asked for.
  class Products {
   public:
    /// Of a block that is as it was when it was bounded. Once; then it is free.
    void find(const ChordBlocks& chords, const PatchSet::Impl& set, std::size_t block);
    const float* values() const {
      return is_found_ ? values_.data() : nullptr;
    }  ///< as pieces_, in units of unit_ squared

   private:
    bool is_found_ = false;
    alignas(cache_line) std::array<float, 9 * 3 * PatchSet::lanes> values_;
  };

  /// One patch's bound, by the products as well if there are `products`.
  ChordBound chord(std::size_t block, std::size_t lane, const Products* products = nullptr) const;

  /// One of ChordBound::pieces() without products.
  SecondDerivatives piece(std::size_t block, std::size_t lane, std::size_t which) const {
    const double unit = unit_[block * lanes + lane];
    const float* d = pieces_.data() + block * block_pieces + which * 3 * lanes + lane;
    return {unit * double(d[0]), unit * double(d[lanes]), unit * double(d[2 * lanes])};
  }

  struct Choice {
    Lanes<Rates> rates;        ///< 0 where no rates up to the most keep the distance
    Lanes<double> distance{};  ///< what they keep
  };
  /// Rates with about the fewest cells that keep a distance to each of a block's first `count` patches. The same on every
  /// instruction set. Products are looked for where they save more than they take.
  Choice cheapest(const PatchSet::Impl& set, std::size_t block, std::size_t count, const Lanes<double>& distance,
                  int most, Products& products) const;

 private:
  /// Bounds of a block's lanes that are found in double.
  struct Exact;

  /// Bounds the lane's patch alone.
  void bound_alone(const BezierPatch& patch, std::size_t block, std::size_t lane);
  /// The power of two at or below the largest bound, so that float holds squares of the others.
  void set_unit(std::size_t block, std::size_t lane, double most);
  /// Writes bounds(piece, which of uu, uv, vv), in lengths, in the lane's unit.
  template <class Bound>
  void store(std::size_t block, std::size_t lane, const Bound& bound);
  /// Takes the bounds of sweeps and flat quadrilaterals, and of exact numerators where they are the smaller ones. `hints`: see
  /// kernel::ChordHint.
  void bound_exactly(const PatchSet::Impl& set, std::size_t block, const Lanes<float>& hints, std::uint32_t wanted);
  double homogeneous_cells(const BezierPatch& patch, std::size_t block, std::size_t lane) const;
  static void find_exact(const PatchSet::Impl& set, std::size_t block, bool any_patch, Exact& exact);
  void take_sweep(const Exact& exact, std::size_t block, std::size_t lane);
  void take_flat(const BezierPatch& patch, std::size_t block, std::size_t lane);
  void take_exact(const BezierPatch& patch, const Exact& exact, std::size_t block, std::size_t lane);

  /// How many cells a patch products save, about, of those that a choice has.
  double saved_by_products(const PatchSet::Impl& set, std::size_t block, std::size_t count, const Choice& choice) const;
  /// By the kernel, and one by one where it has found none.
  Choice search(std::size_t block, std::size_t count, const Lanes<double>& distance, int most,
                const Products* products) const;

  static constexpr std::size_t lanes = PatchSet::lanes, piece_count = 9, block_pieces = piece_count * 3 * lanes;

  bool by_doubles_;
  UnsetVector<float> pieces_;   ///< `[block][piece][uu, uv, vv][lane]`, in units of unit_
  AlignedVector<float> unit_;   ///< `[block][lane]`, powers of two
  AlignedVector<float> size_;   ///< `[block][lane]`, negative where not known
  std::vector<float> slack_;    ///< `[block][lane]`
  std::vector<Source> source_;  ///< `[block][lane]`
};

}  // namespace tessera::inline abi_0_1
