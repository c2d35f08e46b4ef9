#pragma once
// Collects the rates that the patches at an edge need there.

#include <algorithm>
#include <array>
#include <cstdint>

#include "tess/cells/segment_law.h"
#include "tess/cells/segments.h"
#include "tess/edges/shared_edges.h"

namespace tessera { inline namespace abi_0_1 {

constexpr Segments along(PatchSegments patch, Side side) { return along_side(side, patch); }

/// The needs of patches with uniform segments. Stored as one word: a loop over all borders adds to it.
class EdgeNeeds {
 public:
  EdgeNeeds() = default;
  /// The needs of one patch. `never`: 1 if none of its triangles may cross the middle.
  EdgeNeeds(Segments along, std::uint32_t never) : word_(static_cast<std::uint32_t>(along.rate()) << rate_bit) {
    const std::uint32_t is_even =
        along.is_uniform() ? ~static_cast<std::uint32_t>(along.key()) & 1 : std::uint32_t{along.parts_halves()};
    word_ |= one_patch | (never & is_even);
  }
  /// Adds the needs of one patch.
  void add(EdgeNeeds one) {
    word_ = std::max(word_, one.word_) | ((word_ | one.word_) & flags) | (word_ & one_patch) << 1;
  }
  /// Takes the rate of others if it is larger, and an even one if they need it.
  void take(EdgeNeeds others) {
    word_ = std::max(word_ & ~flags, others.word_ & ~flags) | (word_ & flags) | (others.word_ & even);
  }
  void make_even() { word_ |= even; }

  int most() const { return static_cast<int>(word_ >> rate_bit); }  ///< the largest rate of the patches
  /// 1: the edge's rate must be even, for a patch whose triangles must not cross the middle.
  std::uint32_t is_even() const { return word_ & even; }
  std::uint32_t rate() const { return (word_ >> rate_bit) + (word_ >> rate_bit & is_even()); }
  Segments segments() const { return static_cast<int>(rate()); }
  /// Whether one patch was added; twice the same one counts as two.
  bool has_one_patch() const { return (word_ & patches) == one_patch; }

 private:
  static constexpr int rate_bit = 16;
  static constexpr std::uint32_t even = 1, one_patch = 2, patches = 6, flags = 7;

  std::uint32_t word_ = 1u << rate_bit;
};

/// The largest rates in the eighths of an edge, in the direction of its first border. Needs may be added in any order.
class PieceNeeds {
 public:
  void add(Segments along, bool against) {
    if (along.is_uniform() && is_uniform()) {
      if (along.rate() <= leading_.rate()) return;
      for (int e = 0; e < Segments::parts; ++e) set_need(e, {along.rate(), 1});
      leading_ = along;
      return;
    }
    if (against) along = along.reversed();
    bool is_above = true, is_below = true;
    for (int e = 0; e < Segments::parts; ++e) {
      const Segments::Fraction rate = along.rate_in(e), had = need(e);
      if (rate < had) is_above = false;
      if (had < rate) is_below = false, set_need(e, rate);
    }
    if (is_above && is_below) {
      leading_ = along.key() > leading_.key() ? along : leading_;
    } else if (!is_below) {
      leading_ = is_above ? along : Segments();
    }
  }
  bool empty() const { return needs_[0].numerator == 0; }  ///< whether no patch with an area has needs
  /// Whether uniform segments have all of the rates, and no more.
  bool is_uniform() const { return empty() || (leading_.rate() > 0 && leading_.is_uniform()); }
  Segments segments(bool against, std::uint32_t is_even) const {
    if (empty()) return 1;
    const bool is_known = leading_.rate() > 0 && (is_even == 0 || leading_.parts_halves());
    Segments along = leading_;
    if (!is_known) {
      RateNeeds needs;
      for (int e = 0; e < Segments::parts; ++e) needs[static_cast<std::size_t>(e)] = need(e);
      along = segments_for(needs, is_even != 0);
    }
    return against ? along.reversed() : along;
  }

 private:
  /// A fraction in one word: numerators are at most 8 x 77 x 1023 and denominators 8 x 77.
  struct Need {
    std::uint32_t numerator : 21 = 0, denominator : 11 = 1;
  };
  Segments::Fraction need(int eighth) const {
    const Need& need = needs_[static_cast<std::size_t>(eighth)];
    return {static_cast<int>(need.numerator), static_cast<int>(need.denominator)};
  }
  void set_need(int eighth, Segments::Fraction rate) {
    Need& need = needs_[static_cast<std::size_t>(eighth)];
    need.numerator = static_cast<std::uint32_t>(rate.numerator) & 0x1fffff;
    need.denominator = static_cast<std::uint32_t>(rate.denominator) & 0x7ff;
  }

  std::array<Need, Segments::parts> needs_;
  Segments leading_;  ///< segments that have all of these rates, if a patch has such; otherwise none
};

}}  // namespace tessera::abi_0_1
