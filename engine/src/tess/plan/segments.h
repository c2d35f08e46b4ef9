#pragma once
// How the parameters of a patch are divided.

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "tess/write/patch_triangles.h"

namespace tessera::inline abi_0_1 {

/// Rates stay at most this, those of halves too: parameters i / rate are then well apart in float.
inline constexpr int max_rate = 4096;

/// The segments of a parameter from 0 to 1: all of one length, or those of each half. One word: where halves of it are
/// stored, copies of the whole wait for them.
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
  constexpr int rate() const { return static_cast<int>(word_ & ((1u << rate_bits) - 1)); }  ///< how many
  /// Another number for others.
  constexpr std::uint32_t key() const { return word_; }
  /// Whether 1/2 lies within none of them. Without a branch, as odd rates come at random.
  constexpr bool parts_halves() const { return bool(int{!is_uniform()} | (rate() % 2 == 0)); }
  /// The rate at which uniform segments are as long as those of a half.
  constexpr int lower_rate() const { return is_uniform() ? rate() : 2 * lower(); }
  constexpr int upper_rate() const { return is_uniform() ? rate() : 2 * upper(); }
  constexpr int coarsest_rate() const { return std::min(lower_rate(), upper_rate()); }
  /// As they are against the parameter.
  constexpr Segments reversed() const { return is_uniform() ? *this : halves(upper(), lower()); }

  struct Fraction {
    int numerator, denominator;
    constexpr double value() const { return double(numerator) / denominator; }
    constexpr double rest() const { return double(denominator - numerator) / denominator; }  ///< up to 1
  };
  /// Where segment k begins, k = 0 .. rate. Of reversed() segments the numerators are the others' rests: value() and rest()
  /// change places, bit for bit.
  constexpr Fraction at(int k) const {
    if (is_uniform()) return {k, rate()};
    if (k <= lower()) return {k, 2 * lower()};
    return {upper() + k - lower(), 2 * upper()};
  }

 private:
  static constexpr int rate_bits = 13;  // up to max_rate
  // Where those of the halves differ.
  constexpr int lower() const { return static_cast<int>(word_ >> rate_bits); }
  constexpr int upper() const { return rate() - lower(); }

  std::uint32_t word_ = 0;  ///< the rate; above it how many are below 1/2, where those are others than above
};

/// Those of both parameters.
struct PatchSegments {
  Segments u = 1, v = 1;

  constexpr PatchSegments() = default;
  constexpr PatchSegments(Segments along_u, Segments along_v) : u(along_u), v(along_v) {}
  constexpr PatchSegments(Rates rates) : u(rates.u), v(rates.v) {}
  friend constexpr bool operator==(const PatchSegments&, const PatchSegments&) = default;

  constexpr bool are_uniform() const { return u.is_uniform() && v.is_uniform(); }
  constexpr Rates rates() const { return {u.rate(), v.rate()}; }
  /// Those of uniform segments as long as the longest.
  constexpr Rates coarsest() const { return {u.coarsest_rate(), v.coarsest_rate()}; }
  constexpr double cells() const { return double(u.rate()) * v.rate(); }
  /// Those of uniform segments as long as a quarter's, by the halves of u and v, 1 being the upper ones.
  constexpr Rates of_quarter(int half_u, int half_v) const {
    return {half_u ? u.upper_rate() : u.lower_rate(), half_v ? v.upper_rate() : v.lower_rate()};
  }
};

}  // namespace tessera::inline abi_0_1
