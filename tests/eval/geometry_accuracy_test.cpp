// Second derivatives, forms, curvatures and directions of every ISA against the long double reference, for every
// degree, wide weights, sizes and places, in the units of evaluate.h; and at any scale. Each test prints its table.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "eval/accuracy_cases.h"
#include "eval/error_units.h"
#include "eval/steep_patches.h"
#include "support/grids.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// Sizes by which the bounds of evaluate.h are stated, at one point of a patch about the set's origin.
struct Sizes {
  double degree, derivative, second;  ///< the higher degree; the unit of first and of second derivatives
  double largest_second, height;      ///< D and h
  double second_form;                 ///< the error of the second form that counts as 1

  Sizes(const BezierPatch& patch, double u, double v, const RealJet& jet, double unit) {
    const ErrorUnits units(patch, u, v, unit);
    degree = units.degree;
    derivative = units.first();
    second = units.second();
    const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
    largest_second = std::max({length(jet.duu.rounded()), length(jet.duv.rounded()), length(jet.dvv.rounded())});
    height = length(cross(du, dv)) / std::max(length(du), length(dv));
    second_form =
        (patch.is_rational() ? 3 : 1) * degree * degree * second + degree * derivative * largest_second / height;
  }
  /// The error of a principal curvature that counts as 1.
  double curvature() const { return second_form / (height * height); }
};

/// Largest errors over a set, each divided by the bound of evaluate.h.
struct GeometryErrors {
  double second = 0, first_form = 0, second_form = 0, curvature = 0, gaussian = 0, direction = 0;
  int undefined = 0;

  void grow(const GeometryErrors& other) {
    for (double GeometryErrors::*const e :
         {&GeometryErrors::second, &GeometryErrors::first_form, &GeometryErrors::second_form,
          &GeometryErrors::curvature, &GeometryErrors::gaussian, &GeometryErrors::direction})
      this->*e = std::max(this->*e, other.*e);
    undefined += other.undefined;
  }
};

template <class T>
Vec3 scalars(const View1<T>& a, const View1<T>& b, const View1<T>& c, std::size_t record) {
  return {a.at(record, 0), b.at(record, 0), c.at(record, 0)};
}

template <class T>
void add_curvature_errors(const QuantityViews<T>& out, std::size_t record, const RealGeometry& g, const Sizes& sizes,
                          double unit, GeometryErrors& errors) {
  const double k1 = static_cast<double>(g.first), k2 = static_cast<double>(g.second), bound = sizes.curvature();
  const auto grow = [](double& largest, double error) {
    largest = std::max(largest, std::isfinite(error) ? error : 1e300);
  };
  grow(errors.curvature, error_in_units(scalars(out.mean, out.first_curvature, out.second_curvature, record),
                                        {static_cast<double>(g.mean), k1, k2}, bound));
  const double product = (std::abs(k1) + std::abs(k2)) * bound + 8 * bound * bound;
  grow(errors.gaussian,
       std::abs(static_cast<double>(out.gaussian.at(record, 0)) - static_cast<double>(g.gaussian)) / product);
  const double turn = 2 * bound / (k1 - k2) + sizes.degree * sizes.derivative / sizes.height + unit;
  if (8 * turn > 0.25) return;  // an umbilic within errors
  for (const auto& [view, expected] :
       {std::pair{&out.first_direction, g.first_direction}, {&out.second_direction, g.second_direction}}) {
    const Vec3 direction = read(*view, record), reference = expected.rounded();
    const double sign = dot(direction, reference) < 0 ? -1 : 1;
    grow(errors.direction, error_in_units(sign * direction, reference, turn));
  }
}

template <class T>
GeometryErrors geometry_errors_of(const PatchSet& set, const GridPlan& plan, const std::vector<double>& u,
                                  const std::vector<double>& v) {
  AllBuffers<T> memory(plan);
  const QuantityViews<T> out = memory.views();
  EXPECT_TRUE(evaluate(set, plan, out).ok());
  const double unit = sizeof(T) == 4 ? float_unit : double_unit;
  GeometryErrors errors;
  for (std::size_t record = 0; record < plan.capacity(); ++record) {
    const std::size_t k = record / (u.size() * v.size()), i = record / v.size() % u.size(), j = record % v.size();
    const BezierPatch patch = relative_to(set.patch(k), set.origin());
    const RealJet jet = reference_jet(patch, u[i], v[j]);
    const RealGeometry g = reference_geometry(jet);
    const Sizes sizes(patch, u[i], v[j], jet, unit);
    const double square = sizes.degree * sizes.degree;
    for (const auto& [view, expected] : {std::pair{&out.duu, jet.duu}, {&out.duv, jet.duv}, {&out.dvv, jet.dvv}})
      errors.second =
          std::max(errors.second, error_in_units(read(*view, record), expected.rounded(), square * sizes.second));
    if (out.curvature_kind.at(record, 0) == CurvatureKind::undefined) {
      // Only where the tangents are parallel within their own errors.
      EXPECT_LT(sizes.height, 1000 * sizes.degree * sizes.derivative);
      ++errors.undefined;
      continue;
    }
    EXPECT_EQ(out.normal_kind.at(record, 0), NormalKind::regular);
    const double longest =
        std::sqrt(std::max(static_cast<double>(g.first_form.x), static_cast<double>(g.first_form.z)));
    errors.first_form = std::max(errors.first_form, error_in_units(read(out.first_form, record), g.first_form.rounded(),
                                                                   sizes.degree * sizes.derivative * longest));
    errors.second_form = std::max(
        errors.second_form, error_in_units(read(out.second_form, record), g.second_form.rounded(), sizes.second_form));
    // Where errors are as large as the tangents, bounds of first order say nothing.
    if (16 * sizes.degree * sizes.derivative < 0.01 * sizes.height)
      add_curvature_errors(out, record, g, sizes, unit, errors);
  }
  return errors;
}

class GeometryAccuracy : public ::testing::TestWithParam<Isa> {};

template <class T>
void check_geometry_bounds(Isa isa) {
  Random random(91);
  PatchSetOptions options;
  options.blocks = {true, true, false, false};
  const std::vector<double> u = {0, 1, 0.5, 0.1, 1.0 / 3, 0.999, 1e-6}, v = {1, 0.25, 0.77, 0, 2.0 / 3};
  std::printf("%s, %s: largest errors by degree, in units (bounds: 16, 32, 8, 8, 8, 8)\n",
              std::string(name(isa)).c_str(), sizeof(T) == 4 ? "float" : "double");
  std::puts("degree  second derivatives  first form  second form  curvatures  Gaussian  directions");
  for (int degree = 1; degree <= max_degree; ++degree) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    GeometryErrors errors;
    for (const Circumstance& where : circumstances) {
      const PatchSet set = set_of(patches_of_degree(random, degree, 8, where), options);
      const GridPlan plan = value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>, .isa = isa}));
      errors.grow(geometry_errors_of<T>(set, plan, u, v));
    }
    std::printf("%6d  %18.2f  %10.2f  %11.2f  %10.2f  %8.2f  %10.2f\n", degree, errors.second, errors.first_form,
                errors.second_form, errors.curvature, errors.gaussian, errors.direction);
    EXPECT_LE(errors.second, 16);
    EXPECT_LE(errors.first_form, 32);
    EXPECT_LE(errors.second_form, 8);
    EXPECT_LE(errors.curvature, 8);
    EXPECT_LE(errors.gaussian, 8);
    EXPECT_LE(errors.direction, 8);
    EXPECT_LE(errors.undefined, sizeof(T) == 4 ? 60 : 7);  // of 2,240 points
  }
}

TEST_P(GeometryAccuracy, Float) { check_geometry_bounds<float>(GetParam()); }
TEST_P(GeometryAccuracy, Double) { check_geometry_bounds<double>(GetParam()); }

/// The bounds hold where weights fall off steeply.
template <class T>
void check_steep_geometry(Isa isa) {
  Random random(94);
  PatchSetOptions options;
  options.origin = Vec3{};
  options.blocks = {true, true, false, false};
  const std::vector<double> u = {0, 1, 0.5, 1.0 / 3, 1e-3, 1e-6, 0.999999}, v = {1, 0.77, 0, 0.5, 0.999, 1e-6};
  std::printf("%s, %s, steep weights: largest errors by degree, in units (bounds: 48, 32, 8, 8, 8, 8)\n",
              std::string(name(isa)).c_str(), sizeof(T) == 4 ? "float" : "double");
  std::puts("degree  second derivatives  first form  second form  curvatures  Gaussian  directions");
  for (const int degree : {1, 2, 3, 4, 5, 8, max_degree}) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const PatchSet set = set_of(steep_patches(random, degree), options);
    const GridPlan plan = value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>, .isa = isa}));
    const GeometryErrors errors = geometry_errors_of<T>(set, plan, u, v);
    std::printf("%6d  %18.2f  %10.2f  %11.2f  %10.2f  %8.2f  %10.2f\n", degree, errors.second, errors.first_form,
                errors.second_form, errors.curvature, errors.gaussian, errors.direction);
    EXPECT_LE(errors.second, 48);
    EXPECT_LE(errors.first_form, 32);
    EXPECT_LE(errors.second_form, 8);
    EXPECT_LE(errors.curvature, 8);
    EXPECT_LE(errors.gaussian, 8);
    EXPECT_LE(errors.direction, 8);
  }
}
TEST_P(GeometryAccuracy, FloatWithSteepWeights) { check_steep_geometry<float>(GetParam()); }
TEST_P(GeometryAccuracy, DoubleWithSteepWeights) { check_steep_geometry<double>(GetParam()); }

/// The power basis of a cubic gives the same geometry, with larger errors.
TEST_P(GeometryAccuracy, PowerBasis) {
  Random random(92);
  PatchSetOptions options;
  options.blocks = {true, true, true, true};
  const PatchSet set = set_of(patches_of_degree(random, 3, 20, circumstances[0]), options);
  const auto t = uniform_parameters(6);
  const GridPlan bernstein =
      value_of(GridPlan::make(set, t, t, {Precision::double_precision, Representation::bernstein, GetParam()}));
  const GridPlan power =
      value_of(GridPlan::make(set, t, t, {Precision::double_precision, Representation::power, GetParam()}));
  AllBuffers<double> expected(bernstein), found(power);
  ASSERT_TRUE(evaluate(set, bernstein, expected.views()).ok());
  ASSERT_TRUE(evaluate(set, power, found.views()).ok());
  EXPECT_EQ(found.normal_kind, expected.normal_kind);
  const QuantityViews<double> a = expected.views(), b = found.views();
  for (std::size_t k = 0; k < power.capacity(); ++k) {
    const Vec3 du = read(a.du, k), dv = read(a.dv, k);
    if (length(cross(du, dv)) < 0.1 * std::max(length(du), length(dv))) continue;
    EXPECT_LT(max_abs(read(a.duv, k) - read(b.duv, k)), 1e-10);
    EXPECT_NEAR(a.gaussian.at(k, 0), b.gaussian.at(k, 0), 1e-8 * (1 + std::abs(a.gaussian.at(k, 0))));
  }
}

/// Curvatures are proportional to the inverse of the size. Out of range they are zero and flagged, never NaN.
TEST_P(GeometryAccuracy, AtAnyScale) {
  Random random(93);
  const auto t = uniform_parameters(4);
  const std::vector<Vec3> points = random_points(random, 3, 3);
  const BezierPatch unscaled = polynomial(3, 3, points);
  for (const int exponent : {-100, -55, -40, 0, 40, 60, 63, 80, 100}) {
    SCOPED_TRACE(exponent);
    const double scale = std::ldexp(1.0, exponent);
    std::vector<Vec3> scaled = points;
    for (Vec3& p : scaled) p = scale * p;
    const PatchSet set = set_of({polynomial(3, 3, scaled), unscaled}, {.origin = Vec3{}});
    const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
    AllBuffers<float> memory(plan);
    const QuantityViews<float> out = memory.views();
    ASSERT_TRUE(evaluate(set, plan, out).ok());
    for (const auto& values : memory.values)
      for (const float x : values) ASSERT_EQ(x, x);
    for (std::size_t k = 0; k < 16; ++k) {
      const RealGeometry g = reference_geometry(reference_jet(unscaled, t[k / 4], t[k % 4]));
      const double bend = std::abs(static_cast<double>(g.first)) + std::abs(static_cast<double>(g.second));
      EXPECT_TRUE(within_units(read(out.normal, k), g.normal.rounded(), 1e-4, 1));
      if (out.curvature_kind.at(k, 0) == CurvatureKind::undefined) {
        EXPECT_TRUE(exponent < -50 || exponent > 60);
        EXPECT_EQ(out.mean.at(k, 0), 0);
        EXPECT_EQ(read(out.first_direction, k), Vec3{});
        EXPECT_EQ(read(out.first_form, k), Vec3{});
        continue;
      }
      EXPECT_LT(exponent, 64);
      EXPECT_NEAR(out.mean.at(k, 0) * scale, static_cast<double>(g.mean), 1e-3 * bend);
      EXPECT_NEAR(out.first_curvature.at(k, 0) * scale, static_cast<double>(g.first), 1e-3 * bend);
      EXPECT_NEAR(out.second_curvature.at(k, 0) * scale, static_cast<double>(g.second), 1e-3 * bend);
    }
    // The neighbour of usual size has the bits that it has alone.
    const PatchSet alone = set_of({unscaled}, {.origin = Vec3{}});
    const GridPlan other = value_of(GridPlan::make(alone, t, t, {.isa = GetParam()}));
    AllBuffers<float> bits(other);
    ASSERT_TRUE(evaluate(alone, other, bits.views()).ok());
    for (std::size_t k = 0; k < bits.values.size(); ++k)
      EXPECT_TRUE(std::equal(bits.values[k].begin(), bits.values[k].end(),
                             memory.values[k].begin() + static_cast<std::ptrdiff_t>(bits.values[k].size())));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryIsa, GeometryAccuracy,
                         ::testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& param) { return std::string(name(param.param)); });

}}  // namespace tessera::test
