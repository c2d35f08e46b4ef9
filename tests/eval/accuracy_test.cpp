// Every ISA against the long double reference, for every degree, both bases, wide weights, sizes and places, in the
// units of evaluate.h. Each test prints its table.

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

/// Largest errors over a set in the units of evaluate.h: so that their bounds are 2, 4, 16, 16 and 8.
struct PositionErrors {
  double polynomial = 0, rational = 0;             // positions
  double derivative = 0, rational_derivative = 0;  // over the degree
  double normal = 0;  // times the sine of the tangents' angle and the shorter tangent, over the largest coefficient
  double plain = 0;   // of polynomial positions, the largest |coefficient| times the unit being 1

  void grow(const PositionErrors& other) {
    for (double PositionErrors::*const e :
         {&PositionErrors::polynomial, &PositionErrors::rational, &PositionErrors::derivative,
          &PositionErrors::rational_derivative, &PositionErrors::normal, &PositionErrors::plain})
      this->*e = std::max(this->*e, other.*e);
  }
};

/// The units of errors at one point of a patch about the set's origin.
struct Units {
  double position, derivative;  ///< one unit
  double denominator = 0;       ///< the weight's own relative error, which counts in the power basis

  Units(const BezierPatch& patch, double u, double v, double epsilon, Representation representation) {
    const ErrorUnits units(patch, u, v, epsilon);
    position = units.position;
    derivative = units.first();
    if (representation == Representation::bernstein) return;
    // The power coefficients sum_k C(m,i) C(i,k) (-1)^(i-k) V_k are up to C(m,i) 2^i times as large.
    const double growth = std::pow(1 + 2 * u, patch.degree_u()) * std::pow(1 + 2 * v, patch.degree_v());
    position *= growth * units.weight_ratio;
    derivative *= growth * units.weight_ratio;
    if (patch.is_rational()) denominator = epsilon * growth * units.weight_ratio;
  }
};

/// The error of a vector in units of `unit`, less the error of rounding `absolute` to double.
double error_of(const Vec3& value, const Vec3& expected, double unit, double absolute = 0) {
  return std::max(0.0, error_in_units(value, expected, unit) - 0x1p-53 * absolute / unit);
}

template <class T>
void add_errors(const BezierPatch& patch, const GridBuffers<T>& out, std::size_t record, double u, double v,
                const Vec3& shift, Representation representation, PositionErrors& errors) {
  const double epsilon = sizeof(T) == 4 ? float_unit : double_unit;
  const double degree = std::max(patch.degree_u(), patch.degree_v());
  const Units units(patch, u, v, epsilon, representation);
  if (units.denominator > 0.01) return;  // the denominator may be anything
  const RealJet jet = reference_jet(patch, u, v);
  const Vec3 position = vector_at(out.position, record);
  PositionErrors here;
  (patch.is_rational() ? here.rational : here.polynomial) =
      error_of(position - shift, jet.position.rounded(), units.position, max_abs(shift) > 0 ? max_abs(position) : 0);
  if (!patch.is_rational()) here.plain = here.polynomial * units.position / (epsilon * largest_coefficient(patch));
  double& derivative = patch.is_rational() ? here.rational_derivative : here.derivative;
  for (const auto& [values, expected] : {std::pair{&out.du, jet.du}, {&out.dv, jet.dv}})
    derivative =
        std::max(derivative, error_of(vector_at(*values, record), expected.rounded(), units.derivative) / degree);
  const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
  const double height = length(cross(du, dv)) / std::max(length(du), length(dv));
  // First-order bound of errors over the height; if they are as large, any direction may result.
  if (8 * degree * units.derivative < 0.05 * height)
    here.normal = error_in_units(vector_at(out.normal, record), normalized(cross(jet.du, jet.dv)).rounded(),
                                 degree * units.derivative / height);
  errors.grow(here);
}

template <class T>
PositionErrors position_errors_of(const PatchSet& set, const GridPlan& plan, const std::vector<double>& u,
                                  const std::vector<double>& v,
                                  Representation representation = Representation::bernstein) {
  GridBuffers<T> out(plan);
  const Status status = evaluate(set, plan, out.views());
  EXPECT_TRUE(status.ok()) << status.message();
  PositionErrors errors;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch patch = relative_to(set.patch(k), set.origin());
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j)
        add_errors(patch, out, (k * u.size() + i) * v.size() + j, u[i], v[j], sizeof(T) == 4 ? Vec3{} : set.origin(),
                   representation, errors);
  }
  return errors;
}

class Accuracy : public ::testing::TestWithParam<Isa> {};

/// Every degree of a basis under every condition, against the bounds of evaluate.h. The units of the power basis
/// include its growth.
template <class T>
void check_position_bounds(Isa isa, Representation representation) {
  Random random(11);
  PatchSetOptions options;
  options.blocks = {true, true, true, true};
  // Odd and clustered parameters, and the ends.
  const std::vector<double> u = {0, 1, 0.5, 0.1, 1.0 / 3, 0.999, 1e-6}, v = {1, 0.25, 0.77, 0, 2.0 / 3};
  const bool bernstein = representation == Representation::bernstein;
  std::printf("%s, %s, %s: largest errors by degree, in units (bounds: 2, 4, 16, 16, 8)\n",
              std::string(name(isa)).c_str(), sizeof(T) == 4 ? "float" : "double",
              bernstein ? "Bernstein" : "power, over its growth");
  std::printf("degree  positions  rational  derivatives  rational  normals%s\n",
              bernstein ? "" : "  positions as they are");
  for (int degree = 1; degree <= max_degree; ++degree) {
    PositionErrors errors;
    for (const Circumstance& where : circumstances) {
      const PatchSet set = set_of(patches_of_degree(random, degree, 8, where), options);
      const GridPlan plan = value_of(GridPlan::make(set, u, v, {precision_of<T>, representation, isa}));
      errors.grow(position_errors_of<T>(set, plan, u, v, representation));
    }
    std::printf("%6d  %9.2f  %8.2f  %11.2f  %8.2f  %7.2f", degree, errors.polynomial, errors.rational,
                errors.derivative, errors.rational_derivative, errors.normal);
    if (!bernstein) std::printf("  %21.3g", errors.plain);
    std::printf("\n");
    EXPECT_LE(errors.polynomial, 2) << "degree " << degree;
    EXPECT_LE(errors.rational, 4) << "degree " << degree;
    EXPECT_LE(errors.derivative, 16) << "degree " << degree;
    EXPECT_LE(errors.rational_derivative, 16) << "degree " << degree;
    EXPECT_LE(errors.normal, 8) << "degree " << degree;
  }
}

TEST_P(Accuracy, FloatBernstein) { check_position_bounds<float>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, DoubleBernstein) { check_position_bounds<double>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, FloatPower) { check_position_bounds<float>(GetParam(), Representation::power); }
TEST_P(Accuracy, DoublePower) { check_position_bounds<double>(GetParam(), Representation::power); }

/// The bounds hold where weights fall off steeply.
template <class T>
void check_steep_positions(Isa isa, Representation representation) {
  Random random(15);
  PatchSetOptions options;
  options.origin = Vec3{};
  options.blocks = {true, true, true, true};
  const std::vector<double> u = {0, 1, 0.5, 1.0 / 3, 1e-3, 1e-6, 0.999999}, v = {1, 0.77, 0, 0.5, 0.999, 1e-6};
  std::printf("%s, %s, %s, steep weights: largest errors by degree, in units (bounds: 4 + degree / 4, 16, 8)\n",
              std::string(name(isa)).c_str(), sizeof(T) == 4 ? "float" : "double",
              representation == Representation::bernstein ? "Bernstein" : "power, over its growth");
  std::puts("degree  positions  derivatives  normals");
  for (const int degree : {1, 2, 3, 4, 5, 8, max_degree}) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const PatchSet set = set_of(steep_patches(random, degree), options);
    const GridPlan plan = value_of(GridPlan::make(set, u, v, {precision_of<T>, representation, isa}));
    const PositionErrors errors = position_errors_of<T>(set, plan, u, v, representation);
    std::printf("%6d  %9.2f  %11.2f  %7.2f\n", degree, errors.rational, errors.rational_derivative, errors.normal);
    EXPECT_LE(errors.rational, 4 + degree / 4.0);
    EXPECT_LE(errors.rational_derivative, 16);
    EXPECT_LE(errors.normal, 8);
  }
}
TEST_P(Accuracy, FloatWithSteepWeights) { check_steep_positions<float>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, DoubleWithSteepWeights) { check_steep_positions<double>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, FloatPowerWithSteepWeights) { check_steep_positions<float>(GetParam(), Representation::power); }
TEST_P(Accuracy, DoublePowerWithSteepWeights) { check_steep_positions<double>(GetParam(), Representation::power); }

/// Normals are right where steep weights leave only the errors of a tangent: there they are exact.
TEST_P(Accuracy, NormalsWhereATangentIsLost) {
  Random random(16);
  const double u = 0.3;
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 64; ++k) patches.push_back(with_lost_derivative(random, 1 + k % 5, u, 1e8));
  const PatchSet set = set_of(patches, {.blocks = {true, false, true, false, true, false}, .origin = Vec3{}});
  for (const Representation representation : {Representation::bernstein, Representation::power}) {
    const GridPlan plan = value_of(GridPlan::make(set, std::vector{u}, std::vector{0.0},
                                                  {Precision::single_precision, representation, GetParam()}));
    GridBuffers<float> out(plan);
    ASSERT_TRUE(evaluate(set, plan, out.views()).ok());
    double largest = 0, lost = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const RealJet jet = reference_jet(patches[k], u, 0);
      const Vec3 dv = jet.dv.rounded();
      lost = std::max(lost, max_abs(vector_at(out.dv, k) - dv) / max_abs(dv));
      largest = std::max(largest, max_abs(vector_at(out.normal, k) - reference_normal(patches[k], u, 0)));
    }
    EXPECT_GT(lost, 1);
    EXPECT_LT(largest, 1e-6);
  }
}

/// A model of size 10 a million away keeps float's precision relative to its size.
TEST_P(Accuracy, FarFromZero) {
  Random random(12);
  const Vec3 far{1e6, -2e6, 3e6};
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 17; ++k) patches.push_back(random_polynomial(random, 3, 3, far, 5));
  const PatchSet set = set_of(patches);
  const std::vector<double> t = uniform_parameters(5);
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
  EXPECT_LE(position_errors_of<float>(set, plan, t, t).polynomial, 2);
}

/// Scales from 1e-12 to 1e12 give the same normals as scale 1, not zero and not NaN.
TEST_P(Accuracy, NormalsAtAnyScale) {
  Random random(13);
  const std::vector<double> t = uniform_parameters(4);
  const std::vector<Vec3> points = random_points(random, 3, 3);
  for (const double scale : {0x1p-80, 0x1p-40, 1.0, 0x1p40, 0x1p80}) {
    std::vector<Vec3> scaled = points;
    for (Vec3& p : scaled) p = scale * p;
    const PatchSet set = set_of({polynomial(3, 3, scaled)}, {.origin = Vec3{}});
    const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
    GridBuffers<float> out(plan);
    ASSERT_TRUE(evaluate(set, plan, out.views()).ok());
    for (std::size_t k = 0; k < 16; ++k)
      EXPECT_TRUE(within_units(vector_at(out.normal, k), reference_normal(set.patch(0), t[k / 4], t[k % 4]), 1e-4, 1))
          << scale;
  }
}

/// A patch a billionth of the others in size has unit normals too, and does not change its neighbours' bits.
TEST_P(Accuracy, NormalsOfTinyPatchesAmongLargeOnes) {
  Random random(14);
  const std::vector<double> t = uniform_parameters(3);
  const BezierPatch large = random_polynomial(random, 3, 3);
  const std::vector<Vec3> points = random_points(random, 3, 3);
  const auto normals_of = [&](const std::vector<BezierPatch>& patches) {
    const PatchSet set = set_of(patches, {.origin = Vec3{}});
    const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
    GridBuffers<float> out(plan);
    EXPECT_TRUE(evaluate(set, plan, out.views()).ok());
    return out.normal;
  };
  const std::vector<float> alone = normals_of({large});
  for (const double scale : {1e-3, 1e-9, 1e-11, 1e-12, 1e-20, 1e-30}) {
    std::vector<Vec3> scaled = points;
    for (Vec3& p : scaled) p = scale * p;
    const BezierPatch tiny = polynomial(3, 3, scaled);
    const std::vector<float> both = normals_of({large, tiny});
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), both.begin()));
    for (std::size_t k = 0; k < 9; ++k)
      EXPECT_TRUE(within_units(vector_at(both, 9 + k), reference_normal(tiny, t[k / 3], t[k % 3]), 1e-4, 1)) << scale;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryIsa, Accuracy, ::testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& param) { return std::string(name(param.param)); });

}}  // namespace tessera::test
