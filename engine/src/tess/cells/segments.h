#pragma once
// Describes how the parameters of a patch are divided.

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "tess/cells/patch_triangles.h"

namespace tessera::inline abi_0_1 {

/// The largest rate, also of halves: up to it, parameters i / rate are well apart in float.
inline constexpr int max_rate = 4096;

/// The segments of a parameter from 0 to 1: all of one length, or of one length in each half. Stored as one word: after
/// stores of its parts, a copy of the whole would wait for them.
class Segments {
 public:
  constexpr Segments() = default;  ///< none
  constexpr Segments(int all) : word_(static_cast<std::uint32_t>(all)) { assert(all >= 0 && all <= max_rate); }
  static constexpr Segments halves(int lower, int upper) {
    Segments both(lower + upper);
    if (lower != upper) both.word_ |= static_cast<std::uint32_t>(lower) << rate_bits;
    return both;
  }
  friend constexpr bool operator==(Segments, Segments) = default;

  constexpr bool is_uniform() const { return word_ >> rate_bits == 0; }
  constexpr int rate() const { return static_cast<int>(word_ & ((1u << rate_bits) - 1)); }  ///< the number of segments
  /// Returns a number that differs for different segments.
  constexpr std::uint32_t key() const { return word_; }
  /// Whether 1/2 lies inside no segment. Without a branch, because odd rates come at random.
  constexpr bool parts_halves() const { return bool(int{!is_uniform()} | (rate() % 2 == 0)); }
  /// The rate at which uniform segments are as long as those of one half.
  constexpr int lower_rate() const { return is_uniform() ? rate() : 2 * lower(); }
  constexpr int upper_rate() const { return is_uniform() ? rate() : 2 * upper(); }
  constexpr int coarsest_rate() const { return std::min(lower_rate(), upper_rate()); }
  /// Returns the segments seen against the direction of the parameter.
  constexpr Segments reversed() const { return is_uniform() ? *this : halves(upper(), lower()); }

  struct Fraction {
    int numerator, denominator;
    constexpr double value() const { return double(numerator) / denominator; }
    constexpr double rest() const { return double(denominator - numerator) / denominator; }  ///< 1 - value()
  };
  /// Returns where segment k = 0 .. rate begins; rate: 1. For reversed() segments value() and rest() are exchanged, bit
  /// for bit.
  constexpr Fraction at(int k) const {
    if (is_uniform()) return {k, rate()};
    if (k <= lower()) return {k, 2 * lower()};
    return {upper() + k - lower(), 2 * upper()};
  }

 private:
  static constexpr int rate_bits = 13;  // up to max_rate
  // The numbers of segments in the halves, where they differ.
  constexpr int lower() const { return static_cast<int>(word_ >> rate_bits); }
  constexpr int upper() const { return rate() - lower(); }

  std::uint32_t word_ = 0;  ///< the rate; in the bits above it lower() if the halves differ, else 0
};

/// The segments of both parameters of a patch.
struct PatchSegments {
  Segments u = 1, v = 1;

  constexpr PatchSegments() = default;
  constexpr PatchSegments(Segments along_u, Segments along_v) : u(along_u), v(along_v) {}
  constexpr PatchSegments(Rates rates) : u(rates.u), v(rates.v) {}
  friend constexpr bool operator==(const PatchSegments&, const PatchSegments&) = default;

  constexpr bool are_uniform() const { return u.is_uniform() && v.is_uniform(); }
  constexpr Rates rates() const { return {u.rate(), v.rate()}; }
  /// The rates of uniform segments as long as the longest ones.
  constexpr Rates coarsest() const { return {u.coarsest_rate(), v.coarsest_rate()}; }
  constexpr double cells() const { return double(u.rate()) * v.rate(); }
  /// The rates of uniform segments as long as those of a quarter; half_u and half_v: 0 is the lower half, 1 the upper.
  constexpr Rates of_quarter(int half_u, int half_v) const {
    return {half_u ? u.upper_rate() : u.lower_rate(), half_v ? v.upper_rate() : v.lower_rate()};
  }
};

}  // namespace tessera::inline abi_0_1
