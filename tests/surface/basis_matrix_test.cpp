// Compares basis matrices with definitions that share nothing with them.

#include "support/errors.h"
#include "support/random_bases.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// f_i(t) from M itself, and the size to which its rounding is relative.
Real by_powers(const BasisMatrix& basis, int i, Real t, Real& size) {
  Real sum = 0;
  size = 0;
  for (int k = 0; k <= basis.degree(); ++k) {
    const Real term = basis.power_coefficient(k, i) * reference_power(t, k);
    sum += term;
    size += std::abs(term);
  }
  return sum;
}
/// f_i(t) from M_B^{-1} M.
Real by_bernstein(const BasisMatrix& basis, int i, Real t) {
  Real sum = 0;
  for (int k = 0; k <= basis.degree(); ++k)
    sum += basis.bernstein_coefficient(k, i) * reference_bernstein(basis.degree(), k, t);
  return sum;
}

/// The function of degree n that starts at whole knot `first`, by the recurrence of Cox and de Boor.
Real b_spline(int n, int first, Real t) {
  if (n == 0) return t >= first && t < first + 1 ? 1 : 0;
  return ((t - first) * b_spline(n - 1, first, t) + (first + n + 1 - t) * b_spline(n - 1, first + 1, t)) / n;
}

TEST(BasisMatrix, BothFormsAreTheSamePolynomials) {
  Random random(1);
  for (int n = 1; n <= max_degree; ++n)
    for (const auto& [name, basis] : bases_of(random, n)) {
      EXPECT_EQ(basis.degree(), n);
      for (int i = 0; i <= n; ++i)
        for (const double t : {0.0, 0.3, 0.5, 0.9, 1.0}) {
          Real size = 0;
          const Real value = by_powers(basis, i, t, size);
          EXPECT_NEAR(static_cast<double>(value), static_cast<double>(by_bernstein(basis, i, t)),
                      4 * double_unit * static_cast<double>(size))
              << name << " " << n << " " << i << " " << t;
        }
    }
}

TEST(BasisMatrix, BezierIsBernstein) {
  for (int n = 1; n <= max_degree; ++n)
    for (int i = 0; i <= n; ++i)
      for (const double t : {0.0, 0.25, 0.7, 1.0})
        EXPECT_EQ(by_bernstein(value_of(BasisMatrix::bezier(n)), i, t), reference_bernstein(n, i, t));
}

TEST(BasisMatrix, PowerIsTheIdentity) {
  for (int n = 1; n <= max_degree; ++n) {
    const BasisMatrix basis = value_of(BasisMatrix::power(n));
    for (int i = 0; i <= n; ++i) {
      for (int k = 0; k <= n; ++k) EXPECT_EQ(basis.power_coefficient(k, i), k == i);
      for (const double t : {0.25, 0.7})
        EXPECT_NEAR(static_cast<double>(by_bernstein(basis, i, t)), static_cast<double>(reference_power(t, i)),
                    double_unit);
    }
  }
}

TEST(BasisMatrix, UniformBSplineIsThatOfTheRecurrence) {
  for (int n = 1; n <= max_degree; ++n) {
    const BasisMatrix basis = value_of(BasisMatrix::uniform_b_spline(n));
    for (int i = 0; i <= n; ++i)
      for (const double t : {0.0, 0.3, 0.5, 0.999}) {
        const Real expected = b_spline(n, i - n, t);
        EXPECT_NEAR(static_cast<double>(by_bernstein(basis, i, t)), static_cast<double>(expected),
                    2 * double_unit * static_cast<double>(expected))
            << n << " " << i << " " << t;
      }
  }
}

TEST(BasisMatrix, CubicsOfTheLectures) {
  const BasisMatrix spline = value_of(BasisMatrix::uniform_b_spline(3)), hermite = value_of(BasisMatrix::hermite());
  for (const double t : {0.0, 0.2, 0.6, 1.0}) {
    const double s = 1 - t, t2 = t * t, t3 = t2 * t;
    const double n[] = {s * s * s / 6, (3 * t3 - 6 * t2 + 4) / 6, (-3 * t3 + 3 * t2 + 3 * t + 1) / 6, t3 / 6};
    const double h[] = {1 - 3 * t2 + 2 * t3, t - 2 * t2 + t3, -t2 + t3, 3 * t2 - 2 * t3};
    for (int i = 0; i < 4; ++i) {
      Real size = 0;
      EXPECT_NEAR(static_cast<double>(by_powers(spline, i, t, size)), n[i], 4 * double_unit);
      EXPECT_NEAR(static_cast<double>(by_powers(hermite, i, t, size)), h[i], 4 * double_unit);
    }
  }
}

TEST(BasisMatrix, HermiteToBezierIsAsPrinted) {
  const BasisMatrix basis = value_of(BasisMatrix::hermite());
  const double third = 1.0 / 3;
  const double expected[4][4] = {{1, 0, 0, 0}, {1, third, 0, 0}, {0, 0, -third, 1}, {0, 0, 0, 1}};
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 4; ++i) EXPECT_EQ(basis.bernstein_coefficient(k, i), expected[k][i]);
}

TEST(BasisMatrix, CatmullRomInterpolatesWithTangentsOfHalfChords) {
  const BasisMatrix basis = value_of(BasisMatrix::catmull_rom());
  const double start[] = {0, 1, 0, 0}, end[] = {0, 0, 1, 0}, start_slope[] = {-0.5, 0, 0.5, 0},
               end_slope[] = {0, -0.5, 0, 0.5};
  for (int i = 0; i < 4; ++i) {
    const auto m = [&](int k) { return basis.power_coefficient(k, i); };
    EXPECT_EQ(m(0), start[i]);
    EXPECT_EQ(m(0) + m(1) + m(2) + m(3), end[i]);
    EXPECT_EQ(m(1), start_slope[i]);
    EXPECT_EQ(m(1) + 2 * m(2) + 3 * m(3), end_slope[i]);
  }
}

TEST(BasisMatrix, BlendsOfPointsSumToOne) {
  for (int n = 1; n <= max_degree; ++n)
    for (const BasisMatrix& basis : {value_of(BasisMatrix::bezier(n)), value_of(BasisMatrix::uniform_b_spline(n)),
                                     value_of(BasisMatrix::catmull_rom())})
      for (int k = 0; k <= basis.degree(); ++k) {
        Real sum = 0;
        for (int i = 0; i <= basis.degree(); ++i) sum += basis.bernstein_coefficient(k, i);
        EXPECT_NEAR(static_cast<double>(sum), 1, 2 * double_unit);
      }
}

TEST(BasisMatrix, InversesInvert) {
  Random random(2);
  for (int n = 1; n <= max_degree; ++n)
    for (const auto& [name, basis] : bases_of(random, n)) {
      ASSERT_TRUE(basis.is_regular()) << name << " " << n;
      for (int k = 0; k <= n; ++k)
        for (int l = 0; l <= n; ++l) {
          Real sum = 0, size = 0;
          for (int i = 0; i <= n; ++i) {
            const Real term = Real(basis.bernstein_coefficient(k, i)) * basis.inverse_coefficient(i, l);
            sum += term;
            size += std::abs(term);
          }
          EXPECT_NEAR(static_cast<double>(sum), k == l, 2 * double_unit * static_cast<double>(size))
              << name << " " << n << " " << k << " " << l;
        }
    }
}

TEST(BasisMatrix, CustomOfANamedOneIsIt) {
  for (const BasisMatrix& basis : {value_of(BasisMatrix::bezier(5)), value_of(BasisMatrix::hermite()),
                                   value_of(BasisMatrix::catmull_rom()), value_of(BasisMatrix::uniform_b_spline(4))}) {
    const int n = basis.degree();
    std::vector<double> entries;
    for (int k = 0; k <= n; ++k)
      for (int i = 0; i <= n; ++i) entries.push_back(basis.power_coefficient(k, i));
    const BasisMatrix custom = value_of(BasisMatrix::custom(n, entries));
    ASSERT_TRUE(custom.is_regular());
    for (int k = 0; k <= n; ++k)
      for (int i = 0; i <= n; ++i) {
        EXPECT_EQ(custom.power_coefficient(k, i), basis.power_coefficient(k, i));
        EXPECT_NEAR(custom.bernstein_coefficient(k, i), basis.bernstein_coefficient(k, i), 4 * double_unit);
        EXPECT_NEAR(custom.inverse_coefficient(k, i), basis.inverse_coefficient(k, i), 1e-12);
      }
  }
}

TEST(BasisMatrix, SingularMatricesAreSeen) {
  const auto regular = [](const std::vector<double>& entries) {
    return value_of(BasisMatrix::custom(entries.size() == 4 ? 1 : 2, entries)).is_regular();
  };
  EXPECT_TRUE(regular({1, 0, 0, 1}));
  EXPECT_TRUE(regular({1, 0, 0, 1e-200}));  // a column's size does not make it singular
  EXPECT_FALSE(regular({0, 0, 0, 0}));
  EXPECT_FALSE(regular({1, 1, 1, 1}));
  EXPECT_FALSE(regular({1, 0, 1, 0}));
  EXPECT_FALSE(regular({0.1, 0.2, 0.3, 0.6}));  // to rounding
  EXPECT_FALSE(regular({1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(BasisMatrix, RefusesWhatItCannotHold) {
  for (const int degree : {0, -1, 16}) {
    const std::string words = "degree of a basis matrix is " + std::to_string(degree) + ", it must be 1 to 15";
    expect_refused(BasisMatrix::bezier(degree), StatusCode::unsupported_degree, -1, words);
    expect_refused(BasisMatrix::power(degree), StatusCode::unsupported_degree, -1, words);
    expect_refused(BasisMatrix::uniform_b_spline(degree), StatusCode::unsupported_degree, -1, words);
    expect_refused(BasisMatrix::custom(degree, {}), StatusCode::unsupported_degree, -1, words);
  }
  expect_refused(BasisMatrix::custom(2, std::vector<double>(8)), StatusCode::count_mismatch, -1,
                 "a basis matrix of degree 2 has 3 x 3 entries, found 8");
  for (const double bad : {not_a_number, infinity, -infinity})
    expect_refused(BasisMatrix::custom(1, std::vector<double>{1, 0, bad, 1}), StatusCode::non_finite, 2,
                   "entry [1][0] of the basis matrix is ");
  expect_refused(BasisMatrix::custom(1, std::vector<double>{1e308, 0, 1e308, 1}), StatusCode::non_finite, -1,
                 "too large");
}

}}  // namespace tessera::test
