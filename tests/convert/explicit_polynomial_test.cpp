// Graphs of polynomials: the patch is the polynomial, also far from zero where powers cancel.

#include "tessera/tensor_patch.h"

#include <limits>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

// 113 bits: long double on some machines, a type of its own on others.
#if __LDBL_MANT_DIG__ >= 113
using Wide = long double;
#else
__extension__ typedef __float128 Wide;
#endif

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ExplicitPolynomial graph(int m, int n, const std::vector<double>& a, const Domain& rectangle) {
  return value_of(ExplicitPolynomial::make(m, n, a, rectangle));
}

/// The height by the definition, in 113 bits.
double height(const ExplicitPolynomial& p, double x, double y) {
  Wide sum = 0;
  for (int i = p.degree_x(); i >= 0; --i) {
    Wide row = 0;
    for (int j = p.degree_y(); j >= 0; --j) row = row * y + p.coefficient(i, j);
    sum = sum * x + row;
  }
  return static_cast<double>(sum);
}

TEST(ExplicitPolynomial, PatchIsThePolynomial) {
  Random random(1);
  const Domain rectangles[] = {{0, 1, 0, 1}, {-1, 1, -1, 1}, {-3, 0.5, 2, 2.125}, {100, 101, -50, -48}};
  for (int m = 0; m <= max_degree; ++m)
    for (int n = 0; n <= max_degree; n += 3)
      for (const Domain& r : rectangles) {
        // Far rectangles: degrees up to 7 keep what cancels below 2^50.
        if (r.u0 > 10 && (m > 3 || n > 3)) continue;
        std::vector<double> a(static_cast<std::size_t>((m + 1) * (n + 1)));
        for (double& x : a) x = uniform(random, -1, 1);
        const ExplicitPolynomial p = graph(m, n, a, r);
        const auto grid = to_bezier(p);
        ASSERT_TRUE(grid.ok()) << grid.status().message();
        ASSERT_EQ(grid->patches().size(), 1u);
        EXPECT_EQ(grid->domain(), r);
        const BezierPatch& patch = grid->patches()[0];
        EXPECT_EQ(patch.degree_u(), std::max(1, m));
        EXPECT_EQ(patch.degree_v(), std::max(1, n));
        const double unit = double_unit * largest_coefficient(patch);
        for (int k = 0; k < 5; ++k) {
          const double s = k == 0 ? 0 : k == 1 ? 1 : std::floor(uniform(random, 0, 1024)) / 1024;
          const double t = std::floor(uniform(random, 0, 1024)) / 1024;
          const double x = r.u_at(s), y = r.v_at(t);
          EXPECT_TRUE(within_units(de_casteljau(patch, s, t), {x, y, height(p, x, y)}, unit, 8)) << m << " " << n;
          EXPECT_NEAR(evaluate_jet(p, x, y).position.z, height(p, x, y),
                      2 * double_unit * std::abs(height(p, x, y)) + 1e-300);
        }
      }
}

TEST(ExplicitPolynomial, PowersThatCancelFarFromZero) {
  // (x - 1000)^4 (y + 500)^2 in monomials: heights below 1 of terms above 1e17.
  const double x4[] = {1e12, -4e9, 6e6, -4e3, 1}, y2[] = {250000, 1000, 1};
  std::vector<double> a;
  for (const double p : x4)
    for (const double q : y2) a.push_back(p * q);
  const ExplicitPolynomial p = graph(4, 2, a, {1000, 1001, -501, -499});
  const auto grid = to_bezier(p);
  ASSERT_TRUE(grid.ok());
  const double heights[] = {1, -1, 1};  // (2t - 1)^2 for y + 500 from -1 to 1
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 2; ++j) EXPECT_NEAR(grid->patches()[0].point(i, j).z, i == 4 ? heights[j] : 0, 1e-14);
  for (int k = 0; k <= 16; ++k) {
    const double s = k / 16.0;
    EXPECT_NEAR(evaluate_jet(p, 1000 + s, -500.5).position.z, s * s * s * s / 4, 1e-14);
    EXPECT_NEAR(evaluate_jet(p, 1000 + s, -500.5).duu.z, 12 * s * s / 4, 1e-13);
  }
}

TEST(ExplicitPolynomial, DerivativesOfAMonomial) {
  // 3 x^2 y^3
  std::vector<double> a(12);
  a[2 * 4 + 3] = 3;
  const SurfaceJet jet = evaluate_jet(graph(2, 3, a, {0, 1, 0, 1}), 2, -1);
  EXPECT_EQ(jet.position, (Vec3{2, -1, -12}));
  EXPECT_EQ(jet.du, (Vec3{1, 0, -12}));
  EXPECT_EQ(jet.dv, (Vec3{0, 1, 36}));
  EXPECT_EQ(jet.duu, (Vec3{0, 0, -6}));
  EXPECT_EQ(jet.duv, (Vec3{0, 0, 36}));
  EXPECT_EQ(jet.dvv, (Vec3{0, 0, -72}));
}

TEST(ExplicitPolynomial, RefusesBadInput) {
  const auto code = [](int m, int n, std::vector<double> a, const Domain& r) {
    return ExplicitPolynomial::make(m, n, a, r).status();
  };
  const Domain unit;
  EXPECT_EQ(code(-1, 0, {}, unit).code(), StatusCode::unsupported_degree);
  EXPECT_EQ(code(0, 16, std::vector<double>(17), unit).code(), StatusCode::unsupported_degree);
  EXPECT_EQ(code(1, 1, {1, 2, 3}, unit).code(), StatusCode::count_mismatch);
  EXPECT_EQ(code(1, 1, {1, 2, nan, 4}, unit).code(), StatusCode::non_finite);
  EXPECT_EQ(code(1, 1, {1, 2, nan, 4}, unit).index(), 2);
  EXPECT_EQ(code(1, 1, {1, 2, nan, 4}, unit).message(), "coefficient [1][0] of the polynomial is not finite");
  EXPECT_EQ(code(0, 0, {1}, {1, 0, 0, 1}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code(0, 0, {1}, {0, 1, 2, 2}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code(0, 0, {1}, {0, nan, 0, 1}).code(), StatusCode::non_finite);
  EXPECT_EQ(to_bezier(graph(2, 0, {0, 0, 1}, {0, 1e200, 0, 1})).status().code(), StatusCode::non_finite);
}

}}  // namespace tessera::test
