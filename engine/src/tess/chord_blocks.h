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

/// ChordBound in float, rounded up, of a set with float Bernstein blocks. Bounds come from the packed coefficients, sixteen
/// patches at a time, and include their rounding; those of rational patches of high degrees or uneven weights, or which are
/// small beside the model, one by one, from double.
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
  /// How many cells a patch products save, about, of those that a choice has.
  double saved_by_products(const PatchSet::Impl& set, std::size_t block, std::size_t count, const Choice& choice) const;
  /// By the kernel, and one by one where it has found none.
  Choice search(std::size_t block, std::size_t count, const Lanes<double>& distance, int most,
                const Products* products) const;

  static constexpr std::size_t lanes = PatchSet::lanes, piece_count = 9, block_pieces = piece_count * 3 * lanes;

  UnsetVector<float> pieces_;  ///< `[block][piece][uu, uv, vv][lane]`, in units of unit_
  AlignedVector<float> unit_;  ///< `[block][lane]`, powers of two
  AlignedVector<float> size_;  ///< `[block][lane]`, negative where not known
};

}  // namespace tessera
