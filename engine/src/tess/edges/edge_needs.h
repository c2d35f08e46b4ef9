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

/// The needs of patches with uniform segments.
struct EdgeNeeds {
  std::uint16_t most = 1;  ///< the largest rate of the patches
  /// 1: the edge's rate must be even, for a patch whose triangles must not cross the middle.
  std::uint8_t is_even = 0;
  std::uint8_t patches = 0;  ///< 0, 1, or 2 for more; twice the same one counts as two

  /// `never`: 1 for a patch none of whose triangles may cross the middle.
  void add(Segments along, std::uint16_t never) {
    most = std::max(most, static_cast<std::uint16_t>(along.rate()));
    is_even = static_cast<std::uint8_t>(is_even | (never & along.parts_halves()));
    patches = static_cast<std::uint8_t>(1 + (patches != 0));
  }
  Segments segments() const { return most + (most & is_even); }
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
  Segments segments(bool against, std::uint16_t is_even) const {
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
