// Sums of series are taken in the order that taylor.h states, however the compiler transforms its loops. This file is
// compiled at -O3, at which gcc 12 adds in another order if it alternates between sums.

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "support/random_patches.h"
#include "tessera/detail/taylor.h"

namespace tessera::test { namespace {

using Series = Taylor<double, 2>;

[[gnu::noinline]] Series cosine_of_product(double u, double v) {
  return cos(Series::variable(u, 0) * Series::variable(v, 1));
}

/// A sum term by term; the compiler knows nothing about the terms.
double in_order(std::initializer_list<double> terms) {
  volatile double sum = 0;
  for (const double term : terms) sum = sum + term;
  return sum;
}

TEST(TaylorSums, AreTakenInTheOrderStated) {
  Random random(71);
  int distinguished = 0;
  for (int k = 0; k < 1000; ++k) {
    const double u = uniform(random, -1, 1), v = uniform(random, -1, 1), x = u * v;
    // cos x = f0 + f1 d + f2 d^2, d = v du + u dv + du dv; by Horner's scheme (f1 + f2 d) d: the term in du dv
    const double f1 = -std::sin(x), f2 = -std::cos(x) / 2;
    const double a = f1, b = f2 * v * u, c = f2 * u * v;
    EXPECT_EQ(cosine_of_product(u, v).coefficient(1, 1), in_order({a, b, c})) << u << " " << v;
    distinguished += in_order({a, b, c}) != in_order({a, c, b}) || in_order({a, b, c}) != in_order({c, b, a});
  }
  EXPECT_GT(distinguished, 100);
}

}}  // namespace tessera::test
