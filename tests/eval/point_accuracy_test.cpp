// Scattered points of every ISA against the long double reference, for every degree, in the units of evaluate.h.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "eval/accuracy_cases.h"
#include "eval/error_units.h"
#include "eval/steep_patches.h"
#include "support/points.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// Largest errors, each in the unit of its bound.
struct Errors {
  double polynomial = 0, rational = 0, derivative = 0, second = 0, normal = 0;
};

template <class T>
Errors errors_of(const PatchSet& set, const Samples<T>& samples, Isa isa) {
  AllBuffers<T> memory = all_outputs(set, samples, {.isa = isa});
  const QuantityViews<T> out = memory.views();
  const double epsilon = sizeof(T) == 4 ? float_unit : double_unit;
  const Vec3 origin = sizeof(T) == 4 ? set.origin() : Vec3{};
  Errors errors;
  const auto grow = [](double& largest, double error) { largest = std::max(largest, error); };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const BezierPatch& patch = set.patch(samples.patch[k]);
    const double u = samples.u[k], v = samples.v[k];
    const RealJet jet = reference_jet(patch, u, v);
    const ErrorUnits units(relative_to(patch, set.origin()), u, v, epsilon);
    const double first = units.degree * units.first(), second = units.degree * units.degree * units.second();
    const RealVec3 relative = jet.position - RealVec3{origin.x, origin.y, origin.z};
    grow(patch.is_rational() ? errors.rational : errors.polynomial,
         error_in_units(read(out.position, k), relative.rounded(), units.position));
    for (const auto& [view, expected] : {std::pair{&out.du, jet.du}, {&out.dv, jet.dv}})
      grow(errors.derivative, error_in_units(read(*view, k), expected.rounded(), first));
    for (const auto& [view, expected] : {std::pair{&out.duu, jet.duu}, {&out.duv, jet.duv}, {&out.dvv, jet.dvv}})
      grow(errors.second, error_in_units(read(*view, k), expected.rounded(), second));
    const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
    const double height = length(cross(du, dv)) / std::max(length(du), length(dv));
    // To first order in errors over the height.
    if (8 * first < 0.05 * height)
      grow(errors.normal, error_in_units(read(out.normal, k), reference_normal(patch, u, v), first / height));
  }
  return errors;
}

class PointAccuracy : public ::testing::TestWithParam<Isa> {};

template <class T>
void check_point_bounds(Isa isa) {
  Random random(301);
  for (int degree = 1; degree <= max_degree; ++degree) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    std::vector<BezierPatch> patches;
    for (int k = 0; k < 24; ++k) {
      const int other = 1 + static_cast<int>(random() % static_cast<unsigned>(degree));
      const int m = k % 3 ? degree : other, n = k % 3 == 1 ? other : degree;
      patches.push_back(k % 4 < 2 ? random_polynomial(random, m, n) : random_rational(random, m, n));
    }
    const Errors errors =
        errors_of<T>(set_of(patches, with_points()), random_samples<T>(random, patches.size(), 700), isa);
    const bool fused = isa != Isa::sse2;
    EXPECT_LE(errors.polynomial, fused ? 2 : 2 + degree / 2.0);
    EXPECT_LE(errors.rational, fused ? 4 : 4 + degree);
    EXPECT_LE(errors.derivative, 16);
    EXPECT_LE(errors.second, 16);
    EXPECT_LE(errors.normal, 8);
  }
}

TEST_P(PointAccuracy, Float) { check_point_bounds<float>(GetParam()); }
TEST_P(PointAccuracy, Double) { check_point_bounds<double>(GetParam()); }

/// A model of size 10 a million away, weights from 1e-3 to 1e3, sizes from 1e-6 to 1e6.
TEST_P(PointAccuracy, FarAwayUnevenAndOfAnySize) {
  Random random(302);
  for (const double size : {1e-6, 1.0, 1e6}) {
    const Vec3 far = size * Vec3{1e6, -2e6, 3e6};
    std::vector<BezierPatch> polynomials, rationals;
    for (int k = 0; k < 30; ++k) {
      polynomials.push_back(random_polynomial(random, 3, 3, far, 5 * size));
      rationals.push_back(random_rational(random, 3, 2, 1e-3, 1e3, far, 5 * size));
    }
    const bool fused = GetParam() != Isa::sse2;
    const auto samples = random_samples<float>(random, 30, 1000);
    EXPECT_LE(errors_of(set_of(polynomials, with_points()), samples, GetParam()).polynomial, fused ? 2 : 3.5);
    const Errors errors = errors_of(set_of(rationals, with_points()), samples, GetParam());
    EXPECT_LE(errors.derivative, 16);
  }
}

/// One parameter in four is an end, one in four lies inside, the others come close to an end.
template <class T>
Samples<T> samples_near_borders(Random& random, std::size_t patch_count, std::size_t count) {
  const auto parameter = [&] {
    const double near = std::pow(10, uniform(random, -8, 0));
    const double choices[] = {0, 1, uniform(random, 0, 1), 0.5, near, near, 1 - near, 1 - near};
    return static_cast<T>(choices[random() % 8]);
  };
  Samples<T> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const T u = parameter(), v = parameter();
    samples.add(random() % patch_count, u, v);
  }
  return samples;
}

/// The bounds hold where weights fall off steeply.
template <class T>
void check_steep_points(Isa isa) {
  Random random(304);
  PatchSetOptions options = with_points();
  options.origin = Vec3{};
  std::printf("%s, %s, steep weights: largest errors by degree, in units (bounds: 4 + degree / 4, 16, 48, 8)\n",
              std::string(name(isa)).c_str(), sizeof(T) == 4 ? "float" : "double");
  std::puts("degree  positions  derivatives  second  normals");
  for (const int degree : {1, 2, 3, 4, 5, 8, max_degree}) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const std::vector<BezierPatch> patches = steep_patches(random, degree);
    const auto samples = samples_near_borders<T>(random, patches.size(), 3000);
    const Errors errors = errors_of<T>(set_of(patches, options), samples, isa);
    std::printf("%6d  %9.2f  %11.2f  %6.2f  %7.2f\n", degree, errors.rational, errors.derivative, errors.second,
                errors.normal);
    EXPECT_LE(errors.rational, isa != Isa::sse2 ? 4 + degree / 4.0 : 4 + degree);
    EXPECT_LE(errors.derivative, 16);
    EXPECT_LE(errors.second, 48);
    EXPECT_LE(errors.normal, 8);
  }
}
TEST_P(PointAccuracy, FloatWithSteepWeights) { check_steep_points<float>(GetParam()); }
TEST_P(PointAccuracy, DoubleWithSteepWeights) { check_steep_points<double>(GetParam()); }

/// If weights are exact, points and grids have the same bits in every output.
template <class T>
void compare_with_grid(Isa isa, int degree, const std::vector<double>& t) {
  Random random(303);
  const PatchSet set = set_of(mixed_patches(random, degree), with_points());
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.precision = precision_of<T>, .isa = isa}));
  AllBuffers<T> grid(plan);
  ASSERT_TRUE(evaluate(set, plan, grid.views()).ok());
  Samples<T> samples;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (const double u : t)
      for (const double v : t) samples.add(k, static_cast<T>(u), static_cast<T>(v));
  const AllBuffers<T> points = all_outputs(set, samples, {.isa = isa});
  EXPECT_EQ(points.normal_kind, grid.normal_kind);
  EXPECT_EQ(points.curvature_kind, grid.curvature_kind);
  std::size_t k = 0;
  for_each_value_quantity([&](const auto& output) {
    EXPECT_TRUE(points.values[k] == grid.values[k]) << output.name;
    ++k;
  });
}
TEST_P(PointAccuracy, TheBitsOfGridsWhereWeightsAreExact) {
  compare_with_grid<float>(GetParam(), 4, {0, 0.25, 0.5, 0.75, 1});
  compare_with_grid<double>(GetParam(), 5, {0, 0.25, 0.5, 0.75, 1});
  compare_with_grid<double>(GetParam(), 9, {0, 0.5, 1});
}

INSTANTIATE_TEST_SUITE_P(EveryIsa, PointAccuracy, ::testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& param) { return std::string(name(param.param)); });

}}  // namespace tessera::test
