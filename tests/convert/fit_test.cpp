// Fits of functions: bounds that are proofs, refinement where it is needed, borders and poles that do not split.

#include <stdexcept>

#include "support/errors.h"
#include "support/lecture_surfaces.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

/// The largest distance at equal parameters, on `count` x `count` points of every patch, away from the places that fits
/// sample.
double fit_deviation(const ParametricSurface& surface, const PatchGrid& grid, int count) {
  double largest = 0;
  for (std::size_t k = 0; k < grid.patches().size(); ++k) {
    const Domain d = grid.patch_domain(k);
    for (int i = 0; i <= count; ++i)
      for (int j = 0; j <= count; ++j) {
        const double s = static_cast<double>(i) / count, t = static_cast<double>(j) / count;
        const Vec3 there = value_of(surface.position(d.u_at(s), d.v_at(t)));
        largest = std::max(largest, length(there - de_casteljau(grid.patches()[k], s, t)));
      }
  }
  return largest;
}

/// The surface without bounds and derivatives.
ParametricSurface bare(const ParametricSurface& surface) {
  return value_of(ParametricSurface::make(
      {.position = [surface](double u, double v) { return value_of(surface.position(u, v)); }}, surface.domain()));
}

template <class F>
ParametricSurface of(const F& f, const Domain& domain = {}) {
  return value_of(generic_surface(f, domain));
}
template <class F>
ParametricSurface over_disc(const F& f) {
  return value_of(generic_surface_over_disc(f));
}

/// Section 12's callables, and some that are not polynomials.
struct RuledOfWaves {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::cos, std::sin;
    return {u, (1 - v) * sin(pi * u / 2) + v * u * u, (1 - v) * cos(pi * u / 2) - v * u / 2};
  }
};
struct RuledOfParabolaAndWave {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::sin;
    return {u, v, (1 - v) * 4 * u * (1 - u) + v * sin(2 * pi * u)};
  }
};
struct Bump {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::exp;
    return {u, v, 1 / (1 + 9 * u * u + 4 * v * v) + exp(-3 * ((u - 0.5) * (u - 0.5) + v * v))};
  }
  static constexpr Domain domain{-1, 1, -1, 1};
};

struct Named {
  const char* name;
  ParametricSurface surface;
};
std::vector<Named> smooth_surfaces() {
  return {{"plane", of(Plane{}, Plane::domain)},
          {"cylinder", of(Cylinder{}, Cylinder::domain)},
          {"paraboloid", of(Paraboloid{}, Paraboloid::domain)},
          {"hemisphere", over_disc(RationalHemisphere{})},
          {"torus", of(Torus{}, Torus::domain)},
          {"ruled of waves", of(RuledOfWaves{})},
          {"ruled of a parabola and a wave", of(RuledOfParabolaAndWave{})},
          {"bump", of(Bump{}, Bump::domain)}};
}

void expect_watertight(const PatchGrid& grid) {
  for (std::size_t a = 0; a < grid.count_u(); ++a)
    for (std::size_t b = 0; b < grid.count_v(); ++b) {
      const BezierPatch& patch = grid.patch(a, b);
      const int n = patch.degree_u();
      for (int k = 0; k <= n; ++k) {
        ASSERT_TRUE(a + 1 == grid.count_u() || patch.point(n, k) == grid.patch(a + 1, b).point(0, k));
        ASSERT_TRUE(b + 1 == grid.count_v() || patch.point(k, n) == grid.patch(a, b + 1).point(k, 0));
      }
    }
}

TEST(Fit, CertifiedBoundsHoldAndAreNotFarAbove) {
  for (const auto& [name, surface] : smooth_surfaces())
    for (const double tolerance : {1e-4, 1e-7}) {
      for (const int degree : {3, 5}) {
        const PatchGrid grid = value_of(to_bezier(surface, {.tolerance = tolerance, .degree = degree}));
        const FitError error = grid.fit_error();
        EXPECT_TRUE(error.certified) << name;
        EXPECT_LE(error.distance, tolerance) << name;
        const double found = fit_deviation(surface, grid, grid.patches().size() > 1000 ? 6 : 12);
        EXPECT_LE(found, error.distance + 1e-15) << name << ", tolerance " << tolerance << ", degree " << degree;
        // Overestimation by intervals shrinks with the cells.
        EXPECT_TRUE(tolerance > 1e-5 || degree == 5 || error.distance <= 20 * found + 1e-13) << name;
        expect_watertight(grid);
      }
    }
}

TEST(Fit, SampledFitsKeepTheTolerance) {
  for (const auto& [name, surface] : smooth_surfaces())
    for (const int degree : {2, 3, 6}) {
      const PatchGrid grid = value_of(to_bezier(bare(surface), {.tolerance = 1e-5, .degree = degree}));
      EXPECT_FALSE(grid.fit_error().certified);
      EXPECT_LE(grid.fit_error().distance, 1e-5);
      const double found = fit_deviation(surface, grid, 13);
      EXPECT_LE(found, 1.05 * grid.fit_error().distance + 1e-14) << name << " " << degree;
      expect_watertight(grid);
    }
}

TEST(Fit, DefaultToleranceIsAMillionthOfTheBox) {
  const PatchGrid grid = value_of(to_bezier(of(Torus{}, Torus::domain)));
  EXPECT_LE(grid.fit_error().distance, 1e-6 * std::sqrt(8 * 8 + 8 * 8 + 2 * 2.0));
  EXPECT_GE(grid.fit_error().distance, 1e-8);
  // A surface that is one point has no size; its tolerance is rounding.
  const auto point = [](double, double) { return Vec3{7, 8, 9}; };
  const PatchGrid one = value_of(to_bezier(value_of(ParametricSurface::make({.position = point}))));
  ASSERT_EQ(one.patches().size(), 1u);
  for (const Vec3& p : one.patches()[0].points()) EXPECT_EQ(p, (Vec3{7, 8, 9}));
}

TEST(Fit, FiguresOfTheDocuments) {
  const PatchGrid first = value_of(to_bezier(of(RuledOfWaves{}), {.tolerance = 1e-12, .degree = 9}));
  EXPECT_TRUE(within_units(first.evaluate_jet(0.25, 0.75)->position, {0.25, 0.142545858, 0.137219883}, 1e-9, 0.501));
  const PatchGrid second = value_of(to_bezier(of(RuledOfParabolaAndWave{}), {.tolerance = 1e-12, .degree = 9}));
  EXPECT_NEAR(second.evaluate_jet(0.25, 0.75)->position.z, 0.9375, 1e-12);
}

TEST(Fit, ReproducesPolynomials) {
  Random random(1);
  for (int n = 2; n <= max_degree; ++n) {
    const BezierPatch patch = random_polynomial(random, n, n);
    const Domain domain{-1, 3, 10, 11};
    const auto f = [&](double u, double v) { return de_casteljau(patch, domain.local_u(u), domain.local_v(v)); };
    SurfaceFunctions functions{.position = f};
    for (const bool bounds : {false, true}) {
      // Derivatives of order n + 1 are 0; lower ones are needed only to bound rounding.
      if (bounds)
        functions.derivative_bounds = [n](const Domain&, int k) {
          return k > n ? std::array<double, 2>{0, 0} : std::array<double, 2>{100, 100};
        };
      const auto grid =
          to_bezier(value_of(ParametricSurface::make(functions, domain)), {.tolerance = 1e-8, .degree = n});
      ASSERT_TRUE(grid.ok()) << grid.status().message();
      ASSERT_EQ(grid->patches().size(), 1u) << n;
      EXPECT_EQ(grid->fit_error().certified, bounds) << n;
      EXPECT_LE(fit_deviation(value_of(ParametricSurface::make(functions, domain)), *grid, 10), 1e-13) << n;
    }
  }
}

TEST(Fit, ASShapedPieceIsNotTakenForItsChord) {
  // z = sin(2 pi u) sin(2 pi v): zero on all borders, in the middle and on both middle lines.
  const auto waves = [](double u, double v) { return Vec3{u, v, std::sin(2 * pi * u) * std::sin(2 * pi * v)}; };
  const ParametricSurface surface = value_of(ParametricSurface::make({.position = waves}));
  const PatchGrid grid = value_of(to_bezier(surface, {.tolerance = 1e-4}));
  EXPECT_LE(fit_deviation(surface, grid, 16), 1e-4);
  // Section 12's S-piece, z-rows (0, 1, -1, 0), is a cubic and comes back as one patch, with its extrema.
  const auto piece = [](double u, double v) { return Vec3{u, v, 3 * u * (1 - u) * (1 - 2 * u)}; };
  const PatchGrid cubic = value_of(to_bezier(value_of(ParametricSurface::make({.position = piece}))));
  ASSERT_EQ(cubic.patches().size(), 1u);
  const double expected[] = {0, 1, -1, 0};
  for (int i = 0; i <= 3; ++i) EXPECT_NEAR(cubic.patches()[0].point(i, 2).z, expected[i], 1e-15);
  const double peak = (1 - std::sqrt(1.0 / 3)) / 2;
  EXPECT_NEAR(cubic.evaluate_jet(peak, 0.3)->position.z, std::sqrt(3.0) / 6, 1e-15);
  EXPECT_NEAR(cubic.evaluate_jet(0.5, 0.3)->position.z, 0, 1e-15);
}

TEST(Fit, InfiniteDerivativesAtABorder) {
  // Graded towards the rim of the hemisphere, where dz/drho is infinite.
  const ParametricSurface root = over_disc(RootHemisphere{});
  const PatchGrid grid = value_of(to_bezier(root, {.tolerance = 1e-6}));
  EXPECT_FALSE(grid.fit_error().certified);
  EXPECT_LE(fit_deviation(root, grid, 9), 1e-6);
  EXPECT_LE(grid.patches().size(), 5000u);
  const auto breaks = grid.breaks_u();
  EXPECT_LT(breaks.back() - breaks[breaks.size() - 2], 1e-10);
  EXPECT_GT(breaks[1], 0.05);
  EXPECT_LE(value_of(to_bezier(root, {.tolerance = 1e-6, .degree = 6})).patches().size(), 400u);
  expect_watertight(grid);
}

TEST(Fit, PolesAndSeams) {
  for (const ParametricSurface& surface : {over_disc(RootHemisphere{}), bare(over_disc(RationalHemisphere{}))})
    for (const int degree : {2, 3, 15}) {
      const PatchGrid grid = value_of(to_bezier(surface, {.tolerance = 1e-4, .degree = degree}));
      const Vec3 pole = value_of(surface.position(0, 0));
      for (std::size_t b = 0; b < grid.count_v(); ++b) {
        EXPECT_TRUE(grid.patch(0, b).collapsed_sides().has(Side::u0));
        EXPECT_EQ(grid.patch(0, b).point(0, degree), pole);
      }
      for (std::size_t a = 0; a < grid.count_u(); ++a)
        for (int i = 0; i <= degree; ++i)
          EXPECT_EQ(grid.patch(a, 0).point(i, 0), grid.patch(a, grid.count_v() - 1).point(i, degree));
    }
}

TEST(Fit, CallsAreInProportionToTheLattice) {
  std::size_t calls = 0;
  const auto counted = [&](const ParametricSurface& surface, bool bounds) {
    SurfaceFunctions functions;
    functions.position = [&calls, surface](double u, double v) {
      ++calls;
      return value_of(surface.position(u, v));
    };
    if (bounds)
      functions.derivative_bounds = [surface](const Domain& part, int k) { return surface.derivative_bounds(part, k); };
    return value_of(ParametricSurface::make(functions, surface.domain()));
  };
  for (const auto& [name, surface] : smooth_surfaces()) {
    const ParametricSurface certified = counted(surface, true), sampled = counted(surface, false);
    calls = 0;
    PatchGrid grid = value_of(to_bezier(certified, {.tolerance = 1e-6}));
    EXPECT_EQ(calls, 289 + (3 * grid.count_u() + 1) * (3 * grid.count_v() + 1)) << name;
    calls = 0;
    grid = value_of(to_bezier(sampled, {.tolerance = 1e-6}));
    EXPECT_LE(calls, 289 + 45 * (3 * grid.count_u() + 1) * (3 * grid.count_v() + 1)) << name;
    calls = 0;
    EXPECT_FALSE(value_of(to_bezier(certified, {.tolerance = 1e-6, .certify = false})).fit_error().certified);
  }
}

TEST(Fit, BoundsThatDoNotSufficeGiveWayToSamples) {
  // Bounds that are infinite everywhere, or far too large: the fit equals the one without bounds.
  for (const double bound : {infinity, 1e30}) {
    const auto waves = [](double u, double v) { return Vec3{u, v, std::sin(u + v)}; };
    const auto none = [bound](const Domain&, int) { return std::array<double, 2>{bound, bound}; };
    const FitOptions options{.tolerance = 1e-6, .max_patches = 4096};
    const PatchGrid with =
        value_of(to_bezier(value_of(ParametricSurface::make({.position = waves, .derivative_bounds = none})), options));
    const PatchGrid without = value_of(to_bezier(value_of(ParametricSurface::make({.position = waves})), options));
    EXPECT_FALSE(with.fit_error().certified);
    EXPECT_EQ(with.fit_error().distance, without.fit_error().distance);
    EXPECT_EQ(with.patches().size(), without.patches().size());
  }
}

TEST(Fit, RefusesBadInput) {
  const ParametricSurface torus = of(Torus{}, Torus::domain);
  const auto refused = [&](const FitOptions& options, const std::string& words) {
    expect_refused(to_bezier(torus, options), StatusCode::invalid_argument, -1, words);
  };
  refused({.tolerance = -1}, "the tolerance is -1");
  refused({.tolerance = not_a_number}, "the tolerance is nan");
  refused({.tolerance = infinity}, "the tolerance is inf");
  refused({.tolerance = 1e-300}, "below");
  refused({.degree = 1}, "degree of the patches is 1");
  refused({.degree = 16}, "degree of the patches is 16");
  refused({.max_patches = 0}, "max_patches is 0, the breakpoints alone make 1 patch");
  refused({.max_patches = 3, .breaks_u = {1}, .breaks_v = {1}},
          "max_patches is 3, the breakpoints alone make 4 patches");
  refused({.tolerance = 1e-6, .max_patches = 10}, "not kept by 10 patches, the largest count: the error is");
}

TEST(Fit, BreakpointsFromTheStart) {
  // A crease along u = 1/3 and a kink of the tangents along v = 0.7: cubics between them.
  const auto creased = [](double u, double v) { return Vec3{u, v, std::abs(u - 1.0 / 3) * v * v + std::abs(v - 0.7)}; };
  const ParametricSurface surface = value_of(ParametricSurface::make({.position = creased}));
  const PatchGrid with = value_of(to_bezier(surface, {.tolerance = 1e-6, .breaks_u = {1.0 / 3}, .breaks_v = {0.7}}));
  EXPECT_EQ(with.patches().size(), 4u);
  EXPECT_LE(fit_deviation(surface, with, 8), 1e-15);
  const PatchGrid without = value_of(to_bezier(surface, {.tolerance = 1e-6}));
  EXPECT_GT(without.patches().size(), 100u);
  EXPECT_LE(fit_deviation(surface, without, 8), 1.5e-6);  // the crease lies between samples
  for (const std::vector<double>& breaks : std::vector<std::vector<double>>{{0}, {1}, {not_a_number}, {-1}, {0.5, 0.5}})
    expect_refused(to_bezier(surface, {.breaks_v = breaks}), StatusCode::invalid_argument,
                   static_cast<std::ptrdiff_t>(breaks.size()) - 1, "breakpoint v[");
}

/// Squares of what is below 1e-162 are 0, and so are fourth powers of what is below 1e-81.
TEST(Fit, TinySurfacesAndDomainsAreMeasured) {
  const auto wave = [](double scale) {
    return value_of(ParametricSurface::make({.position = [scale](double u, double v) {
      return scale * Vec3{u, v, std::sin(30 * u)};
    }}));
  };
  const PatchGrid usual = value_of(to_bezier(wave(1))), tiny = value_of(to_bezier(wave(0x1p-560)));
  EXPECT_EQ(tiny.patches().size(), usual.patches().size());
  EXPECT_GT(tiny.fit_error().distance, 0);
  const auto power = [](double u, double) { return Vec3{std::pow(1e30 * u, 4), 0, 0}; };
  const auto bounds = [](const Domain& part, int k) {
    double factor = 1;
    for (int i = 0; i < k; ++i) factor *= 4 - i;
    return std::array{k > 4 ? 0.0 : factor * std::pow(1e30, k) * std::pow(1e30 * part.u1, 4 - k), 0.0};
  };
  const auto short_one =
      value_of(ParametricSurface::make({.position = power, .derivative_bounds = bounds}, {0, 1e-82, 0, 1}));
  const PatchGrid fit = value_of(to_bezier(short_one, {.tolerance = 1e-216}));
  EXPECT_TRUE(fit.fit_error().certified);
  EXPECT_LE(std::abs(fit.evaluate_jet(0.3e-82, 0.5)->position.x - std::pow(0.3e-52, 4)), fit.fit_error().distance);
}

TEST(Fit, NamesWhatGoesWrongInTheMiddle) {
  // A function that is NaN on a small spot that the coarse points miss; the samples of the fit meet it first.
  const auto spot = [](double u, double v) {
    return Vec3{u, v, u > 0.33 && u < 0.36 && v > 0.2 && v < 0.24 ? not_a_number : std::exp(u * v)};
  };
  expect_refused(to_bezier(value_of(ParametricSurface::make({.position = spot})), {.tolerance = 1e-12}),
                 StatusCode::non_finite, -1, "the surface at (u, v) = (0.3");
  const auto throws = [](double u, double v) -> Vec3 {
    if (u == 0.25) throw std::runtime_error("a quarter");
    return {u, v, 0};
  };
  expect_refused(to_bezier(value_of(ParametricSurface::make({.position = throws}))), StatusCode::invalid_argument, -1,
                 "(u, v) = (0.25, 0) threw: a quarter");
  // A jump along u = 1/3 is narrowed down, and named.
  const auto jump = [](double u, double v) { return Vec3{u, v, u < 1.0 / 3 ? 0.0 : 1.0}; };
  expect_refused(to_bezier(value_of(ParametricSurface::make({.position = jump}))), StatusCode::invalid_argument, -1,
                 "on the shortest interval of u: the error is");
  const auto huge = [](double u, double v) { return Vec3{1e300 * u, v, -1e300 * u * v}; };
  expect_refused(to_bezier(value_of(ParametricSurface::make({.position = huge}))), StatusCode::non_finite, -1,
                 "too large");
}

}}  // namespace tessera::test
