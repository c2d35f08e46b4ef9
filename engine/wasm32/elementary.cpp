// Sines, exponentials and their kin, correctly rounded but for about one argument in 2^40. The C library's (musl's) are
// off by up to 0.8 units in the last place, and glibc's are correctly rounded almost always: with these functions, a
// module gives the bytes that programs on Linux give, but for the few arguments that glibc itself does not round
// correctly, and for sinh(), cosh() and tanh(), which stay musl's.
//
// Numbers are sums of two doubles (T. J. Dekker, A floating-point technique for extending the available precision,
// Numer. Math. 18, 1971), about 104 bits. Sines and exponentials are Taylor's series of a reduced argument; arcs and
// logarithms are corrected from a first guess in float. Infinite and undefined results are those of Annex F of the C
// standard.

#include <bit>
#include <cmath>

#include <limits>

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// high + low, with |low| of at most half a unit in the last place of high.
struct Twofold {
  double high, low;
};

Twofold sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
/// For |a| >= |b|.
Twofold ordered_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
Twofold product(double a, double b) {
  constexpr double splitter = 134217729;  // 2^27 + 1
  const double ca = splitter * a, cb = splitter * b, a1 = ca - (ca - a), b1 = cb - (cb - b), a2 = a - a1, b2 = b - b1;
  const double p = a * b;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

Twofold operator-(Twofold a) { return {-a.high, -a.low}; }
Twofold operator+(Twofold a, Twofold b) {
  Twofold s = sum(a.high, b.high);
  const Twofold t = sum(a.low, b.low);
  s = ordered_sum(s.high, s.low + t.high);
  return ordered_sum(s.high, s.low + t.low);
}
Twofold operator-(Twofold a, Twofold b) { return a + -b; }
Twofold operator*(Twofold a, Twofold b) {
  const Twofold p = product(a.high, b.high);
  return ordered_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}
Twofold operator*(Twofold a, double b) {
  const Twofold p = product(a.high, b);
  return ordered_sum(p.high, p.low + a.low * b);
}
Twofold operator/(Twofold a, Twofold b) {
  const double first = a.high / b.high;
  Twofold rest = a - b * first;
  const double second = rest.high / b.high;
  rest = rest - b * second;
  return ordered_sum(first, second) + Twofold{rest.high / b.high, 0};
}
Twofold root(Twofold a) {
  if (a.high <= 0) return {0, 0};
  const double guess = std::sqrt(a.high);
  const Twofold rest = a - product(guess, guess);
  return ordered_sum(guess, rest.high / (2 * guess));
}
Twofold scaled(Twofold a, int exponent) { return {std::ldexp(a.high, exponent), std::ldexp(a.low, exponent)}; }
double rounded(Twofold a) { return a.high + a.low; }

/// Numbers of three doubles, for the reduction of arguments.
struct Threefold {
  double first, second, third;
};
constexpr Threefold half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
constexpr Threefold log_of_2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56, 0x1.7b57a079a1934p-111};
constexpr Twofold pi{2 * half_pi.first, 2 * half_pi.second};

/// a - k unit, for a whole number k of at most 2^30.
Twofold reduced(Twofold a, double k, const Threefold& unit) {
  const Twofold first = product(k, unit.first), second = product(k, unit.second);
  const Twofold near = sum(a.high, -first.high);  // exact
  return ((near - Twofold{first.low, 0}) + Twofold{a.low, 0}) - (second + Twofold{k * unit.third, 0});
}

/// 1 / n!
Twofold inverse_factorial(int n) {
  static Twofold all[30];
  if (all[0].high == 0) {
    all[0] = {1, 0};
    for (int k = 1; k < 30; ++k) all[k] = all[k - 1] / Twofold{static_cast<double>(k), 0};
  }
  return all[n];
}

/// The sum of x^n / n! for n = first, first + 2, ... to 28, with signs that alternate.
Twofold alternating_series(Twofold x, int first) {
  const Twofold square = -(x * x);
  Twofold value{0, 0};
  for (int n = first + 26; n >= first; n -= 2) value = value * square + inverse_factorial(n);
  return first == 1 ? value * x : value;
}

struct SineCosine {
  Twofold sine, cosine;
};
/// The sine and cosine of an angle of at most pi / 4, or little more.
SineCosine small_sine_cosine(Twofold angle) { return {alternating_series(angle, 1), alternating_series(angle, 0)}; }

extern "C" int __rem_pio2(double x, double* rest);  // musl's

/// The sine and the cosine of any finite number.
SineCosine sine_cosine(double x) {
  int quarter = 0;
  Twofold rest{x, 0};
  if (std::abs(x) > 0x1p30) {
    double parts[2];
    quarter = __rem_pio2(x, parts);
    rest = sum(parts[0], parts[1]);
  } else if (std::abs(x) > 0.8) {
    const double k = std::nearbyint(x * (1 / half_pi.first));
    quarter = static_cast<int>(k);
    rest = reduced(rest, k, half_pi);
  }
  const SineCosine of = small_sine_cosine(rest);
  switch (quarter & 3) {
    case 0:
      return of;
    case 1:
      return {of.cosine, -of.sine};
    case 2:
      return {-of.sine, -of.cosine};
    default:
      return {-of.cosine, of.sine};
  }
}

/// The angle of the vector (x, y), which is finite and not zero.
Twofold angle_of(Twofold y, Twofold x) {
  const double guess = std::atan2(static_cast<float>(y.high), static_cast<float>(x.high));
  const SineCosine turn = sine_cosine(guess);
  const Twofold along = x * turn.cosine + y * turn.sine, across = y * turn.cosine - x * turn.sine;
  const Twofold t = across / along, square = t * t;  // the tangent of what the guess lacks, about 2^-23
  const Twofold series =
      Twofold{1, 0} - square * (Twofold{1, 0} / Twofold{3, 0} - square * (Twofold{0.2, 0} - square * (1 / 7.0)));
  return Twofold{guess, 0} + t * series;
}

/// e^x of a number between -800 and 800, as a number and an exponent of 2.
Twofold exponential(Twofold x, int& exponent) {
  const double k = std::nearbyint(x.high / log_of_2.first);
  const Twofold rest = reduced(x, k, log_of_2);
  Twofold value{0, 0};
  for (int n = 25; n >= 0; --n) value = value * rest + inverse_factorial(n);
  exponent = static_cast<int>(k);
  return value;
}
double rounded_exponential(Twofold x) {
  if (x.high > 710) return infinity;
  if (x.high < -746) return 0;
  int exponent = 0;
  const Twofold value = exponential(x, exponent);
  return std::ldexp(rounded(value), exponent);
}

/// The natural logarithm of a positive finite number.
Twofold logarithm(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // from 1/2 to 1
  if (mantissa < 0.70710678118654752) mantissa *= 2, --exponent;
  const double guess = std::log(static_cast<float>(mantissa));
  int unused = 0;
  const Twofold power = guess == 0 ? Twofold{1, 0} : exponential({guess, 0}, unused);
  const Twofold of = scaled(power, unused), x2{mantissa, 0};
  const Twofold z = (x2 - of) / (x2 + of), square = z * z;  // artanh(z) = log(x / power) / 2
  const Twofold series =
      Twofold{1, 0} + square * (Twofold{1, 0} / Twofold{3, 0} + square * (Twofold{0.2, 0} + square * (1 / 7.0)));
  const Twofold fraction = Twofold{guess, 0} + (z * series) * 2.0;
  if (exponent == 0) return fraction;
  const double k = exponent;
  return (product(k, log_of_2.first) + product(k, log_of_2.second)) + fraction;
}

/// A logarithm times a factor, with the results of numbers that have none.
double logarithm_times(double x, Twofold factor) {
  if (std::isnan(x) || x < 0) return undefined;
  if (x == 0) return -infinity;
  if (std::isinf(x)) return x;
  return rounded(logarithm(x) * factor);
}

bool is_whole(double x) { return std::floor(x) == x; }
bool is_odd(double x) { return is_whole(x) && std::fmod(x, 2) != 0; }

/// pow() where x or y is 0 or infinite; x is not NaN, nor is y.
double power_at_limits(double x, double y) {
  if (std::isinf(y)) {
    if (std::abs(x) == 1) return 1;
    return (std::abs(x) > 1) == (y > 0) ? infinity : 0;
  }
  const double size = (x == 0) == (y > 0) ? 0 : infinity;
  return std::signbit(x) && is_odd(y) ? -size : size;
}

}  // namespace

extern "C" {

double sin(double x) {
  if (!std::isfinite(x)) return undefined;
  return std::abs(x) < 0x1p-27 ? x : rounded(sine_cosine(x).sine);
}
double cos(double x) { return std::isfinite(x) ? rounded(sine_cosine(x).cosine) : undefined; }
double tan(double x) {
  if (!std::isfinite(x)) return undefined;
  if (std::abs(x) < 0x1p-27) return x;
  const SineCosine of = sine_cosine(x);
  return rounded(of.sine / of.cosine);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return undefined;
  if (std::isinf(x) || std::isinf(y)) {
    y = std::copysign(std::isinf(y) ? 1.0 : 0.0, y);
    x = std::copysign(std::isinf(x) ? 1.0 : 0.0, x);
  }
  if (y == 0) return std::signbit(x) ? std::copysign(pi.high, y) : y;
  // Both of a size that floats hold: the smaller one may become 0, where the angle is a quarter turn to the last bit.
  const int exponent = std::ilogb(std::max(std::abs(x), std::abs(y)));
  if (x > 0 && std::ilogb(y) < exponent - 60) return y / x;
  return rounded(angle_of({std::ldexp(y, -exponent), 0}, {std::ldexp(x, -exponent), 0}));
}
double atan(double x) { return std::abs(x) < 0x1p-27 ? x : atan2(x, 1); }
double asin(double x) {
  if (!(std::abs(x) <= 1)) return undefined;
  if (std::abs(x) < 0x1p-27) return x;
  return rounded(angle_of({x, 0}, root(sum(1, x) * sum(1, -x))));
}
double acos(double x) {
  if (!(std::abs(x) <= 1)) return undefined;
  if (x == 1) return 0;
  return rounded(angle_of(root(sum(1, x) * sum(1, -x)), {x, 0}));
}

double exp(double x) { return std::isnan(x) ? x : rounded_exponential({x, 0}); }
double exp2(double x) {
  if (!(std::abs(x) < 1100)) return std::isnan(x) ? x : x > 0 ? infinity : 0;
  const double whole = std::nearbyint(x);
  return std::ldexp(rounded_exponential(Twofold{log_of_2.first, log_of_2.second} * (x - whole)),
                    static_cast<int>(whole));
}
double log(double x) { return logarithm_times(x, {1, 0}); }
double log2(double x) { return logarithm_times(x, Twofold{1, 0} / Twofold{log_of_2.first, log_of_2.second}); }
double log10(double x) { return logarithm_times(x, Twofold{1, 0} / logarithm(10)); }

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return undefined;
  if (x == 0 || std::isinf(x) || std::isinf(y)) return power_at_limits(x, y);
  if (x < 0 && !is_whole(y)) return undefined;
  if (x == -1) return is_odd(y) ? -1 : 1;
  const Twofold logarithm_of = logarithm(std::abs(x));
  const double about = logarithm_of.high * y;
  const double size = std::abs(about) > 800 ? (about > 0 ? infinity : 0) : rounded_exponential(logarithm_of * y);
  return x < 0 && is_odd(y) ? -size : size;
}

double hypot(double x, double y) {
  if (std::isinf(x) || std::isinf(y)) return infinity;
  if (std::isnan(x) || std::isnan(y)) return undefined;
  if (x == 0 || y == 0) return std::abs(x) + std::abs(y);
  const int exponent = std::ilogb(std::max(std::abs(x), std::abs(y)));
  const double a = std::ldexp(x, -exponent), b = std::ldexp(y, -exponent);
  return std::ldexp(rounded(root(product(a, a) + product(b, b))), exponent);
}

}  // extern "C"
