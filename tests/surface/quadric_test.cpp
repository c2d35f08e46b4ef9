// Quadrics: their classification at any place, their frames, their parametrisations, and errors.

#include "tessera/quadric.h"

#include <limits>
#include <numbers>

#include "support/quadrics.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

constexpr double quadric_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double quadric_infinity = std::numeric_limits<double>::infinity();
QuadricCoefficients times(double s, const QuadricCoefficients& q) {
  return {s * q.a, s * q.b, s * q.c, s * q.d, s * q.e, s * q.f, s * q.g, s * q.h, s * q.j, s * q.k};
}
/// P Q P^T, and the sum of its terms' sizes.
double value(const QuadricCoefficients& q, const Vec3& p, double& size) {
  const double terms[] = {
      q.a * p.x * p.x,     q.b * p.y * p.y, q.c * p.z * p.z, 2 * q.d * p.x * p.y, 2 * q.e * p.y * p.z,
      2 * q.f * p.x * p.z, 2 * q.g * p.x,   2 * q.h * p.y,   2 * q.j * p.z,       q.k};
  double sum = 0;
  size = 0;
  for (const double term : terms) sum += term, size += std::abs(term);
  return sum;
}

void expect_rotation(const QuadricFrame& frame) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(frame.axes[i], frame.axes[j]), i == j, 4 * double_unit);
  EXPECT_NEAR(dot(cross(frame.axes[0], frame.axes[1]), frame.axes[2]), 1, 4 * double_unit);
}

TEST(Quadric, CanonicalOnesKeepTheirFrame) {
  for (const QuadricSample& sample : quadric_samples())
    for (const double factor : {1.0, -1.0, 0.1, -1e150, 1e-150}) {
      const Quadric found = quadric(times(factor, sample.coefficients));
      EXPECT_EQ(name(found.kind()), name(sample.kind));
      EXPECT_LT(max_abs(found.size() - sample.size), 1e-15) << name(sample.kind);
      EXPECT_EQ(found.frame().origin, Vec3{});
      EXPECT_EQ(found.frame().axes[0], (Vec3{1, 0, 0})) << name(sample.kind);
      EXPECT_EQ(found.frame().axes[1], (Vec3{0, 1, 0}));
      EXPECT_EQ(found.frame().axes[2], (Vec3{0, 0, 1}));
    }
}

TEST(Quadric, KindAndSizesDontDependOnPlaceTurnOrScale) {
  Random random(1);
  for (const QuadricSample& sample : quadric_samples())
    for (const double distance : {0.0, 1.0, 30.0})
      for (int k = 0; k < 20; ++k) {
        const QuadricFrame frame = random_frame(random, distance);
        const double factor = (k % 2 ? -1 : 1) * std::exp(uniform(random, -20, 20));
        const Quadric found = quadric(times(factor, moved(sample.coefficients, frame)));
        ASSERT_EQ(name(found.kind()), name(sample.kind)) << "at " << distance;
        expect_rotation(found.frame());
        const Vec3& size = found.size();
        // Axes of like sign may have changed places, and those of a point or line are known up to a factor.
        const double near = std::min(max_abs(size - sample.size), max_abs(Vec3{size.y, size.x, size.z} - sample.size));
        const double limit = 1e-9 * (1 + distance * distance);
        if (sample.kind == QuadricKind::ellipsoid || sample.kind == QuadricKind::imaginary_ellipsoid) {
          EXPECT_NEAR(size.x * size.y * size.z, 1, limit);
          EXPECT_NEAR(length(size), std::sqrt(5.25), limit);
        } else if (sample.kind != QuadricKind::line && sample.kind != QuadricKind::point) {
          EXPECT_LT(near, limit) << name(sample.kind) << size.x << " " << size.y << " " << size.z;
        }
      }
}

TEST(Quadric, CentreIsFound) {
  Random random(2);
  for (const QuadricSample& sample : quadric_samples()) {
    if (sample.kind > QuadricKind::hyperbolic_paraboloid && sample.kind != QuadricKind::point) continue;
    const QuadricFrame frame = random_frame(random, 10);
    EXPECT_LT(max_abs(quadric(moved(sample.coefficients, frame)).frame().origin - frame.origin), 1e-11)
        << name(sample.kind);
  }
}

TEST(Quadric, ToleranceDecides) {
  const QuadricCoefficients nearly{.a = 1, .b = 1, .c = 1e-8, .k = -1};
  EXPECT_EQ(quadric(nearly).kind(), QuadricKind::ellipsoid);
  EXPECT_EQ(quadric(nearly, {.tolerance = 1e-7}).kind(), QuadricKind::elliptic_cylinder);
  const QuadricCoefficients cone{.a = 1, .b = 1, .c = -1, .g = 1e3, .k = 1e6 - 1e-4};
  EXPECT_EQ(quadric(cone).kind(), QuadricKind::hyperboloid_one_sheet);
  EXPECT_EQ(quadric(cone, {.tolerance = 1e-9}).kind(), QuadricKind::elliptic_cone);
  // A linear term that matters only at 1e20 is ignored at the size of the cylinder.
  const QuadricCoefficients cylinder{.a = 1, .b = 1, .j = 1e-20, .k = -1};
  EXPECT_EQ(quadric(cylinder).kind(), QuadricKind::elliptic_cylinder);
  EXPECT_EQ(quadric(cylinder, {.length = 1e3}).kind(), QuadricKind::elliptic_cylinder);
  // A square that matters only at 1e20: the caller must set the length of interest.
  const QuadricCoefficients plane{.a = 1e-20, .h = 1};
  EXPECT_EQ(quadric(plane).kind(), QuadricKind::parabolic_cylinder);
  EXPECT_EQ(quadric(plane, {.length = 1}).kind(), QuadricKind::plane);
}

TEST(Quadric, RefusesBadCoefficients) {
  const double good[10] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  for (const double bad : {quadric_nan, quadric_infinity, -quadric_infinity})
    for (std::ptrdiff_t k = 0; k < 10; ++k) {
      double q[10];
      std::copy(good, good + 10, q);
      q[k] = bad;
      const auto result = Quadric::make({q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7], q[8], q[9]});
      ASSERT_FALSE(result.ok());
      EXPECT_EQ(result.status().code(), StatusCode::non_finite);
      EXPECT_EQ(result.status().index(), k);
    }
  EXPECT_EQ(Quadric::make({}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(Quadric::make({}).status().message(),
            "all ten coefficients of the quadric are 0: every point satisfies it");
  for (const double bad : {0.0, -1.0, 0.5, quadric_nan})
    EXPECT_EQ(Quadric::make({.a = 1}, {.tolerance = bad}).status().code(), StatusCode::invalid_argument);
  for (const double bad : {-1.0, quadric_nan, quadric_infinity})
    EXPECT_EQ(Quadric::make({.a = 1}, {.length = bad}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(Quadric::make({.a = 1e-310, .h = 1}).status().code(), StatusCode::non_finite);
}

TEST(Quadric, RandomCoefficientsGiveAKindOrAnError) {
  Random random(3);
  for (int k = 0; k < 3000; ++k) {
    const auto any = [&] {
      return random() % 3 == 0 ? 0 : uniform(random, -1, 1) * std::pow(10, uniform(random, -300, 300));
    };
    const auto result = Quadric::make({any(), any(), any(), any(), any(), any(), any(), any(), any(), any()});
    if (!result) continue;
    EXPECT_TRUE(is_finite(result->frame().origin));
    EXPECT_TRUE(is_finite(result->size()));
    expect_rotation(result->frame());
    if (HasFailure()) FAIL() << k;
  }
}

TEST(QuadricPiece, PointsSatisfyTheEquation) {
  Random random(4);
  for (const QuadricSample& sample : quadric_samples())
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet)
      for (int k = 0; k < 50; ++k) {
        const QuadricCoefficients q = moved(sample.coefficients, random_frame(random, 3));
        const Domain range = sample_range(sample.kind);
        const QuadricPiece part = piece(quadric(q), range, sheet);
        const double u = uniform(random, range.u0, range.u1), v = uniform(random, range.v0, range.v1);
        double size = 0;
        EXPECT_NEAR(value(q, evaluate_jet(part, u, v).position, size), 0, 1e-12 * (1 + size)) << name(sample.kind);
        const auto found = part.locate(evaluate_jet(part, u, v).position);
        ASSERT_TRUE(found.has_value()) << name(sample.kind) << " sheet " << sheet << " at " << u << " " << v;
        EXPECT_EQ(found->sheet, sheet);
        EXPECT_LT(max_abs(evaluate_jet(part, found->u, found->v).position - evaluate_jet(part, u, v).position), 1e-11);
      }
}

TEST(QuadricPiece, DerivativesAreThoseOfThePosition) {
  Random random(5);
  for (const QuadricSample& sample : quadric_samples())
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet) {
      const QuadricPiece part =
          piece(quadric(moved(sample.coefficients, random_frame(random, 1))), sample_range(sample.kind), sheet);
      const double u = 0.7, v = 0.6, h = 1e-5;
      const SurfaceJet at = evaluate_jet(part, u, v);
      const SurfaceJet u0 = evaluate_jet(part, u - h, v), u1 = evaluate_jet(part, u + h, v);
      const SurfaceJet v0 = evaluate_jet(part, u, v - h), v1 = evaluate_jet(part, u, v + h);
      const double s = 1 / (2 * h);
      EXPECT_LT(max_abs(at.du - s * (u1.position - u0.position)), 1e-8);
      EXPECT_LT(max_abs(at.dv - s * (v1.position - v0.position)), 1e-8);
      EXPECT_LT(max_abs(at.duu - s * (u1.du - u0.du)), 1e-8);
      EXPECT_LT(max_abs(at.duv - s * (v1.du - v0.du)), 1e-8);
      EXPECT_LT(max_abs(at.dvv - s * (v1.dv - v0.dv)), 1e-8);
    }
}

/// Parameters far outside of a piece go on around it; quarter turns are not counted in whole numbers there.
TEST(QuadricPiece, ParametersOfAnySize) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}), {0, 1, 0, 1});
  for (const double u : {1e9, -1e19, 1e100, 1.7e308})
    EXPECT_NEAR(length(evaluate_jet(part, u, 0.5).position), 1, 1e-14) << u;
  EXPECT_TRUE(std::isnan(evaluate_jet(part, std::nan(""), 0.5).position.x));
}

TEST(QuadricPiece, LocateKnowsThePieceFromTheRest) {
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  const QuadricPiece part =
      piece(sphere, {3 * std::numbers::pi / 2, 5 * std::numbers::pi / 2, 0, std::numbers::pi / 2});
  EXPECT_TRUE(part.locate({1, 0, 0}).has_value());
  EXPECT_NEAR(part.locate({1, 0, 0})->u, 2 * std::numbers::pi, 1e-12);
  EXPECT_TRUE(part.locate({0, 0, 1}).has_value());
  EXPECT_FALSE(part.locate({-1, 0, 0}).has_value());
  EXPECT_FALSE(part.locate({0.6, 0, -0.8}).has_value());
  EXPECT_FALSE(part.locate({quadric_nan, 0, 0}).has_value());
}

TEST(QuadricPiece, RefusesBadRanges) {
  const Quadric sphere = quadric({.a = 1, .b = 1, .c = 1, .k = -1});
  const auto code = [](const Quadric& q, const Domain& range, int sheet = 0) {
    return QuadricPiece::make(q, range, sheet).status().code();
  };
  EXPECT_EQ(code(sphere, {1, 0, 0, 1}), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {0, 1, 1, 1}), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {0, 6.3, 0, 1}), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {0, 1, 0, 1.6}), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {200, 201, 0, 1}), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {quadric_nan, 1, 0, 1}), StatusCode::non_finite);
  EXPECT_EQ(code(sphere, {0, 1, 0, quadric_infinity}), StatusCode::non_finite);
  EXPECT_EQ(code(sphere, {0, 2 * std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 2}), StatusCode::ok);
  EXPECT_EQ(code(sphere, {0, 1, 0, 1}, 1), StatusCode::invalid_argument);
  EXPECT_EQ(code(sphere, {0, 1, 0, 1}, -1), StatusCode::invalid_argument);
  EXPECT_EQ(code(quadric({.a = 1, .b = 1, .c = -1, .k = -1}), {0, 1, 0, 301}), StatusCode::invalid_argument);
  EXPECT_EQ(code(quadric({.a = 1, .j = -1}), {0, 1e200, 0, 1}), StatusCode::non_finite);
  for (const QuadricSample& sample : quadric_samples())
    if (!is_surface(sample.kind)) {
      EXPECT_EQ(code(quadric(sample.coefficients), {0, 1, 0, 1}), StatusCode::unsupported);
    }
}

}}  // namespace tessera::test
