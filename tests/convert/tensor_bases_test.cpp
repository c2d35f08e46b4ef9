// Tensor patches from one basis to another, and to Bezier patches.

#include "support/errors.h"
#include "support/lecture_points.h"
#include "support/random_bases.h"
#include "support/reference.h"
#include "support/ulp.h"
#include "tessera/convert.h"

namespace tessera::test { namespace {

double largest_element(std::span<const Vec3> elements) {
  double largest = 0;
  for (const Vec3& p : elements) largest = std::max(largest, max_abs(p));
  return largest;
}

/// The largest growth of numbers in a basis on the way from Bezier points.
double condition(const BasisMatrix& basis) {
  double largest = 0;
  for (int i = 0; i <= basis.degree(); ++i) {
    double sum = 0;
    for (int k = 0; k <= basis.degree(); ++k) sum += std::abs(basis.inverse_coefficient(i, k));
    largest = std::max(largest, sum);
  }
  return largest;
}

/// The largest factor by which the blends of a basis multiply rounding errors of the geometry: 1 if they keep to the
/// hull.
double growth(const BasisMatrix& basis) {
  double largest = 1;
  for (int k = 0; k <= basis.degree(); ++k) {
    double sum = 0;
    for (int i = 0; i <= basis.degree(); ++i) sum += std::abs(basis.bernstein_coefficient(k, i));
    largest = std::max(largest, sum);
  }
  return largest;
}

TEST(TensorToBezier, IsTheSurfaceInEveryPairOfBasesAndDegrees) {
  Random random(1);
  for_all_pairs_of_bases(random, [](const TensorPatch& patch, const std::string& bases) {
    const Domain& d = patch.domain();
    const int m = patch.basis_u().degree(), n = patch.basis_v().degree();
    const PatchGrid grid = value_of(to_bezier(patch));
    EXPECT_EQ(grid.domain(), d);
    EXPECT_EQ(grid.fit_error().distance, 0);
    EXPECT_TRUE(grid.fit_error().certified);
    ASSERT_EQ(grid.patches().size(), 1u);
    const BezierPatch& bezier = grid.patches()[0];
    EXPECT_EQ(std::pair(bezier.degree_u(), bezier.degree_v()), std::pair(m, n));
    const double largest = std::max(largest_element(patch.geometry()), largest_coefficient(bezier));
    for (int k = 0; k <= 10; ++k) {
      const double s = k / 10.0, t = std::fmod(0.7 * k, 1.0);
      EXPECT_TRUE(within_units(reference_position(bezier, s, t), evaluate_jet(patch, d.u_at(s), d.v_at(t)).position,
                               double_unit * largest, 8))
          << bases;
    }
    const SurfaceJet jet = evaluate_jet(patch, 1, 0.6), other = *grid.evaluate_jet(1, 0.6);
    const double unit = double_unit * largest * m * n;
    EXPECT_TRUE(within_units(other.du, jet.du, unit, 16));
    EXPECT_TRUE(within_units(other.dv, jet.dv, 4 * unit, 16));
    EXPECT_TRUE(within_units(other.duv, jet.duv, 4 * unit, 32));
  });
}

TEST(ChangeOfBasis, ThereAndBackIsTheSameGeometry) {
  Random random(2);
  for (const int n : {1, 2, 3, 5})
    for (const auto& [name_from, from] : bases_of(random, n))
      for (const auto& [name_to, to] : bases_of(random, n)) {
        const TensorPatch patch = random_tensor(random, from, to);
        const TensorPatch other = value_of(change_basis(patch, to, from));
        EXPECT_EQ(other.basis_u(), to);
        EXPECT_EQ(other.domain(), patch.domain());
        const TensorPatch back = value_of(change_basis(other, from, to));
        const double unit = double_unit * largest_element(other.geometry()) * condition(from) * condition(to);
        for (std::size_t k = 0; k < back.geometry().size(); ++k)
          EXPECT_TRUE(within_units(back.geometry()[k], patch.geometry()[k], unit, 8)) << name_from << " to " << name_to;
      }
}

TEST(ChangeOfBasis, KeepsTheSurfaceAtTheSameOrHigherDegrees) {
  Random random(3);
  for (const int to_degree : {3, 4, 6})
    for (const auto& [name_from, from] : bases_of(random, 3))
      for (const auto& [name_to, to] : bases_of(random, to_degree)) {
        const TensorPatch patch = random_tensor(random, from, from, {0, 2, 0, 2});
        const TensorPatch other = value_of(change_basis(patch, to, to));
        const double largest = std::max({largest_element(other.geometry()), largest_element(patch.geometry()),
                                         largest_coefficient(value_of(to_bezier(patch)).patches()[0])});
        const double unit = double_unit * largest * growth(to) * growth(to);
        for (const double u : {0.0, 0.7, 2.0})
          for (const double v : {0.1, 1.5})
            EXPECT_TRUE(within_units(evaluate_jet(other, u, v).position, evaluate_jet(patch, u, v).position, unit, 8))
                << name_from << " to " << name_to << " of degree " << to_degree;
      }
}

TEST(ChangeOfBasis, ToTheSameBasisChangesNothing) {
  Random random(4);
  for (const auto& [name, basis] : bases_of(random, 3)) {
    const TensorPatch patch = random_tensor(random, basis, basis);
    const TensorPatch same = value_of(change_basis(patch, basis, basis));
    EXPECT_TRUE(std::equal(patch.geometry().begin(), patch.geometry().end(), same.geometry().begin())) << name;
  }
}

TEST(ChangeOfBasis, IsAffinelyInvariant) {
  // For bases whose blends sum to one a shift of the points shifts the result.
  Random random(5);
  const BasisMatrix spline = value_of(BasisMatrix::uniform_b_spline(3)), cubic = value_of(BasisMatrix::bezier(3));
  const TensorPatch patch = random_tensor(random, spline, spline);
  std::vector<Vec3> moved;
  for (const Vec3& p : patch.geometry()) moved.push_back({2 * p.y + 1, p.z - p.x, 3 * p.x - 5});
  const TensorPatch bezier = value_of(change_basis(patch, cubic, cubic));
  const TensorPatch moved_bezier =
      value_of(change_basis(value_of(TensorPatch::make(spline, spline, moved)), cubic, cubic));
  for (std::size_t k = 0; k < 16; ++k) {
    const Vec3& p = bezier.geometry()[k];
    EXPECT_TRUE(within_units(moved_bezier.geometry()[k], {2 * p.y + 1, p.z - p.x, 3 * p.x - 5}, 8 * double_unit, 2));
  }
}

TEST(ChangeOfBasis, BicubicFiguresInEveryBasis) {
  const BasisMatrix cubic = value_of(BasisMatrix::bezier(3));
  const TensorPatch bezier = value_of(TensorPatch::make(cubic, cubic, lecture_points()));
  Random random(6);
  for (const auto& [name_u, basis_u] : bases_of(random, 3))
    for (const auto& [name_v, basis_v] : bases_of(random, 3)) {
      const TensorPatch patch = value_of(change_basis(bezier, basis_u, basis_v));
      const double unit = double_unit * largest_element(patch.geometry());
      const PatchGrid grid = value_of(to_bezier(patch));
      const std::string bases = std::string(name_u) + " x " + name_v;
      const auto near = [&](const SurfaceJet& jet, double limit) {
        EXPECT_TRUE(within_units(jet.position, {0.5, 0.6875, 0.15625}, unit, limit)) << bases;
        EXPECT_TRUE(within_units(jet.du, {-0.375, -0.5625, -0.375}, unit, 3 * limit)) << bases;
        EXPECT_TRUE(within_units(jet.dv, {-0.5625, -0.375, 0.375}, unit, 3 * limit)) << bases;
        EXPECT_TRUE(within_units(jet.duv, {-1.125, -3.375, -1.125}, unit, 9 * limit)) << bases;
      };
      near(evaluate_jet(patch, 0.5, 0.5), 4);
      near(*grid.evaluate_jet(0.5, 0.5), 8);
      EXPECT_TRUE(within_units(evaluate_jet(patch, 0.25, 0.75).position, {0.44189453125, 0.85498046875, 0.44189453125},
                               unit, 4));
      EXPECT_TRUE(within_units(grid.evaluate_jet(0.25, 0.75)->position, {0.44189453125, 0.85498046875, 0.44189453125},
                               unit, 8));
    }
}

TEST(ChangeOfBasis, RefusesWhatHasNoForm) {
  Random random(7);
  const BasisMatrix cubic = value_of(BasisMatrix::hermite()), line = value_of(BasisMatrix::bezier(1));
  const BasisMatrix singular = value_of(BasisMatrix::custom(3, std::vector<double>(16, 1)));
  const TensorPatch patch = random_tensor(random, cubic, cubic);
  expect_refused(change_basis(patch, line, cubic), StatusCode::unsupported_degree, -1,
                 "a patch of degree 3 in u has no form of degree 1");
  expect_refused(change_basis(patch, cubic, line), StatusCode::unsupported_degree, -1, "in v");
  expect_refused(change_basis(patch, singular, cubic), StatusCode::invalid_argument, -1,
                 "the basis matrix of u is singular");
  expect_refused(change_basis(patch, cubic, singular), StatusCode::invalid_argument, -1,
                 "the basis matrix of v is singular");
  // A singular basis can be evaluated and converted from.
  EXPECT_TRUE(change_basis(random_tensor(random, singular, singular), cubic, singular).ok());
  EXPECT_TRUE(to_bezier(random_tensor(random, singular, singular)).ok());
  const TensorPatch huge =
      value_of(TensorPatch::make(value_of(BasisMatrix::power(1)), line, std::vector<Vec3>(4, {1e308, 0, 0})));
  expect_refused(to_bezier(huge), StatusCode::non_finite, 2, "control point [1][0] is (inf, 0, 0)");
}

}}  // namespace tessera::test
