// Ruled surfaces and Coons patches whose borders or blends are functions, as fitted patches.

#include <cmath>
#include <stdexcept>

#include "support/borders.h"
#include "support/errors.h"
#include "tessera/generic_callable.h"

namespace tessera::test { namespace {

/// The largest distance between a surface and its patches.
template <class Surface>
double deviation(const Surface& surface, const PatchGrid& grid) {
  double largest = 0;
  for (const double u : parameters_over(grid.breaks_u(), 7))
    for (const double v : parameters_over(grid.breaks_v(), 7))
      largest = std::max(largest, length(grid.evaluate_jet(u, v)->position - value_of(position(surface, u, v))));
  return largest;
}

/// A border from (x0, y0) to (x1, y1) in waves, as an expression: derivatives and bounds follow.
ParametricCurve wave(const Vec3& from, const Vec3& to, double waves) {
  const auto curve = [=](auto t) {
    using std::sin;
    const auto z = 0.25 * sin(waves * t) * t * (1.0 - t);
    return std::array{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), from.z + t * (to.z - from.z) + z};
  };
  return value_of(generic_curve(curve));
}
CoonsBorders wavy_borders() {
  const Vec3 r00{0, 0, 0}, r01{0, 1, 0.5}, r10{1, 0, 0}, r11{1, 1, -0.5};
  return {wave(r00, r10, 3), wave(r01, r11, 5), wave(r00, r01, 7), wave(r10, r11, 4)};
}

TEST(CoonsFit, IsCertifiedWhereAllBordersHaveBounds) {
  const Blend quintic =
      value_of(Blend::polynomial(std::vector<double>{1, 0, 0, -10, 15, -6}, std::vector<double>{0, 0, 0, 10, -15, 6}));
  for (const Blend& blend : {Blend::linear(), Blend::cubic(), quintic})
    for (const double tolerance : {1e-3, 1e-5}) {
      const CoonsPatch patch = coons(wavy_borders(), blend);
      EXPECT_FALSE(patch.is_exact());
      const PatchGrid grid = value_of(to_bezier(patch, {.tolerance = tolerance}));
      EXPECT_TRUE(grid.fit_error().certified);
      EXPECT_LE(grid.fit_error().distance, tolerance);
      EXPECT_LE(deviation(patch, grid), grid.fit_error().distance);
      EXPECT_GT(deviation(patch, grid), 0);
    }
}

TEST(CoonsFit, ExactBordersAmongFunctionsHaveBoundsToo) {
  CoonsBorders borders = wavy_borders();
  borders.c1 = value_of(Curve::bezier(std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 1}, {1, 0, 0}}));
  const CoonsPatch patch = coons(borders);
  const PatchGrid grid = value_of(to_bezier(patch, {.tolerance = 1e-4}));
  EXPECT_TRUE(grid.fit_error().certified);
  EXPECT_LE(deviation(patch, grid), grid.fit_error().distance);
  borders.c1 =
      value_of(Curve::bezier(std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 1}, {1, 0, 0}}, std::vector<double>{1, 2, 1}));
  const PatchGrid sampled = value_of(to_bezier(coons(borders), {.tolerance = 1e-4}));
  EXPECT_FALSE(sampled.fit_error().certified) << "derivatives of a rational border have no bound";
  EXPECT_LE(deviation(coons(borders), sampled), 1e-4);
}

TEST(CoonsFit, IsSampledWhereABlendIsAFunction) {
  Random random(1);
  const auto cosine = [](double t) { return 0.5 + 0.5 * std::cos(std::acos(-1.0) * t); };
  const Blend blend = value_of(Blend::callable(cosine, [=](double t) { return 1 - cosine(t); }));
  const CoonsPatch patch =
      coons(random_borders(random, {{{3, 1}, {2}, {3, 0, true}, {2}}}), {.f = blend, .g = Blend::cubic()});
  EXPECT_FALSE(patch.is_exact());
  const PatchGrid grid = value_of(to_bezier(patch, {.tolerance = 1e-5}));
  EXPECT_FALSE(grid.fit_error().certified);
  EXPECT_LE(deviation(patch, grid), 1e-5);
}

// A border that is a spline with a kink: patches end there, and the bound is proven.
TEST(CoonsFit, BreaksAtTheKnotsOfItsBorders) {
  CoonsBorders borders = wavy_borders();
  const std::vector<Vec3> points{{0, 0, 0}, {0.2, 0, 0.4}, {0.3, 0, 0}, {0.6, 0, 0.5}, {1, 0, 0}};
  borders.c1 = value_of(Curve::b_spline(2, points, std::vector<double>{0, 0, 0, 0.3, 0.3, 1, 1, 1}));
  const CoonsPatch patch = coons(borders, Blend::cubic());
  const PatchGrid grid = value_of(to_bezier(patch, {.tolerance = 1e-4, .breaks_u = {0.7}}));
  for (const double knot : {0.3, 0.7}) EXPECT_TRUE(std::ranges::binary_search(grid.breaks_u(), knot));
  EXPECT_TRUE(grid.fit_error().certified);
  EXPECT_LE(grid.fit_error().distance, 1e-4);
  EXPECT_LE(deviation(patch, grid), grid.fit_error().distance);
  expect_refused(to_bezier(patch, {.breaks_u = {0.7, 0.2}}), StatusCode::invalid_argument, 2, "breakpoint");
}

TEST(RuledFit, OfFunctions) {
  const auto sine = [](auto u) {
    using std::cos, std::sin;
    return std::array{u, sin(1.5 * u), cos(1.5 * u)};
  };
  const Curve parabola = quadratic({0, 0, 0}, {1, 0, -0.5}, {0, 1, 0});
  for (const Direction straight : {Direction::u, Direction::v}) {
    const RuledSurface surface =
        value_of(RuledSurface::make(value_of(generic_curve(sine)), parabola, {2, 5}, straight));
    EXPECT_FALSE(surface.is_exact());
    const PatchGrid grid = value_of(to_bezier(surface, {.tolerance = 1e-6}));
    EXPECT_EQ(grid.domain(), surface.domain());
    EXPECT_TRUE(grid.fit_error().certified);
    EXPECT_LE(deviation(surface, grid), grid.fit_error().distance);
    EXPECT_EQ(straight == Direction::v ? grid.count_v() : grid.count_u(), 1u) << "straight lines need one patch";
  }
}

TEST(CoonsFit, FailsAsItsBordersDo) {
  CoonsBorders borders = wavy_borders();
  borders.d2 = callable([](double v) { return Vec3{1, v, v > 0.3 && v < 0.4 ? not_a_number : -0.5 * v}; });
  expect_refused(to_bezier(coons(borders)), StatusCode::non_finite, -1, "border D2: the curve at t = 0.3");
  borders.d2 = callable([](double v) {
    return v > 0.3 && v < 0.4 ? throw std::runtime_error("hole") : Vec3{1, v, -0.5 * v};
  });
  expect_refused(to_bezier(coons(borders)), StatusCode::invalid_argument, -1, "threw: hole");
  const auto line = [](double t) { return Vec3{t, 1, t == 0.5 ? not_a_number : 0}; };
  expect_refused(to_bezier(value_of(RuledSurface::make(callable(line), quadratic({}, {1, 0, 0}, {})))),
                 StatusCode::non_finite, -1, "the first curve: the curve at t = 0.5");
}

}}  // namespace tessera::test
