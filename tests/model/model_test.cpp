// Models: surfaces of every kind, placed, as one patch set.

#include "tessera/model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/errors.h"
#include "support/random_bases.h"
#include "support/random_hermite.h"
#include "support/random_splines.h"
#include "support/ulp.h"
#include "tessera/convert.h"
#include "tessera/generic_callable.h"
#include "tessera/model_part.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

Curve line_over(const Vec3& from, const Vec3& to, const Interval& interval = {}) {
  return value_of(Curve::bezier(std::vector{from, to}, {}, interval));
}

BezierPatch unit_square() {
  return value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}));
}

QuadricPiece half_cylinder() {
  const Quadric cylinder = value_of(Quadric::make({.a = 1, .b = 1, .k = -1}));
  return value_of(QuadricPiece::make(cylinder, {0, std::numbers::pi, -1, 2}));
}

ParametricSurface round_sheet() {
  return value_of(ParametricSurface::make({.position =
                                               [](double u, double v) {
                                                 return Vec3{std::cos(u), std::sin(u), v};
                                               }},
                                          {0, 2, 0, 1}));
}

/// One surface of each kind whose conversion is exact.
std::vector<Surface> exact_surfaces() {
  Random random(21);
  const auto knots = [&](std::size_t count) { return random_knots(random, count); };
  const std::vector<double> u = knots(3), v = knots(4);
  const Curve wave = random_curve(random, 3, {}, false);
  return {random_rational(random, 3, 2),
          value_of(TensorPatch::make(value_of(BasisMatrix::catmull_rom()), value_of(BasisMatrix::power(2)),
                                     random_cloud(random, 12), {-1, 1, 0, 3})),
          random_surface(random, 3, 2, {}, {.multiple = true}, true),
          random_hermite(random, {1, 3, -1, 0}),
          value_of(HermiteNetwork::on_knots(u, v, random_nodes(random, 3, 4))),
          value_of(RuledSurface::make(wave, line_over({0, 0, 0}, {1, 0, 0}, wave.domain()))),
          value_of(CoonsPatch::make({line_over({0, 0, 0}, {1, 0, 0}), line_over({0, 1, 0}, {1, 1, 2}),
                                     line_over({0, 0, 0}, {0, 1, 0}), line_over({1, 0, 0}, {1, 1, 2})})),
          value_of(ExplicitPolynomial::make(2, 1, std::vector<double>{1, 2, 3, 4, 5, 6}, {-1, 2, 0, 2})),
          half_cylinder()};
}

Affine askew() {
  return Affine::translated({5, -3, 2}) * Affine::rotated({1, 2, 3}, 0.8) * Affine::scaled({2, -0.5, 1.5});
}

TEST(Model, PatchesOfEveryKindHaveThePlacedSurfacesPoints) {
  Random random(22);
  for (const Surface& surface : exact_surfaces()) {
    SCOPED_TRACE(kind_name(surface));
    const ModelSurface placed{"", surface, askew()};
    const PatchGrid grid = value_of(to_bezier(placed));
    EXPECT_EQ(grid.fit_error().distance, 0);
    EXPECT_TRUE(grid.fit_error().certified);
    EXPECT_EQ(grid.domain(), domain(surface));
    double largest = 0;
    for (const BezierPatch& patch : grid.patches()) largest = std::max(largest, largest_coefficient(patch));
    for (int k = 0; k < 50; ++k) {
      const Domain d = domain(surface);
      const double s = uniform(random, d.u0, d.u1), t = uniform(random, d.v0, d.v1);
      const auto own = own_parameters(surface, s, t), back = grid_parameters(surface, own[0], own[1]);
      EXPECT_NEAR(back[0], s, 1e-13 * (1 + std::abs(s)));
      EXPECT_NEAR(back[1], t, 1e-13 * (1 + std::abs(t)));
      const SurfaceJet expected = value_of(evaluate_jet(placed, own[0], own[1]));
      const auto found = grid.evaluate_jet(s, t);
      ASSERT_TRUE(found);
      EXPECT_TRUE(within_units(found->position, expected.position, double_unit * largest, 32));
      if (std::holds_alternative<QuadricPiece>(surface)) continue;  // other pace within an arc
      EXPECT_TRUE(within_units(found->du, expected.du, 1e-12 * largest, 10));
      EXPECT_TRUE(within_units(found->dvv, expected.dvv, 1e-11 * largest, 100));
    }
  }
}

TEST(Model, APatchSetKnowsWhereItsPatchesCameFrom) {
  Model model;
  for (const Surface& surface : exact_surfaces()) model.surfaces.push_back({"", surface});
  const PatchSet set = value_of(make_patch_set(model));
  EXPECT_EQ(set.surface_count(), model.surfaces.size());
  EXPECT_EQ(set.fit_error().distance, 0);
  std::vector<std::size_t> counts(model.surfaces.size());
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const PatchSource& source = set.source(k);
    const Domain whole = domain(model.surfaces[source.surface].surface);
    EXPECT_TRUE(whole.contains(source.domain.u0, source.domain.v0) &&
                whole.contains(source.domain.u1, source.domain.v1));
    ++counts[source.surface];
  }
  for (std::size_t k = 0; k < counts.size(); ++k)
    EXPECT_EQ(counts[k], value_of(to_bezier(model.surfaces[k])).patches().size()) << k;
}

/// Tolerance and error are lengths in the model, whatever the placement does to the surface.
TEST(Model, FittedSurfacesKeepTheToleranceWhereTheyArePlaced) {
  const FitOptions fit{.tolerance = 1e-5};
  const Model model{"", {{"sheet", round_sheet(), Affine::scaled({100, 100, 100})}}};
  const PatchSet set = value_of(make_patch_set(model, {}, fit));
  EXPECT_GT(set.fit_error().distance, 0);
  EXPECT_LE(set.fit_error().distance, fit.tolerance);
  const PatchGrid grid = value_of(to_bezier(model.surfaces[0], fit));
  for (double u = 0; u <= 2; u += 0.01) {
    const Vec3 expected{100 * std::cos(u), 100 * std::sin(u), 50};
    EXPECT_LE(length(grid.evaluate_jet(u, 0.5)->position - expected), fit.tolerance) << u;
  }
}

/// Far from zero the points' own rounding counts: the stated error includes it, and a smaller tolerance is an error.
TEST(Model, ErrorsOfFitsHoldFarFromZero) {
  const auto bowl = value_of(generic_surface(
      [](auto u, auto v) {
        using std::cos;
        return std::array{u * 1.0, v * 1.0, cos(u) * cos(v)};
      },
      Domain{}));
  const FitOptions fit{.tolerance = 1e-10, .degree = 7};
  for (const double far : {0.0, 1e3, 1e4}) {
    const PatchGrid grid = value_of(to_bezier(ModelSurface{"", bowl, Affine::translated({far, far, far})}, fit));
    EXPECT_TRUE(grid.fit_error().certified);
    EXPECT_LE(grid.fit_error().distance, fit.tolerance);
    for (double u = 0; u <= 1; u += 0.01) {
      const Vec3 found = grid.evaluate_jet(u, 0.7)->position - Vec3{far, far, far};
      EXPECT_LE(length(found - Vec3{u, 0.7, std::cos(u) * std::cos(0.7)}),
                grid.fit_error().distance + 4 * double_unit * far);  // evaluation rounds too
    }
  }
  expect_refused(to_bezier(ModelSurface{"", bowl, Affine::translated({1e9, 0, 0})}, fit), StatusCode::invalid_argument,
                 Status::no_index, "below the rounding of the placed surface");
}

TEST(Model, PlacementsOfAnySizeAreTaken) {
  const FitOptions fit{.tolerance = 1e-3};
  EXPECT_TRUE(to_bezier(ModelSurface{"", round_sheet(), Affine::scaled({1e-200, 1e-200, 1e-200})}, fit).ok());
  const auto speck = value_of(
      BezierPatch::polynomial(1, 1, std::vector<Vec3>{{0, 0, 0}, {0, 1e-300, 0}, {1e-300, 0, 0}, {1e-300, 1e-300, 0}}));
  const PatchGrid grid =
      value_of(to_bezier(ModelSurface{"", speck, Affine{{Vec3{1.7e308, 0, 0}, Vec3{1.7e308, 0, 0}}}}));
  EXPECT_EQ(grid.fit_error().distance, 0);
}

TEST(Model, MapsKeepSharedBordersAndPoles) {
  const BSplineSurface sphere = value_of(make_nurbs_sphere({}, 1));
  const PatchGrid grid = value_of(transform(value_of(to_bezier(sphere)), askew()));
  for (std::size_t a = 1; a < grid.count_u(); ++a)
    for (std::size_t b = 0; b < grid.count_v(); ++b)
      for (int j = 0; j <= 2; ++j) EXPECT_EQ(grid.patch(a - 1, b).point(2, j), grid.patch(a, b).point(0, j));
  for (std::size_t a = 0; a < grid.count_u(); ++a) EXPECT_TRUE(grid.patch(a, 0).collapsed_sides().has(Side::v0));
}

TEST(Model, ErrorsNameTheSurface) {
  Model model{"", {{"floor", unit_square()}, {"rim", unit_square()}}};
  model.surfaces[1].placement = Affine::translated({0, not_a_number, 0});
  expect_refused(make_patch_set(model), StatusCode::non_finite, 1, "surface 1 (rim): an affine map must be finite");
  model.surfaces[1].placement = Affine::scaled({1e200, 1e200, 1e200});
  expect_refused(make_patch_set(model), StatusCode::non_finite, 0,
                 "surface 0 (floor): patch 0: ");  // far from the origin
  model.surfaces[1].placement = Affine::scaled({1e308, 1e308, 1e308}) * Affine::scaled({10, 10, 10});
  expect_refused(make_patch_set(model), StatusCode::non_finite, 1, "surface 1 (rim): ");
  expect_refused(make_patch_set(Model{}), StatusCode::invalid_argument, Status::no_index, "at least one patch");
}

TEST(Model, PointsPlacedBeyondTheRangeOfNumbersAreRefused) {
  const ModelSurface surface{"", unit_square(), Affine::translated({1.5e308, 0, 0}) * Affine::scaled({1e308, 1, 1})};
  EXPECT_EQ(value_of(evaluate_jet(surface, 0, 0.5)).position, (Vec3{1.5e308, 0.5, 0}));
  expect_refused(evaluate_jet(surface, 1, 0.5), StatusCode::non_finite, Status::no_index,
                 "the surface's point at (1, 0.5) is (inf, 0.5, 0) after its placement");
}

/// The pieces of a rational surface stay rational even if all weights of a piece are equal.
TEST(Model, EditsKeepWeightsThatAreAllEqual) {
  Random random(23);
  std::vector<double> weights(5 * 2, 1);
  weights[9] = 2;
  const std::vector<double> knots{0, 0, 0, 1, 1, 2, 2, 2}, linear{0, 0, 1, 1};
  const auto surface = value_of(BSplineSurface::rational(2, knots, 1, linear, random_cloud(random, 10), weights));
  PatchSet set = value_of(make_patch_set(Model{"", {{"", surface}}}));
  ASSERT_EQ(set.patch_count(), 2u);
  ASSERT_TRUE(set.patch(0).is_rational());
  ASSERT_TRUE(set.set_control_points(0, random_cloud(random, 6)).ok());
  EXPECT_TRUE(set.patch(0).is_rational());
}

TEST(Model, ExtentsAreTheBoxesOfThePatches) {
  Model model;
  for (const Affine& placement : {Affine{}, Affine::translated({3, 0, 1})})
    for (const Surface& surface : exact_surfaces()) model.surfaces.push_back({"", surface, placement});
  model.surfaces.push_back(model.surfaces[0]);  // cut, but every point of its net counts
  model.surfaces.back().trims = std::vector<TrimLoop>{
      {.curves = {line_over({0.2, 0.2, 0}, {0.6, 0.2, 0}), line_over({0.6, 0.2, 0}, {0.6, 0.6, 0}),
                  line_over({0.6, 0.6, 0}, {0.2, 0.2, 0})}}};
  const SurfaceExtents extents = value_of(surface_extents(model));
  ASSERT_EQ(extents.boxes.size(), model.surfaces.size());
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    const Box3 box = value_of(to_bezier(model.surfaces[k])).box();
    EXPECT_EQ(extents.boxes[k].lower, box.lower) << k;
    EXPECT_EQ(extents.boxes[k].upper, box.upper) << k;
  }
  EXPECT_EQ(extents.fit_error.distance, 0);
  EXPECT_TRUE(extents.fit_error.certified);
}

}}  // namespace tessera::test
