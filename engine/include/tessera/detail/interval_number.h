#pragma once
// Interval arithmetic: numbers known to lie between two doubles, so that what is computed of them is a proof.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// All real numbers from lower() to upper(), or, where an operation is not defined or not bounded for all of them (the
/// reciprocal of an interval with 0, the root of one with negative numbers), "no bound": both ends NaN, and so is all
/// that is computed of it. Every operation's result holds that of every choice of numbers, whatever the rounding: the
/// basic operations and sqrt go a double or two outwards (Moore, Kearfott and Cloud, Introduction to Interval Analysis,
/// 2009); elementary functions go four or more, twice what the C library's documented errors need. There is no order:
/// an expression with branches does not compile.
class IntervalNumber {
 public:
  IntervalNumber(double value = 0) : lower_(value), upper_(value) {}  ///< the one number
  /// lower <= upper; otherwise, and for NaN, no bound.
  IntervalNumber(double lower, double upper) : lower_(lower), upper_(upper) {
    if (!(lower <= upper)) *this = none();
  }
  static IntervalNumber none() { return std::numeric_limits<double>::quiet_NaN(); }  ///< bounds of nothing: NaN

  double lower() const { return lower_; }                                             ///< the lower end
  double upper() const { return upper_; }                                             ///< the upper end
  bool is_bounded() const { return std::isfinite(lower_) && std::isfinite(upper_); }  ///< whether both ends are finite
  bool contains(double value) const { return lower_ <= value && value <= upper_; }    ///< ends included
  /// The largest absolute value; infinity where there is no bound.
  double magnitude() const {
    const double largest = std::max(std::abs(lower_), std::abs(upper_));
    return largest >= 0 ? largest : std::numeric_limits<double>::infinity();
  }

  /// From values rounded to nearest: their hull, at least `steps` doubles wider each way; no bound if one is NaN.
  template <int steps = 1, class... Values>
  static IntervalNumber around(Values... values) {
    if ((std::isnan(values) || ...)) return none();
    const double low = std::min({values...}), high = std::max({values...});
    return {low - steps * a_step(low), high + steps * a_step(high)};
  }

  friend bool operator==(const IntervalNumber&, const IntervalNumber&) = default;              ///< by both ends
  friend IntervalNumber operator-(const IntervalNumber& a) { return {-a.upper_, -a.lower_}; }  ///< -a, exactly
  /// Holds every sum.
  friend IntervalNumber operator+(const IntervalNumber& a, const IntervalNumber& b) {
    if (a == 0.0) return b;
    if (b == 0.0) return a;
    const IntervalNumber sum = around(a.lower_ + b.lower_, a.upper_ + b.upper_);
    return a.lower_ >= 0 && b.lower_ >= 0 ? clamped(sum, 0, infinity) : sum;
  }
  /// Holds every difference.
  friend IntervalNumber operator-(const IntervalNumber& a, const IntervalNumber& b) { return a + (-b); }
  /// The product of one object with itself is its square, and not negative.
  friend IntervalNumber operator*(const IntervalNumber& a, const IntervalNumber& b) {
    if (&a == &b) return square(a);
    if (a == 1.0) return b;
    if (b == 1.0) return a;
    if ((a == 0.0 && b.is_bounded()) || (b == 0.0 && a.is_bounded())) return 0.0;
    const IntervalNumber product =
        around(a.lower_ * b.lower_, a.lower_ * b.upper_, a.upper_ * b.lower_, a.upper_ * b.upper_);
    return a.lower_ >= 0 && b.lower_ >= 0 ? clamped(product, 0, infinity) : product;
  }
  /// Holds every quotient; everything where b holds 0.
  friend IntervalNumber operator/(const IntervalNumber& a, const IntervalNumber& b) {
    if (!(b.lower_ > 0) && !(b.upper_ < 0)) return none();
    if (b == 1.0) return a;
    return around(a.lower_ / b.lower_, a.lower_ / b.upper_, a.upper_ / b.lower_, a.upper_ / b.upper_);
  }
  IntervalNumber& operator+=(const IntervalNumber& b) { return *this = *this + b; }  ///< as +
  IntervalNumber& operator-=(const IntervalNumber& b) { return *this = *this - b; }  ///< as -
  IntervalNumber& operator*=(const IntervalNumber& b) { return *this = *this * b; }  ///< as *
  IntervalNumber& operator/=(const IntervalNumber& b) { return *this = *this / b; }  ///< as /

  /// Holds every |x|.
  friend IntervalNumber abs(const IntervalNumber& a) {
    if (a.lower_ >= 0) return a;
    if (a.upper_ <= 0) return -a;
    return {0, a.magnitude_or_nan()};
  }
  /// Holds every x^2.
  friend IntervalNumber square(const IntervalNumber& a) {
    const IntervalNumber b = abs(a);
    return clamped(around(b.lower_ * b.lower_, b.upper_ * b.upper_), 0, infinity);
  }
  /// Holds every root; none() where a is below 0.
  friend IntervalNumber sqrt(const IntervalNumber& a) {
    if (!(a.lower_ >= 0)) return none();
    return clamped(around(std::sqrt(a.lower_), std::sqrt(a.upper_)), 0, infinity);
  }
  /// Holds every e^x.
  friend IntervalNumber exp(const IntervalNumber& a) {
    return clamped(around<4>(std::exp(a.lower_), std::exp(a.upper_)), 0, infinity);
  }
  /// Holds every natural logarithm; none() where a reaches 0.
  friend IntervalNumber log(const IntervalNumber& a) {
    if (!(a.lower_ > 0)) return none();
    return around<4>(std::log(a.lower_), std::log(a.upper_));
  }
  /// Holds every sine.
  friend IntervalNumber sin(const IntervalNumber& a) {
    return wave(a, std::sin(a.lower_), std::sin(a.upper_), std::numbers::pi / 2);
  }
  /// Holds every cosine.
  friend IntervalNumber cos(const IntervalNumber& a) { return wave(a, std::cos(a.lower_), std::cos(a.upper_), 0); }
  /// No bound where the interval may hold a pole.
  friend IntervalNumber tan(const IntervalNumber& a) {
    if (holds_multiple(a, std::numbers::pi / 2, std::numbers::pi)) return none();
    return around<4>(std::tan(a.lower_), std::tan(a.upper_));
  }
  /// Holds every arc tangent.
  friend IntervalNumber atan(const IntervalNumber& a) { return around<4>(std::atan(a.lower_), std::atan(a.upper_)); }
  /// Holds every arc sine; none() outside of [-1, 1].
  friend IntervalNumber asin(const IntervalNumber& a) {
    if (!(a.lower_ >= -1 && a.upper_ <= 1)) return none();
    return around<4>(std::asin(a.lower_), std::asin(a.upper_));
  }
  /// Holds every arc cosine; none() outside of [-1, 1].
  friend IntervalNumber acos(const IntervalNumber& a) {
    if (!(a.lower_ >= -1 && a.upper_ <= 1)) return none();
    return around<4>(std::acos(a.lower_), std::acos(a.upper_));
  }
  /// Holds every hyperbolic sine.
  friend IntervalNumber sinh(const IntervalNumber& a) { return around<4>(std::sinh(a.lower_), std::sinh(a.upper_)); }
  /// Holds every hyperbolic cosine.
  friend IntervalNumber cosh(const IntervalNumber& a) {
    const IntervalNumber b = abs(a);
    return clamped(around<4>(std::cosh(b.lower_), std::cosh(b.upper_)), 1, infinity);
  }
  /// Holds every hyperbolic tangent.
  friend IntervalNumber tanh(const IntervalNumber& a) {
    return clamped(around<4>(std::tanh(a.lower_), std::tanh(a.upper_)), -1, 1);
  }
  /// a^0 is 1. A power that is no integer wants numbers that are not negative, a negative one numbers without 0.
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

  /// At least the distance to the next double; what is infinite becomes NaN in the end, no bound.
  static double a_step(double x) { return std::abs(x) * 0x1p-52 + std::numeric_limits<double>::min(); }
  double magnitude_or_nan() const { return std::isnan(lower_) ? lower_ : magnitude(); }
  /// What is known besides: that the result lies in [low, high].
  static IntervalNumber clamped(const IntervalNumber& a, double low, double high) {
    if (std::isnan(a.lower_)) return a;
    return {std::max(a.lower_, low), std::min(a.upper_, high)};
  }
  /// Whether some phase + k period may lie within; the slack is far above the rounding of the quotients below 2^20
  /// turns.
  static bool holds_multiple(const IntervalNumber& a, double phase, double period) {
    if (!(a.magnitude() < 1e6)) return true;
    return std::floor((a.upper_ - phase) / period + 1e-8) >= std::ceil((a.lower_ - phase) / period - 1e-8);
  }
  /// sin or cos, whose maxima lie at phase + 2 k pi.
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

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
