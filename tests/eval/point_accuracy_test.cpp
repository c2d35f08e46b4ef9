// Scattered points of every ISA against the long double reference, for every degree, in the units of evaluate.h.

#include <gtest/gtest.h>

#include <cmath>

#include "support/points.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test {
namespace {

/// Largest errors, each in the unit of its bound.
struct Errors {
  double polynomial = 0, rational = 0, derivative = 0, second = 0, normal = 0;
};

/// Units of derivatives at one point: see evaluate.h.
struct Units {
  double position, first, second;

  Units(const BezierPatch& patch, const Vec3& origin, double u, double v, double epsilon) {
    position = first = second = epsilon * largest_coefficient(patch, origin);
    if (!patch.is_rational()) return;
    double product = 0, heaviest = 0;
    for (std::size_t k = 0; k < patch.points().size(); ++k) {
      product = std::max(product, patch.weights()[k] * max_abs(patch.points()[k] - origin));
      heaviest = std::max(heaviest, patch.weights()[k]);
    }
    Real weight;
    reference_sum(patch, u, v, 0, 0, weight);
    first = epsilon * product / static_cast<double>(weight);
    second = first * heaviest / static_cast<double>(weight);
  }
};

template <class T>
Errors errors_of(const PatchSet& set, const Samples<T>& samples, Isa isa) {
  AllBuffers<T> memory = all_outputs(set, samples, {.isa = isa});
  const GridViews<T> out = memory.views();
  const double epsilon = sizeof(T) == 4 ? float_unit : double_unit;
  const Vec3 origin = sizeof(T) == 4 ? set.origin() : Vec3{};
  Errors errors;
  const auto grow = [](double& largest, double error) { largest = std::max(largest, error); };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const BezierPatch& patch = set.patch(samples.patch[k]);
    const double u = samples.u[k], v = samples.v[k], degree = std::max(patch.degree_u(), patch.degree_v());
    const RealJet jet = reference_jet(patch, u, v);
    const Units units(patch, set.origin(), u, v, epsilon);
    const RealVec3 relative = jet.position - RealVec3{origin.x, origin.y, origin.z};
    grow(patch.is_rational() ? errors.rational : errors.polynomial,
         error_in_units(read(out.position, k), relative.rounded(), units.position));
    for (const auto& [view, expected] : {std::pair{&out.du, jet.du}, {&out.dv, jet.dv}})
      grow(errors.derivative, error_in_units(read(*view, k), expected.rounded(), degree * units.first));
    for (const auto& [view, expected] : {std::pair{&out.duu, jet.duu}, {&out.duv, jet.duv}, {&out.dvv, jet.dvv}})
      grow(errors.second, error_in_units(read(*view, k), expected.rounded(), degree * degree * units.second));
    const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
    const double height = length(cross(du, dv)) / std::max(length(du), length(dv));
    grow(errors.normal,
         error_in_units(read(out.normal, k), reference_normal(patch, u, v), degree * units.first / height));
  }
  return errors;
}

class PointAccuracy : public ::testing::TestWithParam<Isa> {};

template <class T>
void check_bounds(Isa isa) {
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

TEST_P(PointAccuracy, Float) { check_bounds<float>(GetParam()); }
TEST_P(PointAccuracy, Double) { check_bounds<double>(GetParam()); }

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

/// Where weights are exact, points and grids are the same bits, in every output.
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
  for_each_value_output<T>([&](const auto& output) {
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

}  // namespace
}  // namespace tessera::test
