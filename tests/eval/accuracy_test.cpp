// Every ISA against the long double reference, for every degree, in the units of evaluate.h.

#include <gtest/gtest.h>

#include <cmath>

#include "support/grids.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test {
namespace {

/// Largest errors over a set, in units of the largest |coefficient| of each patch.
struct Errors {
  double polynomial = 0, rational = 0;          // positions
  double derivative = 0, rational_derivative = 0;  // over the degree
  double normal = 0;                            // times the sine of the tangents' angle and the shorter tangent, over the largest coefficient
};

/// The largest |w (V - origin)| over the weight at (u,v).
double homogeneous_size(const BezierPatch& patch, const Vec3& origin, double u, double v) {
  double largest = 0;
  for (std::size_t k = 0; k < patch.points().size(); ++k)
    largest = std::max(largest, patch.weights()[k] * max_abs(patch.points()[k] - origin));
  Real weight;
  reference_sum(patch, u, v, 0, 0, weight);
  return largest / static_cast<double>(weight);
}

template <class T>
Errors errors_of(const PatchSet& set, const GridPlan& plan, const std::vector<double>& u, const std::vector<double>& v) {
  GridBuffers<T> out(plan);
  const Status status = evaluate(set, plan, out.views());
  EXPECT_TRUE(status.ok()) << status.message();
  const double epsilon = sizeof(T) == 4 ? float_unit : double_unit;
  const Vec3 origin = sizeof(T) == 4 ? set.origin() : Vec3{};
  Errors errors;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    const double unit = epsilon * largest_coefficient(patch, set.origin());
    const double degree = std::max(patch.degree_u(), patch.degree_v());
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j) {
        const std::size_t record = (k * u.size() + i) * v.size() + j;
        const RealJet jet = reference_jet(patch, u[i], v[j]);
        const RealVec3 relative = jet.position - RealVec3{origin.x, origin.y, origin.z};
        double& position = patch.is_rational() ? errors.rational : errors.polynomial;
        double& derivative = patch.is_rational() ? errors.rational_derivative : errors.derivative;
        position = std::max(position, error_in_units(vector_at(out.position, record), relative.rounded(), unit));
        const double derivative_unit = patch.is_rational() ? epsilon * homogeneous_size(patch, set.origin(), u[i], v[j]) : unit;
        for (const auto& [values, expected] : {std::pair{&out.du, jet.du}, {&out.dv, jet.dv}})
          derivative = std::max(derivative, error_in_units(vector_at(*values, record), expected.rounded(), derivative_unit) / degree);
        const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
        const double conditioned = length(cross(du, dv)) / std::max(length(du), length(dv));
        const double error = error_in_units(vector_at(out.normal, record), reference_normal(patch, u[i], v[j]), unit);
        errors.normal = std::max(errors.normal, error * unit / derivative_unit * conditioned / degree);
      }
  }
  return errors;
}

class Accuracy : public ::testing::TestWithParam<Isa> {};

template <class T>
void check_bounds(Isa isa, Representation representation) {
  Random random(11);
  PatchSetOptions options;
  options.blocks = {true, true, true, true};
  // Odd and clustered parameters, and the ends.
  const std::vector<double> u = {0, 1, 0.5, 0.1, 1.0 / 3, 0.999, 1e-6}, v = {1, 0.25, 0.77, 0, 2.0 / 3};
  for (int degree = 1; degree <= (representation == Representation::bernstein ? max_degree : 3); ++degree) {
    std::vector<BezierPatch> patches;
    for (int k = 0; k < 20; ++k) {
      const int other = 1 + static_cast<int>(random() % static_cast<unsigned>(degree));
      const int m = k % 2 ? degree : other, n = k % 2 ? other : degree;
      patches.push_back(k % 4 < 2 ? random_polynomial(random, m, n) : random_rational(random, m, n));
    }
    const PatchSet set = set_of(patches, options);
    const GridPlan plan = value_of(GridPlan::make(set, u, v, {precision_of<T>, representation, isa}));
    const Errors errors = errors_of<T>(set, plan, u, v);
    if (representation == Representation::bernstein) {
      EXPECT_LE(errors.polynomial, 2) << "degree " << degree;
      EXPECT_LE(errors.rational, 4) << "degree " << degree;
      EXPECT_LE(errors.derivative, 16) << "degree " << degree;
      EXPECT_LE(errors.rational_derivative, 16) << "degree " << degree;
      EXPECT_LE(errors.normal, 8) << "degree " << degree;
    } else {  // the power basis loses up to 58 units at degree 3
      EXPECT_LE(errors.polynomial, 58) << "degree " << degree;
      EXPECT_LE(errors.rational, 200) << "degree " << degree;
    }
  }
}

TEST_P(Accuracy, FloatBernstein) { check_bounds<float>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, DoubleBernstein) { check_bounds<double>(GetParam(), Representation::bernstein); }
TEST_P(Accuracy, FloatPower) { check_bounds<float>(GetParam(), Representation::power); }
TEST_P(Accuracy, DoublePower) { check_bounds<double>(GetParam(), Representation::power); }

/// A model of size 10 a million away keeps float's precision relative to its size.
TEST_P(Accuracy, FarFromZero) {
  Random random(12);
  const Vec3 far{1e6, -2e6, 3e6};
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 17; ++k) patches.push_back(random_polynomial(random, 3, 3, far, 5));
  const PatchSet set = set_of(patches);
  const std::vector<double> t = uniform_parameters(5);
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
  EXPECT_LE(errors_of<float>(set, plan, t, t).polynomial, 2);
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
      EXPECT_TRUE(within_units(vector_at(out.normal, k), reference_normal(set.patch(0), t[k / 4], t[k % 4]), 1e-4, 1)) << scale;
  }
}

/// A patch a billionth of the others in size has unit normals as well, and does not change its neighbours' bits.
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

}  // namespace
}  // namespace tessera::test
