#include "basis/knots.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "support/random_splines.h"

namespace tessera::test { namespace {

KnotLine line_over(int degree, const std::vector<double>& knots) {
  const std::size_t p = static_cast<std::size_t>(degree);
  return {degree, knots, knots[p], knots[knots.size() - p - 1]};
}

const std::vector<KnotStyle> styles{
    {0, true, false}, {4, true, false}, {4, true, true}, {3, false, false}, {3, false, true}};

/// N_{span-p+j,p}(t), j = 0..p: the blossom with all arguments t.
std::vector<double> b_spline_values(const KnotLine& line, std::size_t span, double t) {
  const std::vector<double> arguments(line.order(), t);
  std::vector<double> values(line.order());
  blossom_weights(line.degree, line.knots, span, arguments.data(), values.data());
  return values;
}

/// check(line, span, t, the basis functions there) at many places of knots of all degrees and styles.
template <class Check>
void for_many_places(Random& random, Check check) {
  for (int degree = 1; degree <= max_degree; ++degree)
    for (const KnotStyle& style : styles) {
      const std::vector<double> knots = random_knots(random, degree, style);
      const KnotLine line = line_over(degree, knots);
      for (const double t : sample_parameters(random, knots, line.from, line.to, 5)) {
        const std::size_t span = find_span(line, t);
        check(line, span, t, b_spline_values(line, span, t));
      }
    }
}

TEST(Knots, BasisIsAPartitionOfUnityAndEqualsTheRecursion) {
  Random random(1);
  for_many_places(random, [](const KnotLine& line, std::size_t span, double t, const std::vector<double>& values) {
    ASSERT_EQ(span, reference_span(line.knots, t, line.to));
    double sum = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      EXPECT_GE(values[j], 0);
      sum += values[j];
      if (line.degree > 8) continue;  // the recursion takes 2^degree calls
      const Real expected = reference_basis(line.knots, span, span - line.order() + 1 + j, line.degree, t);
      EXPECT_NEAR(values[j], static_cast<double>(expected), 4 * 0x1p-52) << line.degree << " " << t;
    }
    EXPECT_NEAR(sum, 1, line.degree * 0x1p-52);
  });
}

TEST(Knots, GrevilleAbscissaeReproduceTheParameter) {
  Random random(2);
  for_many_places(random, [](const KnotLine& line, std::size_t span, double t, const std::vector<double>& values) {
    double sum = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const auto first = line.knots.begin() + static_cast<std::ptrdiff_t>(span - line.order() + 2 + j);
      sum += values[j] * std::accumulate(first, first + line.degree, 0.0) / line.degree;
    }
    EXPECT_NEAR(sum, t, 20 * line.degree * 0x1p-52);
  });
}

TEST(Knots, BlossomIsSymmetricAndGivesControlPointsAtConsecutiveKnots) {
  Random random(3);
  for (int degree = 2; degree <= max_degree; ++degree) {
    const std::vector<double> knots = random_knots(random, degree, {4, false, false});
    const KnotLine line = line_over(degree, knots);
    const std::vector<std::size_t> spans = distinct_spans(line);
    const std::size_t span = spans[spans.size() / 2], p = static_cast<std::size_t>(degree);
    std::vector<long double> arguments, weights(p + 1), others(p + 1);
    for (int k = 0; k < degree; ++k) arguments.push_back(uniform(random, knots[span], knots[span + 1]));
    blossom_weights(degree, line.knots, span, arguments.data(), weights.data());
    std::shuffle(arguments.begin(), arguments.end(), random);
    blossom_weights(degree, line.knots, span, arguments.data(), others.data());
    for (std::size_t j = 0; j <= p; ++j) EXPECT_NEAR(static_cast<double>(weights[j] - others[j]), 0, 1e-17);
    for (std::size_t i = 0; i <= p; ++i) {
      arguments.assign(knots.begin() + static_cast<std::ptrdiff_t>(span - p + i + 1),
                       knots.begin() + static_cast<std::ptrdiff_t>(span + i + 1));
      blossom_weights(degree, line.knots, span, arguments.data(), weights.data());
      for (std::size_t j = 0; j <= p; ++j) EXPECT_NEAR(static_cast<double>(weights[j]), i == j ? 1 : 0, 1e-9) << degree;
    }
  }
}

TEST(Knots, SpansAtKnotsAndEnds) {
  const std::vector<double> knots{0, 0, 0, 1, 1, 2, 3, 3, 3};
  const KnotLine line{2, knots, 0, 3};
  EXPECT_EQ(find_span(line, 0), 2u);
  EXPECT_EQ(find_span(line, 0.5), 2u);
  EXPECT_EQ(find_span(line, 1), 4u);  // from the right
  EXPECT_EQ(find_span(line, 2), 5u);
  EXPECT_EQ(find_span(line, 3), 5u);  // from the left at the end
  EXPECT_EQ(find_span(line, -7), 2u);
  EXPECT_EQ(find_span(line, 8), 5u);
  EXPECT_EQ(distinct_spans(line), (std::vector<std::size_t>{2, 4, 5}));
  const KnotLine part{2, knots, 0.5, 1};  // it ends at a knot: from the left there
  EXPECT_EQ(find_span(part, 1), 2u);
  EXPECT_EQ(find_span(part, 0), 2u);
  EXPECT_EQ(distinct_spans(part), (std::vector<std::size_t>{2}));
}

TEST(Knots, BadOnesAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto check = [](int degree, const std::vector<double>& knots) { return check_knots(degree, knots, "knots u"); };
  EXPECT_TRUE(check(2, {0, 0, 0, 1, 1, 2, 2, 2}).ok());
  EXPECT_TRUE(check(2, {-3, -2, -1, 0, 1, 2}).ok());

  EXPECT_EQ(check(3, {0, 0, 0, 1, 1, 1, 1}).code(), StatusCode::count_mismatch);
  EXPECT_NE(check(3, {0, 0, 0, 1, 1, 1, 1}).message().find("at least 8 knots u, found 7"), std::string::npos);
  const Status falls = check(2, {0, 0, 0, 2, 1, 3, 3, 3});
  EXPECT_EQ(falls.code(), StatusCode::invalid_argument);
  EXPECT_EQ(falls.index(), 4);
  EXPECT_NE(falls.message().find("knots u[4] = 1 is below the knot before it, 2"), std::string::npos)
      << falls.message();
  EXPECT_EQ(check(1, {0, 0, nan, 1}).code(), StatusCode::non_finite);
  EXPECT_EQ(check(1, {0, 0, nan, 1}).index(), 2);
  EXPECT_EQ(check(1, {-1e308, -1e308, 1e308, 1e308}).code(), StatusCode::non_finite);
  const Status thrice = check(2, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_EQ(thrice.code(), StatusCode::invalid_argument);
  EXPECT_EQ(thrice.index(), 3);
  EXPECT_NE(thrice.message().find("has multiplicity 3"), std::string::npos) << thrice.message();
  EXPECT_EQ(check(1, {0, 0, 0, 1, 1}).index(), 0);                               // degree + 2 at the end
  EXPECT_EQ(check(2, {0, 0, 1, 1, 1, 2}).code(), StatusCode::invalid_argument);  // an empty domain
  EXPECT_EQ(check(2, {1, 1, 1, 1, 1, 1}).code(), StatusCode::invalid_argument);

  const std::vector<double> knots{0, 0, 0, 1, 1, 1};
  EXPECT_TRUE(check_range(2, knots, 0.25, 1, "the domain").ok());
  EXPECT_EQ(check_range(2, knots, -0.25, 1, "the domain").code(), StatusCode::invalid_argument);
  EXPECT_EQ(check_range(2, knots, 0.5, 0.5, "the domain").code(), StatusCode::invalid_argument);
  EXPECT_EQ(check_range(2, knots, nan, 1, "the domain").code(), StatusCode::non_finite);
}

}}  // namespace tessera::test
