#pragma once
// Derivatives of any order by arithmetic on truncated Taylor series (automatic differentiation).

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "tessera/detail/interval_number.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A truncated Taylor series sum c_ij (u - u0)^i (v - v0)^j, i + j <= Order, of a function of one or two Variables.
/// c_ij is the function's derivative of order (i,j) at (u0,v0) over i! j!.
///
/// An operation on series gives the series of its result (Griewank and Walther, Evaluating Derivatives, 2nd ed., ch.
/// 13). Scalar is double or, for bounds of the coefficients over all (u0,v0) of a rectangle, IntervalNumber. Where a
/// derivative is infinite (sqrt at 0) or not defined (abs at 0), the coefficients from its order on are infinite, NaN
/// or without bound; the value is unchanged. There is no order: an expression with branches does not compile.
template <class Scalar, int Order, int Variables = 2>
class Taylor {
  static_assert(Order >= 1 && (Variables == 1 || Variables == 2));

 public:
  /// Number of coefficients.
  static constexpr std::size_t size = Variables == 1 ? Order + 1 : (Order + 1) * (Order + 2) / 2;

  /// The constant 0.
  Taylor() : Taylor(0.0) {}
  Taylor(double constant) : Taylor(Scalar(constant), Filled{}) {}
  explicit Taylor(const Scalar& constant) requires(!std::is_same_v<Scalar, double>) : Taylor(constant, Filled{}) {}
  /// Makes the variable u (0) or v (1) at `value`.
  static Taylor variable(const Scalar& value, int which = 0) {
    Taylor t(value, Filled{});
    t.c_[static_cast<std::size_t>(1 + which)] = 1.0;
    return t;
  }

  /// Returns c_ij, i + j <= Order, with j = 0 in one variable.
  const Scalar& coefficient(int i, int j = 0) const { return c_[index(i, j)]; }
  const Scalar& value() const { return c_[0]; }  ///< the coefficient of order 0
  /// Returns the derivative of order (i,j): i! j! c_ij.
  Scalar derivative(int i, int j = 0) const {
    double factor = 1;  // exact up to 18!
    for (int k = 2; k <= i; ++k) factor *= k;
    for (int k = 2; k <= j; ++k) factor *= k;
    return factor * c_[index(i, j)];
  }

  /// Negates each coefficient.
  friend Taylor operator-(const Taylor& a) {
    Taylor r;
    for (std::size_t k = 0; k < size; ++k) r.c_[k] = -a.c_[k];
    return r;
  }
  /// Adds the coefficients.
  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    Taylor r;
    for (std::size_t k = 0; k < size; ++k) r.c_[k] = a.c_[k] + b.c_[k];
    return r;
  }
  friend Taylor operator-(const Taylor& a, const Taylor& b) { return a + (-b); }  ///< subtracts the coefficients
  /// The product, truncated at Order.
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor r = a.times_increment(b);
    if (&a == &b) {  // a square, which intervals know to be at least 0
      r.c_[0] = a.c_[0] * a.c_[0];
      for (std::size_t k = 1; k < size; ++k) r.c_[k] += a.c_[k] * a.c_[0];
      return r;
    }
    for (std::size_t k = 0; k < size; ++k) r.c_[k] += a.c_[k] * b.c_[0];
    return r;
  }
  /// The quotient, truncated at Order.
  friend Taylor operator/(const Taylor& a, const Taylor& b) { return a * reciprocal(b); }
  Taylor& operator+=(const Taylor& b) { return *this = *this + b; }  ///< like +
  Taylor& operator-=(const Taylor& b) { return *this = *this - b; }  ///< like -
  Taylor& operator*=(const Taylor& b) { return *this = *this * b; }  ///< like *
  Taylor& operator/=(const Taylor& b) { return *this = *this / b; }  ///< like /

  /// The square root.
  friend Taylor sqrt(const Taylor& x) { return x.composed(power_series(x.value(), 0.5, root(x.value()))); }
  /// The power of x with a constant exponent: any x for a whole exponent (x without 0 for a negative one), x > 0 for
  /// others.
  friend Taylor pow(const Taylor& x, double exponent) {
    using std::pow;
    // Multiples of 2^-32 remain exact when whole numbers are subtracted; then powers are computed one by one, also
    // at 0.
    const bool exact = std::abs(exponent) < 0x1p20 && std::floor(exponent * 0x1p32) == exponent * 0x1p32;
    if (!exact) return x.composed(power_series(x.value(), exponent, pow(x.value(), exponent)));
    Coefficients f;
    double binomial = 1;  // (exponent over k)
    for (int k = 0; k <= Order; ++k) {
      f[at(k)] = binomial == 0 ? Scalar(0.0) : ratio(binomial) * pow(x.value(), exponent - k);
      binomial = binomial * (exponent - k) / (k + 1);
    }
    return x.composed(f);
  }
  friend Taylor pow(const Taylor& x, const Taylor& y) { return exp(y * log(x)); }  ///< by exp and log: x > 0
  /// The exponential e^x.
  friend Taylor exp(const Taylor& x) {
    using std::exp;
    Coefficients f{exp(x.value())};
    for (int k = 1; k <= Order; ++k) f[at(k)] = f[at(k - 1)] / double(k);
    return x.composed(f);
  }
  /// The natural logarithm.
  friend Taylor log(const Taylor& x) {
    using std::log;
    const Scalar r = 1.0 / x.value();
    Coefficients f{log(x.value())};
    Scalar power = r;
    for (int k = 1; k <= Order; ++k, power = -(power * r)) f[at(k)] = power / double(k);
    return x.composed(f);
  }
  friend Taylor sin(const Taylor& x) { return x.composed(wave(x.value(), 0)); }         ///< the sine
  friend Taylor cos(const Taylor& x) { return x.composed(wave(x.value(), 1)); }         ///< the cosine
  friend Taylor sinh(const Taylor& x) { return x.composed(hyperbolic(x.value(), 0)); }  ///< the hyperbolic sine
  friend Taylor cosh(const Taylor& x) { return x.composed(hyperbolic(x.value(), 1)); }  ///< the hyperbolic cosine
  /// The tangent.
  friend Taylor tan(const Taylor& x) {
    using std::tan;
    return x.composed(tangent(tan(x.value()), 1.0));
  }
  /// The hyperbolic tangent.
  friend Taylor tanh(const Taylor& x) {
    using std::tanh;
    return x.composed(tangent(tanh(x.value()), -1.0));
  }
  /// The arc tangent: the integral of 1 / (1 + x^2).
  friend Taylor atan(const Taylor& x) {
    using std::atan;
    const Scalar r = 1.0 / (1.0 + x.value() * x.value());
    Coefficients f{atan(x.value())};
    Scalar before = 0.0, q = r;
    for (int k = 1; k <= Order; ++k) {
      f[at(k)] = q / double(k);
      const Scalar next = -(r * (2.0 * (x.value() * q) + before));
      before = q;
      q = next;
    }
    return x.composed(f);
  }
  /// The arc sine.
  friend Taylor asin(const Taylor& x) {
    using std::asin;
    return x.composed(arc(x.value(), asin(x.value()), 1.0));
  }
  /// The arc cosine.
  friend Taylor acos(const Taylor& x) {
    using std::acos;
    return x.composed(arc(x.value(), acos(x.value()), -1.0));
  }
  /// The absolute value, where x is not 0.
  friend Taylor abs(const Taylor& x) {
    using std::abs;
    Coefficients f{};
    f[0] = abs(x.value());
    f[1] = f[0] == x.value() ? Scalar(1.0) : f[0] == -x.value() ? Scalar(-1.0) : Scalar(undefined);
    if (x.value() == Scalar(0.0)) f[1] = Scalar(undefined);
    return x.composed(f);
  }

 private:
  struct Filled {};
  using Coefficients = std::array<Scalar, std::size_t{Order} + 1>;  // f^(k)(x0) / k!
  static constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

  Taylor(const Scalar& constant, Filled) {
    c_.fill(Scalar(0.0));
    c_[0] = constant;
  }

  static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }
  /// The index of c_ij: ordered by total order, then by the order in v.
  static constexpr std::size_t index(int i, int j) {
    if constexpr (Variables == 1) return at(i + j);
    return at((i + j) * (i + j + 1) / 2 + j);
  }
  /// The constant as a scalar. An interval bounds the constant's rounding.
  static Scalar ratio(double value) {
    if constexpr (std::is_same_v<Scalar, IntervalNumber>) return IntervalNumber::around<4 * Order>(value);
    return value;
  }

  /// a (b - b(u0,v0)). Each sum is finished before the next begins: gcc 12 at -O3 changes the order of addition in sums
  /// that are built up in turns.
  Taylor times_increment(const Taylor& b) const {
    Taylor r;
    for (int d = 1; d <= Order; ++d)
      for (int j = 0; j <= (Variables == 1 ? 0 : d); ++j) r.c_[index(d - j, j)] = sum_of_products(b, d, j);
    return r;
  }
  /// The coefficient of total order d, with order j in v, of this (b - b(u0,v0)); sums from the lowest order of this
  /// on.
  Scalar sum_of_products(const Taylor& b, int d, int j) const {
    Scalar sum = 0.0;
    for (int da = 0; da < d; ++da) {
      const int db = d - da, last = j < da ? j : da;
      const std::size_t first_a = index(da, 0), first_b = index(db, 0);
      for (int ja = j > db ? j - db : 0; ja <= last; ++ja) sum += c_[first_a + at(ja)] * b.c_[first_b + at(j - ja)];
    }
    return sum;
  }
  /// f of this series, by Horner's scheme in the increment.
  Taylor composed(const Coefficients& f) const {
    bool constant = true;
    for (std::size_t k = 1; k < size; ++k) constant = constant && c_[k] == Scalar(0.0);
    if (constant) return Taylor(f[0], Filled{});  // also where derivatives of f are infinite
    Taylor r(f[Order], Filled{});
    for (int k = Order - 1; k >= 0; --k) {
      r = r.times_increment(*this);
      r.c_[0] = f[at(k)];
    }
    return r;
  }

  static Scalar root(const Scalar& x) {
    using std::sqrt;
    return sqrt(x);
  }
  /// The coefficients of x^p from its value: (p over k) x^p / x^k, each by powers of 1/x alone, which keeps intervals
  /// narrow.
  static Coefficients power_series(const Scalar& x, double p, const Scalar& value) {
    const Scalar r = 1.0 / x, step = value * r;
    Coefficients f{value};
    double binomial = 1;
    Scalar power = 1.0;  // r^(k-1)
    for (int k = 1; k <= Order; ++k) {
      binomial = binomial * (p - (k - 1)) / k;
      f[at(k)] = ratio(binomial) * (step * power);
      power = power * r;
    }
    return f;
  }
  /// The reciprocal 1 / x.
  friend Taylor reciprocal(const Taylor& x) {
    const Scalar r = 1.0 / x.value();
    Coefficients f{r};
    for (int k = 1; k <= Order; ++k) f[at(k)] = -(f[at(k - 1)] * r);
    return x.composed(f);
  }
  /// The coefficients of sin (shift 0) or cos (shift 1).
  static Coefficients wave(const Scalar& x, int shift) {
    using std::cos;
    using std::sin;
    const std::array<Scalar, 2> waves{sin(x), cos(x)};
    Coefficients f;
    double factorial = 1;
    for (int k = 0; k <= Order; ++k) {
      if (k > 1) factorial *= k;
      const int quarter = (k + shift) % 4;
      const Scalar& w = waves[at(quarter % 2)];
      f[at(k)] = (quarter < 2 ? w : -w) / factorial;
    }
    return f;
  }
  /// The coefficients of sinh (shift 0) or cosh (shift 1).
  static Coefficients hyperbolic(const Scalar& x, int shift) {
    using std::cosh;
    using std::sinh;
    const std::array<Scalar, 2> waves{sinh(x), cosh(x)};
    Coefficients f;
    double factorial = 1;
    for (int k = 0; k <= Order; ++k) {
      if (k > 1) factorial *= k;
      f[at(k)] = waves[at((k + shift) % 2)] / factorial;
    }
    return f;
  }
  /// Coefficients of the solution of t' = 1 + sign t^2: tan, or tanh with sign -1.
  static Coefficients tangent(const Scalar& value, double sign) {
    Coefficients f{value};
    for (int k = 0; k < Order; ++k) {
      Scalar sum = 0.0;
      for (int i = 0; i <= k; ++i) sum = sum + f[at(i)] * f[at(k - i)];
      f[at(k + 1)] = ((k == 0 ? 1.0 : 0.0) + sign * sum) / double(k + 1);
    }
    return f;
  }
  /// The coefficients of sign times the integral of w = (1 - x^2)^(-1/2), for which (1 - x^2) w' = x w.
  static Coefficients arc(const Scalar& x, const Scalar& value, double sign) {
    const Scalar g = (1.0 - x) * (1.0 + x);
    Coefficients f{value}, w{1.0 / root(g)};
    f[1] = sign * w[0];
    for (int k = 1; k < Order; ++k) {
      // k g w_k = (2k - 1) x w_(k-1) + (k - 1) w_(k-2)
      w[at(k)] = (double(2 * k - 1) * (x * w[at(k - 1)]) + (k > 1 ? double(k - 1) * w[at(k - 2)] : Scalar(0.0))) /
                 (double(k) * g);
      f[at(k + 1)] = sign * w[at(k)] / double(k + 1);
    }
    return f;
  }

  std::array<Scalar, size> c_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
