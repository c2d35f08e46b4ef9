#pragma once
// Interval arithmetic: numbers known to lie between two doubles, so that results computed from them are proven bounds.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// An interval of real numbers, from lower() to upper(). The result of every operation contains the result for every
/// choice of numbers, whatever the rounding:
///
/// - The basic operations and sqrt are widened by a double or two on each side (Moore, Kearfott and Cloud, Introduction
///   to Interval Analysis, 2009).
/// - Elementary functions are widened by four or more, twice what the C library's documented errors need.
///
/// Where an operation is not defined or not bounded for all numbers of an interval (the reciprocal of an interval with
/// 0, the root of one with negative numbers), the result is "no bound": both ends are NaN, and every result computed
/// from it is no bound too. There is no order: an expression with branches does not compile.
class IntervalNumber {
 public:
  IntervalNumber(double value = 0) : lower_(value), upper_(value) {}  ///< a single number
  /// An interval with lower <= upper. Otherwise, and for NaN, it is no bound.
  IntervalNumber(double lower, double upper) : lower_(lower), upper_(upper) {
    if (!(lower <= upper)) *this = none();
  }
  static IntervalNumber none() { return std::numeric_limits<double>::quiet_NaN(); }  ///< no bound: NaN

  double lower() const { return lower_; }                                             ///< the lower end
  double upper() const { return upper_; }                                             ///< the upper end
  bool is_bounded() const { return std::isfinite(lower_) && std::isfinite(upper_); }  ///< whether both ends are finite
  bool contains(double value) const { return lower_ <= value && value <= upper_; }    ///< ends included
  /// Returns the largest absolute value; infinity if there is no bound.
  double magnitude() const {
    const double largest = std::max(std::abs(lower_), std::abs(upper_));
    return largest >= 0 ? largest : std::numeric_limits<double>::infinity();
  }

  /// Makes the hull of values that are rounded to nearest, at least `steps` doubles wider on each side; no bound if one
  /// is NaN.
  template <int steps = 1, class... Values>
  static IntervalNumber around(Values... values) {
    if ((std::isnan(values) || ...)) return none();
    const double low = std::min({values...}), high = std::max({values...});
    return {low - steps * a_step(low), high + steps * a_step(high)};
  }

  friend bool operator==(const IntervalNumber&, const IntervalNumber&) = default;              ///< compares both ends
  friend IntervalNumber operator-(const IntervalNumber& a) { return {-a.upper_, -a.lower_}; }  ///< -a, exactly
  /// Contains every sum.
  friend IntervalNumber operator+(const IntervalNumber& a, const IntervalNumber& b) {
    if (a == 0.0) return b;
    if (b == 0.0) return a;
    const IntervalNumber sum = around(a.lower_ + b.lower_, a.upper_ + b.upper_);
    return a.lower_ >= 0 && b.lower_ >= 0 ? clamped(sum, 0, infinity) : sum;
  }
  /// Contains every difference.
  friend IntervalNumber operator-(const IntervalNumber& a, const IntervalNumber& b) { return a + (-b); }
  /// Contains every product. An object times itself is its square, and not negative.
  friend IntervalNumber operator*(const IntervalNumber& a, const IntervalNumber& b) {
    if (&a == &b) return square(a);
    if (a == 1.0) return b;
    if (b == 1.0) return a;
    if ((a == 0.0 && b.is_bounded()) || (b == 0.0 && a.is_bounded())) return 0.0;
    const IntervalNumber product =
        around(a.lower_ * b.lower_, a.lower_ * b.upper_, a.upper_ * b.lower_, a.upper_ * b.upper_);
    return a.lower_ >= 0 && b.lower_ >= 0 ? clamped(product, 0, infinity) : product;
  }
  /// Contains every quotient; no bound if b contains 0.
  friend IntervalNumber operator/(const IntervalNumber& a, const IntervalNumber& b) {
    if (!(b.lower_ > 0) && !(b.upper_ < 0)) return none();
    if (b == 1.0) return a;
    return around(a.lower_ / b.lower_, a.lower_ / b.upper_, a.upper_ / b.lower_, a.upper_ / b.upper_);
  }
  IntervalNumber& operator+=(const IntervalNumber& b) { return *this = *this + b; }
  IntervalNumber& operator-=(const IntervalNumber& b) { return *this = *this - b; }
  IntervalNumber& operator*=(const IntervalNumber& b) { return *this = *this * b; }
  IntervalNumber& operator/=(const IntervalNumber& b) { return *this = *this / b; }

  /// Contains every |x|.
  friend IntervalNumber abs(const IntervalNumber& a) {
    if (a.lower_ >= 0) return a;
    if (a.upper_ <= 0) return -a;
    return {0, a.magnitude_or_nan()};
  }
  /// Contains every x^2.
  friend IntervalNumber square(const IntervalNumber& a) {
    const IntervalNumber b = abs(a);
    return clamped(around(b.lower_ * b.lower_, b.upper_ * b.upper_), 0, infinity);
  }
  /// Contains every root; none() if a has negative numbers.
  friend IntervalNumber sqrt(const IntervalNumber& a) {
    if (!(a.lower_ >= 0)) return none();
    return clamped(around(std::sqrt(a.lower_), std::sqrt(a.upper_)), 0, infinity);
  }
  /// Contains every e^x.
  friend IntervalNumber exp(const IntervalNumber& a) {
    return clamped(around<4>(std::exp(a.lower_), std::exp(a.upper_)), 0, infinity);
  }
  /// Contains every natural logarithm; none() if a has numbers that are not above 0.
  friend IntervalNumber log(const IntervalNumber& a) {
    if (!(a.lower_ > 0)) return none();
    return around<4>(std::log(a.lower_), std::log(a.upper_));
  }
  /// Contains every sine.
  friend IntervalNumber sin(const IntervalNumber& a) {
    return wave(a, std::sin(a.lower_), std::sin(a.upper_), std::numbers::pi / 2);
  }
  /// Contains every cosine.
  friend IntervalNumber cos(const IntervalNumber& a) { return wave(a, std::cos(a.lower_), std::cos(a.upper_), 0); }
  /// Contains every tangent; no bound if the interval may contain a pole.
  friend IntervalNumber tan(const IntervalNumber& a) {
    if (holds_multiple(a, std::numbers::pi / 2, std::numbers::pi)) return none();
    return around<4>(std::tan(a.lower_), std::tan(a.upper_));
  }
  /// Contains every arc tangent.
  friend IntervalNumber atan(const IntervalNumber& a) { return around<4>(std::atan(a.lower_), std::atan(a.upper_)); }
  /// Contains every arc sine; none() if a leaves [-1, 1].
  friend IntervalNumber asin(const IntervalNumber& a) {
    if (!(a.lower_ >= -1 && a.upper_ <= 1)) return none();
    return around<4>(std::asin(a.lower_), std::asin(a.upper_));
  }
  /// Contains every arc cosine; none() if a leaves [-1, 1].
  friend IntervalNumber acos(const IntervalNumber& a) {
    if (!(a.lower_ >= -1 && a.upper_ <= 1)) return none();
    return around<4>(std::acos(a.lower_), std::acos(a.upper_));
  }
  /// Contains every hyperbolic sine.
  friend IntervalNumber sinh(const IntervalNumber& a) { return around<4>(std::sinh(a.lower_), std::sinh(a.upper_)); }
  /// Contains every hyperbolic cosine.
  friend IntervalNumber cosh(const IntervalNumber& a) {
    const IntervalNumber b = abs(a);
    return clamped(around<4>(std::cosh(b.lower_), std::cosh(b.upper_)), 1, infinity);
  }
  /// Contains every hyperbolic tangent.
  friend IntervalNumber tanh(const IntervalNumber& a) {
    return clamped(around<4>(std::tanh(a.lower_), std::tanh(a.upper_)), -1, 1);
  }
  /// Contains every power; a^0 is 1. A non-integer exponent needs numbers that are not negative, a negative exponent
  /// needs numbers without 0; otherwise the result is none().
  friend IntervalNumber pow(const IntervalNumber& a, double exponent) {
    if (exponent == 0) return 1.0;
    const bool whole = exponent == std::floor(exponent);
    if (exponent < 0 && !(a.lower_ > 0) && !(whole && a.upper_ < 0)) return none();
    if (!whole && !(a.lower_ >= 0)) return none();
    const bool even = whole && std::fmod(exponent, 2) == 0;
    const IntervalNumber b = even ? abs(a) : a;
    const IntervalNumber power = around<4>(std::pow(b.lower_, exponent), std::pow(b.upper_, exponent));
    return b.lower_ >= 0 ? clamped(power, 0, infinity) : power;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// At least the distance from x to the next double. If x is infinite, the end computed with it becomes NaN: no bound.
  static double a_step(double x) { return std::abs(x) * 0x1p-52 + std::numeric_limits<double>::min(); }
  double magnitude_or_nan() const { return std::isnan(lower_) ? lower_ : magnitude(); }
  /// Cuts the interval to [low, high], in which the result is known to lie.
  static IntervalNumber clamped(const IntervalNumber& a, double low, double high) {
    if (std::isnan(a.lower_)) return a;
    return {std::max(a.lower_, low), std::min(a.upper_, high)};
  }
  /// Whether some phase + k period may lie within. The slack is far above the rounding of the quotients below 2^20
  /// turns.
  static bool holds_multiple(const IntervalNumber& a, double phase, double period) {
    if (!(a.magnitude() < 1e6)) return true;
    return std::floor((a.upper_ - phase) / period + 1e-8) >= std::ceil((a.lower_ - phase) / period - 1e-8);
  }
  /// Bounds sin or cos, whose maxima are at phase + 2 k pi.
  static IntervalNumber wave(const IntervalNumber& a, double at_lower, double at_upper, double phase) {
    if (std::isnan(a.lower_)) return none();
    if (!(a.magnitude() < 1e6)) return {-1, 1};
    IntervalNumber values = around<4>(at_lower, at_upper);
    if (holds_multiple(a, phase, 2 * std::numbers::pi)) values.upper_ = 1;
    if (holds_multiple(a, phase + std::numbers::pi, 2 * std::numbers::pi)) values.lower_ = -1;
    return clamped(values, -1, 1);
  }

  double lower_, upper_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
