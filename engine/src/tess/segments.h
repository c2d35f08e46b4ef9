#pragma once
// How the parameters of a patch are divided.

#include <algorithm>
#include <cstdint>

#include "tess/patch_triangles.h"

namespace tessera {

/// Rates stay at most this, those of halves too: parameters i / rate are then well apart in float.
inline constexpr int most_rate = 4096;

/// The segments of a parameter from 0 to 1: all of one length, or those of each half.
struct Segments {
  std::uint16_t rate = 0;   ///< how many
  std::uint16_t lower = 0;  ///< how many below 1/2, where those are others than above; 0: all of one length

  constexpr Segments() = default;
  constexpr Segments(int all) : rate(static_cast<std::uint16_t>(all)) {}
  static constexpr Segments halves(int lower, int upper) {
    Segments both(lower + upper);
    if (lower != upper) both.lower = static_cast<std::uint16_t>(lower);
    return both;
  }
  friend constexpr bool operator==(Segments, Segments) = default;

  constexpr bool is_uniform() const { return lower == 0; }
  /// Whether 1/2 lies within none of them.
  constexpr bool parts_halves() const { return !is_uniform() || rate % 2 == 0; }
  /// The rate at which uniform segments are as long as those of a half.
  constexpr int lower_rate() const { return is_uniform() ? rate : 2 * lower; }
  constexpr int upper_rate() const { return is_uniform() ? rate : 2 * (rate - lower); }
  constexpr int coarsest_rate() const { return std::min(lower_rate(), upper_rate()); }
  /// As they are against the parameter.
  constexpr Segments reversed() const {
    Segments back = *this;
    if (!is_uniform()) back.lower = static_cast<std::uint16_t>(rate - lower);
    return back;
  }

  struct Fraction {
    int numerator, denominator;
    constexpr double value() const { return double(numerator) / denominator; }
    constexpr double rest() const { return double(denominator - numerator) / denominator; }  ///< up to 1
  };
  /// Where segment k begins, k = 0 .. rate. Of reversed() segments the numerators are the others' rests: value() and rest()
  /// change places, bit for bit.
  constexpr Fraction at(int k) const {
    if (is_uniform()) return {k, rate};
    if (k <= lower) return {k, 2 * lower};
    const int upper = rate - lower;
    return {upper + k - lower, 2 * upper};
  }
};

/// Those of both parameters.
struct PatchSegments {
  Segments u = 1, v = 1;

  constexpr PatchSegments() = default;
  constexpr PatchSegments(Segments along_u, Segments along_v) : u(along_u), v(along_v) {}
  constexpr PatchSegments(Rates rates) : u(rates.u), v(rates.v) {}
  friend constexpr bool operator==(const PatchSegments&, const PatchSegments&) = default;

  constexpr bool are_uniform() const { return u.is_uniform() && v.is_uniform(); }
  constexpr Rates rates() const { return {u.rate, v.rate}; }
  /// Those of uniform segments as long as the longest.
  constexpr Rates coarsest() const { return {u.coarsest_rate(), v.coarsest_rate()}; }
  constexpr double cells() const { return double(u.rate) * v.rate; }
  /// Those of uniform segments as long as a quarter's, by the halves of u and v, 1 being the upper ones.
  constexpr Rates of_quarter(int half_u, int half_v) const {
    return {half_u ? u.upper_rate() : u.lower_rate(), half_v ? v.upper_rate() : v.lower_rate()};
  }
};

}  // namespace tessera
