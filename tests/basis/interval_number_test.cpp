// The result of every operation on intervals contains that of the operation on numbers in them.

#include "tessera/detail/interval_number.h"

#include <functional>

#include "support/errors.h"
#include "support/random_patches.h"

namespace tessera::test { namespace {

using Real = long double;

IntervalNumber random_interval(Random& random, double from, double to) {
  const double a = uniform(random, from, to), b = uniform(random, from, to);
  // From wide ones to single numbers.
  const double width = std::abs(b - a) * std::pow(10.0, -std::floor(uniform(random, 0, 18)));
  return {a, std::min(a + width, std::max(a, to))};
}
Real number_in(Random& random, const IntervalNumber& x) {
  const double pick = uniform(random, -0.2, 1.2);
  if (pick <= 0) return x.lower();
  if (pick >= 1) return x.upper();
  return Real(x.lower()) + Real(pick) * (Real(x.upper()) - Real(x.lower()));
}
bool holds(const IntervalNumber& x, Real value) { return Real(x.lower()) <= value && value <= Real(x.upper()); }

struct Unary {
  const char* name;
  double from, to;  // where it is defined
  std::function<IntervalNumber(const IntervalNumber&)> interval;
  std::function<Real(Real)> real;
};

const std::vector<Unary>& unary_operations() {
  static const std::vector<Unary> operations{
      {"negative", -5, 5, [](const auto& x) { return -x; }, [](Real x) { return -x; }},
      {"square", -5, 5, [](const auto& x) { return x * x; }, [](Real x) { return x * x; }},
      {"abs", -5, 5, [](const auto& x) { return abs(x); }, [](Real x) { return std::abs(x); }},
      {"sqrt", 0, 9, [](const auto& x) { return sqrt(x); }, [](Real x) { return std::sqrt(x); }},
      {"exp", -30, 30, [](const auto& x) { return exp(x); }, [](Real x) { return std::exp(x); }},
      {"log", 1e-6, 9, [](const auto& x) { return log(x); }, [](Real x) { return std::log(x); }},
      {"sin", -40, 40, [](const auto& x) { return sin(x); }, [](Real x) { return std::sin(x); }},
      {"cos", -40, 40, [](const auto& x) { return cos(x); }, [](Real x) { return std::cos(x); }},
      {"sin of large", 1e5, 2e6, [](const auto& x) { return sin(x); }, [](Real x) { return std::sin(x); }},
      {"tan", -1.5, 1.5, [](const auto& x) { return tan(x); }, [](Real x) { return std::tan(x); }},
      {"atan", -30, 30, [](const auto& x) { return atan(x); }, [](Real x) { return std::atan(x); }},
      {"asin", -1, 1, [](const auto& x) { return asin(x); }, [](Real x) { return std::asin(x); }},
      {"acos", -1, 1, [](const auto& x) { return acos(x); }, [](Real x) { return std::acos(x); }},
      {"sinh", -5, 5, [](const auto& x) { return sinh(x); }, [](Real x) { return std::sinh(x); }},
      {"cosh", -5, 5, [](const auto& x) { return cosh(x); }, [](Real x) { return std::cosh(x); }},
      {"tanh", -5, 5, [](const auto& x) { return tanh(x); }, [](Real x) { return std::tanh(x); }},
      {"^3", -5, 5, [](const auto& x) { return pow(x, 3); }, [](Real x) { return x * x * x; }},
      {"^4", -5, 5, [](const auto& x) { return pow(x, 4); }, [](Real x) { return x * x * x * x; }},
      {"^2.5", 0, 5, [](const auto& x) { return pow(x, 2.5); }, [](Real x) { return std::pow(x, 2.5L); }},
      {"^-3", -5, -0.1, [](const auto& x) { return pow(x, -3); }, [](Real x) { return 1 / (x * x * x); }},
      {"^-2", -5, -0.1, [](const auto& x) { return pow(x, -2); }, [](Real x) { return 1 / (x * x); }}};
  return operations;
}

TEST(IntervalNumber, HoldsFunctionsOfItsNumbers) {
  Random random(1);
  for (const Unary& operation : unary_operations())
    for (int k = 0; k < 2000; ++k) {
      const IntervalNumber x = random_interval(random, operation.from, operation.to);
      const IntervalNumber y = operation.interval(x);
      ASSERT_TRUE(y.is_bounded()) << operation.name << " of [" << x.lower() << ", " << x.upper() << "]";
      for (int n = 0; n < 5; ++n) {
        const Real number = number_in(random, x);
        ASSERT_TRUE(holds(y, operation.real(number))) << operation.name << " of " << number;
      }
    }
}

TEST(IntervalNumber, HoldsSumsProductsAndQuotients) {
  Random random(2);
  for (int k = 0; k < 5000; ++k) {
    const IntervalNumber x = random_interval(random, -3, 3), y = random_interval(random, -3, 3);
    const IntervalNumber sum = x + y, difference = x - y, product = x * y, quotient = x / y;
    EXPECT_EQ(quotient.is_bounded(), !y.contains(0));
    for (int n = 0; n < 5; ++n) {
      const Real a = number_in(random, x), b = number_in(random, y);
      ASSERT_TRUE(holds(sum, a + b) && holds(difference, a - b) && holds(product, a * b));
      ASSERT_TRUE(!quotient.is_bounded() || holds(quotient, a / b)) << double(a) << " / " << double(b);
    }
  }
}

TEST(IntervalNumber, IsNarrow) {
  // The functions of a single number stay within a few doubles; extrema are exact.
  EXPECT_LT(sqrt(IntervalNumber(2)).upper() - sqrt(IntervalNumber(2)).lower(), 1e-15);
  EXPECT_LT(exp(IntervalNumber(1)).upper() - exp(IntervalNumber(1)).lower(), 1e-14);
  EXPECT_EQ(sin(IntervalNumber(1, 2)).upper(), 1);
  EXPECT_NEAR(sin(IntervalNumber(1, 2)).lower(), std::sin(1.0), 1e-14);
  EXPECT_EQ(cos(IntervalNumber(3, 4)).lower(), -1);
  EXPECT_NEAR(cos(IntervalNumber(0.5, 1)).upper(), std::cos(0.5), 1e-14);
  const IntervalNumber x(-1, 2), other = x;
  EXPECT_EQ((x * x).lower(), 0);
  EXPECT_LT((x * other).lower(), -1.9);  // two numbers that lie in the same interval
  EXPECT_EQ(pow(x, 2).lower(), 0);
  EXPECT_EQ(1 * x, x);
  EXPECT_EQ(x + 0, x);
}

TEST(IntervalNumber, SaysWhereThereIsNoBound) {
  const IntervalNumber with_zero(-1, 1), none = IntervalNumber::none();
  for (const IntervalNumber& x : {1 / with_zero,
                                  sqrt(with_zero),
                                  log(with_zero),
                                  log(IntervalNumber(0, 1)),
                                  1 / IntervalNumber(0, 1),
                                  tan(IntervalNumber(1, 2)),
                                  asin(IntervalNumber(0.5, 1.5)),
                                  acos(IntervalNumber(-2, 0)),
                                  pow(with_zero, -1),
                                  pow(with_zero, 0.5),
                                  IntervalNumber(2, 1),
                                  IntervalNumber(not_a_number),
                                  none + 1,
                                  0 * none,
                                  none * none,
                                  none / 2,
                                  sqrt(none),
                                  abs(none),
                                  sin(none),
                                  cos(none),
                                  exp(none),
                                  atan(none),
                                  tanh(none),
                                  pow(none, 2),
                                  cosh(none),
                                  exp(IntervalNumber(1000)) * IntervalNumber(0, 1)}) {
    EXPECT_FALSE(x.is_bounded()) << x.lower() << " " << x.upper();
    EXPECT_EQ(x.magnitude(), infinity);
  }
  EXPECT_EQ(IntervalNumber(-3, 2).magnitude(), 3);
}

}}  // namespace tessera::test
