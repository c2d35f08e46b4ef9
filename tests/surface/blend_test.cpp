// Blending functions of Coons patches: their conditions.

#include <cmath>
#include <stdexcept>

#include "support/errors.h"
#include "support/synthetic_sets.h"
#include "tessera/coons_patch.h"

namespace tessera::test { namespace {

const std::vector<double> smoothstep5_first{1, 0, 0, -10, 15, -6}, smoothstep5_second{0, 0, 0, 10, -15, 6};

std::vector<Blend> good_blends() {
  const auto cosine = [](double t) { return 0.5 + 0.5 * std::cos(std::acos(-1.0) * t); };
  return {Blend::linear(), Blend::cubic(), value_of(Blend::polynomial(smoothstep5_first, smoothstep5_second)),
          value_of(Blend::callable(cosine, [=](double t) { return 1 - cosine(t); }))};
}

TEST(Blend, SumsToOneAndItsDerivativesToZero) {
  for (const Blend& blend : good_blends()) {
    const double slack = blend.is_polynomial() ? 1e-15 : 1e-8;
    for (int i = 0; i <= 100; ++i) {
      const Blend::Jet jet = value_of(blend.at(i / 100.0));
      EXPECT_NEAR(jet[0][0] + jet[0][1], 1, 1e-15);
      EXPECT_NEAR(jet[1][0] + jet[1][1], 0, slack);
      EXPECT_NEAR(jet[2][0] + jet[2][1], 0, 40 * slack);
      EXPECT_EQ(value_of(blend.values_at(i / 100.0)), jet[0]);
    }
  }
}

TEST(Blend, IsExactAtTheEnds) {
  for (const Blend& blend : good_blends()) {
    EXPECT_EQ(value_of(blend.at(0))[0], (std::array<double, 2>{1, 0}));
    EXPECT_EQ(value_of(blend.at(1))[0], (std::array<double, 2>{0, 1}));
  }
}

TEST(Blend, DerivativesAreThoseOfTheFunctions) {
  const double pi = std::acos(-1.0);
  for (int i = 0; i <= 10; ++i) {
    const double t = i / 10.0;
    const Blend::Jet cubic = value_of(Blend::cubic().at(t)), cosine = value_of(good_blends()[3].at(t));
    EXPECT_NEAR(cubic[0][1], 3 * t * t - 2 * t * t * t, 1e-15);
    EXPECT_NEAR(cubic[1][1], 6 * t - 6 * t * t, 1e-14);
    EXPECT_NEAR(cubic[2][0], 12 * t - 6, 1e-14);
    EXPECT_NEAR(cosine[1][0], -0.5 * pi * std::sin(pi * t), 1e-10);
    EXPECT_NEAR(cosine[2][0], -0.5 * pi * pi * std::cos(pi * t), 1e-7);
  }
}

TEST(Blend, LeadingZerosAreNoDegree) {
  const Blend blend = value_of(Blend::polynomial(std::vector<double>{1, -1, 0, 0}, std::vector<double>{0, 1}));
  EXPECT_EQ(blend.first().size(), 2u);
  EXPECT_EQ(blend.second().size(), 2u);
}

/// The maker fixes deviations within the tolerance: the polynomials themselves then meet the conditions.
TEST(Blend, ForgivenMissesArePutRight) {
  const Blend blend =
      value_of(Blend::polynomial(std::vector{1 + 9e-12, -11 - 9e-12, 10.0}, std::vector{0.0, 11.0, -10.0}));
  EXPECT_EQ(blend.first()[0], 1);
  EXPECT_EQ(blend.first()[0] + blend.first()[1] + blend.first()[2], 0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(blend.first()[i] + blend.second()[i], i == 0 ? 1 : 0);
}

TEST(Blend, RefusesPolynomialsThatBreakAConditionAndSaysWhich) {
  using List = std::vector<double>;
  const auto refused = [](const List& first, const List& second, StatusCode code, std::ptrdiff_t index,
                          const char* words) { expect_refused(Blend::polynomial(first, second), code, index, words); };
  const auto invalid = StatusCode::invalid_argument;
  refused({1, -1}, {0.25, 1}, invalid, -1, "f1 + f2 = 1, they miss it by 0.25");
  refused({1, -1}, {0, 1.5}, invalid, -1, "coefficients of t^1");
  refused({1, -1}, {0, 1, 1e-6}, invalid, -1, "coefficients of t^2");
  refused({0.5, -0.5}, {0.5, 0.5}, invalid, -1, "f1(0) = 1, they miss it by 0.5");
  refused({1, -0.5}, {0, 0.5}, invalid, -1, "f1(1) = 0, they miss it by 0.5");
  refused({1}, {0, 1}, StatusCode::unsupported_degree, -1, "degree of f1 is 0");
  refused({1, -1}, {}, StatusCode::unsupported_degree, -1, "degree of f2");
  List long_one(17, 0);
  long_one[0] = 1;
  long_one[16] = -1;
  refused(long_one, {0, 1}, StatusCode::unsupported_degree, -1, "degree of f1 is 16");
  refused({1, not_a_number}, {0, 1}, StatusCode::non_finite, 1, "coefficient [1] of f1");
  refused({1, -1}, {0, 1, infinity}, StatusCode::non_finite, 2, "coefficient [2] of f2");
  refused({1, 1e300, -1e300}, {0, -1e300, 1e300}, invalid, 1, "coefficient [1] of f1");
  EXPECT_TRUE(Blend::polynomial(List{1, -1 + 5e-13}, List{0, 1}).ok());
}

TEST(Blend, RefusesCallablesThatBreakAConditionAndSaysWhere) {
  const auto line = [](double t) { return t; };
  const auto rest = [](double t) { return 1 - t; };
  const auto invalid = StatusCode::invalid_argument;
  expect_refused(Blend::callable({}, line), invalid, -1, "f1 is empty");
  expect_refused(Blend::callable(rest, {}), invalid, -1, "f2 is empty");
  expect_refused(Blend::callable(line, line), invalid, -1, "f1 + f2 = 1 at t = 0,");
  expect_refused(Blend::callable(rest, [](double t) { return t * t; }), invalid, -1, "at t = 0.015625");
  expect_refused(Blend::callable(line, rest), invalid, -1, "f1(0) = 1");
  expect_refused(Blend::callable([](double t) { return 1 - t / 2; }, [](double t) { return t / 2; }), invalid, -1,
                 "f1(1) = 0");
  expect_refused(Blend::callable(rest, [](double t) { return t == 0.5 ? not_a_number : t; }), StatusCode::non_finite,
                 -1, "f2 at t = 0.5");
  const auto thrower = [](double t) { return t > 0.5 ? throw std::runtime_error("no blend") : 1 - t; };
  expect_refused(Blend::callable(thrower, line), invalid, -1, "f1 at t = 0.515625 threw: no blend");
}

}}  // namespace tessera::test
