#pragma once
// Describes how the parameters of a patch are divided.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "tess/cells/patch_triangles.h"

namespace tessera { inline namespace abi_0_1 {

/// The largest rate, also of halves: up to it, parameters i / rate are well apart in float.
inline constexpr int max_rate = 4096;

/// The segments of a parameter from 0 to 1.
///
/// - Uniform: all of one length.
/// - Halves: of one length in each half.
/// - Graded: `weight(e)` is the weight of eighth e. The segments are so long that each has the same integral of the
///   weights: either over the whole parameter, or over each half, which then has a number of segments of its own.
///
/// The rate in an eighth is that of uniform segments as long as those that lie in it. Segments that cross from one
/// eighth to another have a sum of (length in an eighth) x (rate there) of 1. Stored as one word: after stores of its
/// parts, a copy of the whole would wait for them.
class Segments {
 public:
  static constexpr int parts = 8, weight_count = 32, max_weight = 77;
  /// The weights that an eighth may have: exact up to 16, then with steps of about a tenth.
  static constexpr std::array<std::uint8_t, weight_count> weights = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                                     12, 13, 14, 15, 16, 18, 20, 22, 24, 27, 30,
                                                                     33, 36, 40, 44, 48, 53, 58, 64, 70, 77};
  /// Places in `weights`, one for each eighth.
  using Grades = std::array<std::uint8_t, parts>;
  /// The largest number of graded segments.
  static constexpr int max_graded = 1023;

  constexpr Segments() = default;  ///< none
  constexpr Segments(int all) : word_(static_cast<std::uint64_t>(all)) { assert(all >= 0 && all <= max_rate); }
  static constexpr Segments halves(int lower, int upper) {
    Segments both(lower + upper);
    if (lower != upper) both.word_ |= static_cast<std::uint64_t>(lower) << rate_bits;
    return both;
  }
  /// Returns graded segments, `lower` of them in the lower half; 0 if it has no number of its own.
  static constexpr Segments graded(int all, int lower, const Grades& grades) {
    assert(all >= 1 && all <= max_graded && lower >= 0 && lower < all);
    const auto are_equal = [&](int from, int to) {
      for (int e = from + 1; e < to; ++e)
        if (grades[static_cast<std::size_t>(e)] != grades[static_cast<std::size_t>(from)]) return false;
      return true;
    };
    if (lower == 0 && are_equal(0, parts)) return all;
    if (lower != 0 && are_equal(0, 4) && are_equal(4, parts)) return halves(lower, all - lower);
    Segments result;
    result.word_ = graded_bit | static_cast<std::uint64_t>(lower) << rate_bits | static_cast<std::uint64_t>(all);
    for (std::size_t e = 0; e < parts; ++e)
      result.word_ |= static_cast<std::uint64_t>(grades[e]) << (rate_bits + lower_bits + grade_bits * e);
    return result;
  }
  friend constexpr bool operator==(Segments, Segments) = default;

  constexpr bool is_uniform() const { return word_ >> rate_bits == 0; }
  constexpr bool is_graded() const { return word_ >> 63 != 0; }
  /// The number of segments.
  constexpr int rate() const { return static_cast<int>(word_ & ((1u << rate_bits) - 1)); }
  /// Returns a number that differs for different segments; below 2^13 if they are uniform.
  constexpr std::uint64_t key() const { return word_; }
  /// Whether all segments are uniform whose keys' bits are in `keys`.
  static constexpr bool are_uniform(std::uint64_t keys) { return keys >> rate_bits == 0; }
  /// Whether 1/2 lies inside no segment; graded segments have a point there only if the halves have numbers of their
  /// own. Without a branch, because odd rates come at random.
  constexpr bool parts_halves() const {
    return bool(int{has_lower()} | (int{is_uniform()} & static_cast<int>(~word_ & 1)));
  }
  /// The number of segments in the lower half, if parts_halves().
  constexpr int in_lower_half() const {
    return is_uniform()  ? rate() / 2
           : is_graded() ? static_cast<int>(word_ >> rate_bits & ((1u << lower_bits) - 1))
                         : static_cast<int>(word_ >> rate_bits);
  }
  /// The weight of an eighth; 1 if the segments are not graded.
  constexpr int weight(int eighth) const {
    if (!is_graded()) return 1;
    return weights[word_ >> (rate_bits + lower_bits + grade_bits * eighth) & (weight_count - 1)];
  }

  struct Fraction {
    int numerator, denominator;
    constexpr double value() const { return double(numerator) / denominator; }
    constexpr double rest() const { return double(denominator - numerator) / denominator; }  ///< 1 - value()
    friend constexpr bool operator<(Fraction a, Fraction b) {
      return std::int64_t{a.numerator} * b.denominator < std::int64_t{b.numerator} * a.denominator;
    }
  };
  /// Returns the rate in an eighth.
  constexpr Fraction rate_in(int eighth) const {
    if (is_uniform()) return {rate(), 1};
    const Run run = run_of(eighth >= parts / 2);
    return {parts * run.count * weight(eighth), sum_of_weights(run.begin, run.end)};
  }
  /// The least rate in a half, rounded down; at least 1, because no segment is longer than the parameter.
  constexpr int lower_rate() const { return least_rate(0, parts / 2); }
  constexpr int upper_rate() const { return least_rate(parts / 2, parts); }
  constexpr int coarsest_rate() const { return std::min(lower_rate(), upper_rate()); }
  /// Returns the segments seen against the direction of the parameter.
  constexpr Segments reversed() const {
    if (is_uniform()) return *this;
    if (!is_graded()) return halves(rate() - in_lower_half(), in_lower_half());
    Grades grades{};
    for (std::size_t e = 0; e < parts; ++e)
      grades[parts - 1 - e] = static_cast<std::uint8_t>(word_ >> (rate_bits + lower_bits + grade_bits * e) & 31);
    return graded(rate(), has_lower() ? rate() - in_lower_half() : 0, grades);
  }

  /// Returns where segment k = 0 .. rate begins; rate: 1. For reversed() segments value() and rest() are exchanged, bit
  /// for bit.
  constexpr Fraction at(int k) const {
    if (is_uniform()) return {k, rate()};
    const bool is_upper = parts_halves() && k > in_lower_half();
    const Run run = run_of(is_upper);
    const int along = (k - (is_upper ? in_lower_half() : 0)) * sum_of_weights(run.begin, run.end);
    // The eighth in which the integral of the weights, times the number of segments, reaches `along`.
    int eighth = run.begin, before = 0;
    for (; eighth + 1 < run.end && before + run.count * weight(eighth) <= along; ++eighth)
      before += run.count * weight(eighth);
    const int whole = run.count * weight(eighth);
    return {eighth * whole + (along - before), parts * whole};
  }

 private:
  static constexpr int rate_bits = 13;                   // up to max_rate
  static constexpr int lower_bits = 10, grade_bits = 5;  // of graded segments
  static constexpr std::uint64_t graded_bit = std::uint64_t{1} << 63;

  /// Eighths over which segments have the same integral, and their number.
  struct Run {
    int begin, end, count;
  };
  constexpr bool has_lower() const { return !is_uniform() && in_lower_half() != 0; }
  constexpr Run run_of(bool is_upper) const {
    if (!has_lower()) return {0, parts, rate()};
    return is_upper ? Run{parts / 2, parts, rate() - in_lower_half()} : Run{0, parts / 2, in_lower_half()};
  }
  constexpr int sum_of_weights(int begin, int end) const {
    int sum = 0;
    for (int e = begin; e < end; ++e) sum += weight(e);
    return sum;
  }
  constexpr int least_rate(int begin, int end) const {
    if (is_uniform()) return rate();
    const Run run = run_of(begin > 0);
    int least = max_weight;
    for (int e = begin; e < end; ++e) least = std::min(least, weight(e));
    return std::max(1, parts * run.count * least / sum_of_weights(run.begin, run.end));
  }

  /// The rate; for halves, lower << rate_bits above it if it differs from the upper; for graded segments see graded().
  std::uint64_t word_ = 0;
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

}}  // namespace tessera::abi_0_1
