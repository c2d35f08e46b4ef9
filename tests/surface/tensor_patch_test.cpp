// Tensor-product patches over any bases: the reference evaluator against sums of powers, and errors.

#include "support/errors.h"
#include "support/lecture_points.h"
#include "support/random_bases.h"
#include "support/reference.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// d^order/dt^order of t^k.
Real power_derivative(int k, Real t, int order) {
  Real factor = 1;
  for (int o = 0; o < order; ++o) factor *= k - o;
  return factor == 0 ? 0 : factor * reference_power(t, k - order);
}

/// r = U M_u G M_v^T V^T as it is written, in the local parameters; `size` bounds the sum's terms.
RealVec3 by_definition(const TensorPatch& patch, Real s, Real t, int a, int b, Real& size) {
  RealVec3 sum;
  size = 0;
  const auto blend = [](const BasisMatrix& basis, int i, Real at, int order, Real& magnitude) {
    Real value = 0;
    magnitude = 0;
    for (int k = 0; k <= basis.degree(); ++k) {
      const Real term = basis.power_coefficient(k, i) * power_derivative(k, at, order);
      value += term;
      magnitude += std::abs(term);
    }
    return value;
  };
  for (int i = 0; i <= patch.basis_u().degree(); ++i)
    for (int j = 0; j <= patch.basis_v().degree(); ++j) {
      Real f_size = 0, g_size = 0;
      const Real f = blend(patch.basis_u(), i, s, a, f_size), g = blend(patch.basis_v(), j, t, b, g_size);
      const Vec3& p = patch.element(i, j);
      sum = sum + (f * g) * RealVec3{p.x, p.y, p.z};
      size += f_size * g_size * Real(max_abs(p));
    }
  return sum;
}

TEST(TensorPatch, IsTheProductOfMatrices) {
  Random random(1);
  for_all_pairs_of_bases(random, [](const TensorPatch& patch, const std::string& bases) {
    const Domain& d = patch.domain();
    const int m = patch.basis_u().degree(), n = patch.basis_v().degree();
    for (const auto& [s, t] : {std::pair{0.0, 1.0}, {0.375, 0.625}, {1.0, 0.25}}) {
      const SurfaceJet jet = evaluate_jet(patch, d.u_at(s), d.v_at(t));
      const auto expect = [&, s = s, t = t](const Vec3& value, int a, int b) {
        Real size = 0;
        const Real chain = std::pow(Real(1) / 8, a) * std::pow(Real(4), b);
        const RealVec3 expected = chain * by_definition(patch, s, t, a, b, size);
        // The coefficients of the blends are rounded, and each derivative takes differences of them.
        const double differences = std::pow(2.0 * m, a) * std::pow(2.0 * n, b);
        EXPECT_TRUE(
            within_units(value, expected.rounded(), double_unit * static_cast<double>(chain * (size + differences)), 4))
            << bases << " order " << a << b;
      };
      expect(jet.position, 0, 0);
      expect(jet.du, 1, 0);
      expect(jet.dv, 0, 1);
      expect(jet.duu, 2, 0);
      expect(jet.duv, 1, 1);
      expect(jet.dvv, 0, 2);
    }
  });
}

TEST(TensorPatch, HighDegreesDontCancel) {
  // The powers of a Bezier basis of degree 15 reach 3^15; the evaluator must not see them.
  Random random(2);
  const TensorPatch patch = random_tensor(random, value_of(BasisMatrix::bezier(15)), value_of(BasisMatrix::bezier(15)));
  const BezierPatch bezier = polynomial(15, 15, std::vector<Vec3>(patch.geometry().begin(), patch.geometry().end()));
  for (int k = 0; k <= 32; ++k)
    EXPECT_TRUE(within_units(evaluate_jet(patch, k / 32.0, 1 - k / 40.0).position,
                             reference_position(bezier, k / 32.0, 1 - k / 40.0), double_unit, 1));
}

TEST(TensorPatch, UniformBSplineFigures) {
  const std::vector<Vec3> points = lecture_points();
  const BasisMatrix basis = value_of(BasisMatrix::uniform_b_spline(3));
  const TensorPatch patch = value_of(TensorPatch::make(basis, basis, points));
  EXPECT_TRUE(within_units(evaluate_jet(patch, 0.3, 0.6).position,
                           {3184649.0 / 4500000, 296411.0 / 375000, 149747.0 / 4500000}, double_unit, 2));
  EXPECT_TRUE(within_units(evaluate_jet(patch, 0, 0).position, {7.0 / 9, 5.0 / 6, -7.0 / 18}, double_unit, 1));
  // The border curve s(u,0) has the polygon (V_i0 + 4 V_i1 + V_i2) / 6.
  std::vector<Vec3> border;
  for (std::size_t i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j)
      border.push_back((1.0 / 6) * (points[4 * i] + 4 * points[4 * i + 1] + points[4 * i + 2]));
  const TensorPatch ribbon = value_of(TensorPatch::make(basis, value_of(BasisMatrix::bezier(1)), border));
  for (const double u : {0.0, 0.4, 1.0})
    EXPECT_TRUE(
        within_units(evaluate_jet(patch, u, 0).position, evaluate_jet(ribbon, u, 0.5).position, double_unit, 8));
}

TEST(TensorPatch, RefusesWhatDoesNotFit) {
  const BasisMatrix cubic = value_of(BasisMatrix::hermite()), line = value_of(BasisMatrix::bezier(1));
  std::vector<Vec3> geometry(8);
  expect_refused(TensorPatch::make(cubic, cubic, geometry), StatusCode::count_mismatch, -1,
                 "bases of degree 3 and 3 need a geometry of 4 x 4 elements, found 8");
  EXPECT_TRUE(TensorPatch::make(cubic, line, geometry).ok());
  expect_refused(TensorPatch::make(cubic, line, geometry, {1, 1, 0, 1}), StatusCode::invalid_argument, -1,
                 "the domain along u, [1, 1], must have its start below its end");
  expect_refused(TensorPatch::make(cubic, line, geometry, {0, 1, 2, -1}), StatusCode::invalid_argument, -1,
                 "along v, [2, -1]");
  expect_refused(TensorPatch::make(cubic, line, geometry, {0, infinity, 0, 1}), StatusCode::non_finite, -1, "along u");
  expect_refused(TensorPatch::make(cubic, line, geometry, {0, 1, not_a_number, 1}), StatusCode::non_finite, -1,
                 "along v");
  expect_refused(TensorPatch::make(cubic, line, geometry, {0, 1e-320, 0, 1}), StatusCode::invalid_argument, -1,
                 "too short");
  geometry[5].y = not_a_number;
  expect_refused(TensorPatch::make(cubic, line, geometry), StatusCode::non_finite, 5,
                 "geometry element [2][1] is (0, nan, 0), its coordinates must be finite");
}

}}  // namespace tessera::test
