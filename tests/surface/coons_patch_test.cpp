// Coons patches: the figures of the lectures, their properties, and errors.

#include "tessera/coons_patch.h"

#include <cmath>
#include <stdexcept>

#include "support/borders.h"
#include "support/errors.h"
#include "support/random_hermite.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

/// Borders of (u + v, u^2 - v^2, 1 - u + v), exact ones and functions.
std::vector<CoonsBorders> saddle_borders() {
  return {{quadratic({0, 0, 1}, {1, 0, -1}, {0, 1, 0}), quadratic({1, -1, 2}, {1, 0, -1}, {0, 1, 0}),
           quadratic({0, 0, 1}, {1, 0, 1}, {0, -1, 0}), quadratic({1, 1, 0}, {1, 0, 1}, {0, -1, 0})},
          {callable([](double u) {
             return Vec3{u, u * u, 1 - u};
           }),
           callable([](double u) {
             return Vec3{u + 1, u * u - 1, 2 - u};
           }),
           callable([](double v) {
             return Vec3{v, -v * v, v + 1};
           }),
           callable([](double v) {
             return Vec3{1 + v, 1 - v * v, v};
           })}};
}
CoonsBorders square_borders() {
  return {callable([](double u) {
            return Vec3{u, 0, 0};
          }),
          callable([](double u) {
            return Vec3{u, 1, 2 * u};
          }),
          callable([](double v) {
            return Vec3{0, v, 0};
          }),
          callable([](double v) {
            return Vec3{1, v, 2 * v};
          })};
}
double h3(double t) { return 3 * t * t - 2 * t * t * t; }

template <class Body>
void over_grid(const Domain& domain, Body body) {
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) body(domain.u_at(i / 16.0), domain.v_at(j / 16.0));
}

TEST(CoonsFigures, BilinearSaddle) {
  for (const CoonsBorders& borders : saddle_borders())
    over_grid({}, [&, patch = coons(borders)](double u, double v) {
      EXPECT_EQ(value_of(position(patch, u, v)), (Vec3{u + v, u * u - v * v, 1 - u + v}));
    });
}

TEST(CoonsFigures, BilinearSquare) {
  over_grid({}, [patch = coons(square_borders())](double u, double v) {
    EXPECT_EQ(value_of(position(patch, u, v)), (Vec3{u, v, 2 * u * v}));
  });
}

TEST(CoonsFigures, PartiallyBicubicSquare) {
  const CoonsPatch patch = coons(square_borders(), Blend::cubic());
  EXPECT_EQ(value_of(position(patch, 0.25, 0.75)).z, 0.392578125);
  over_grid({}, [&](double u, double v) {
    const double z = 2 * u * h3(v) + 2 * v * h3(u) - 2 * h3(u) * h3(v);
    EXPECT_TRUE(within_units(value_of(position(patch, u, v)), {u, v, z}, double_unit, 2));
  });
}

std::vector<CoonsPatch> random_patches() {
  Random random(1);
  const Blend fifth =
      value_of(Blend::polynomial(std::vector<double>{1, 0, 0, -10, 15, -6}, std::vector<double>{0, 0, 0, 10, -15, 6}));
  std::vector<CoonsPatch> patches;
  for (const Domain& domain : {Domain{}, Domain{-2, 1, 5, 5.5}})
    for (const Blend& f : {Blend::linear(), Blend::cubic(), fifth}) {
      const CoonsBorders borders = random_borders(random, {{{3, 2}, {2, 0}, {4, 1, true}, {2, 1, true}}}, domain);
      patches.push_back(coons(borders, {.f = f, .g = Blend::cubic()}));
    }
  return patches;
}

TEST(CoonsPatch, ReproducesItsBorders) {
  for (const CoonsPatch& patch : random_patches()) {
    const Domain d = patch.domain();
    const CoonsBorders& b = patch.borders();
    for (int i = 0; i <= 20; ++i) {
      const double u = d.u_at(i / 20.0), v = d.v_at(i / 20.0);
      EXPECT_EQ(value_of(position(patch, u, d.v0)), value_of(position(b.c1, u)));
      EXPECT_EQ(value_of(position(patch, u, d.v1)), value_of(position(b.c2, u)));
      EXPECT_TRUE(within_units(value_of(position(patch, d.u0, v)), value_of(position(b.d1, v)), double_unit, 4));
      EXPECT_TRUE(within_units(value_of(position(patch, d.u1, v)), value_of(position(b.d2, v)), double_unit, 4));
    }
  }
}

TEST(CoonsPatch, IsTheFormulaInLongDouble) {
  for (const CoonsPatch& patch : random_patches())
    over_grid(patch.domain(), [&](double u, double v) {
      EXPECT_TRUE(within_units(value_of(position(patch, u, v)), reference_position(patch, u, v), double_unit, 8));
      EXPECT_EQ(value_of(position(patch, u, v)), value_of(evaluate_jet(patch, u, v)).position);
    });
}

// [f1 -1 f2] [[r00, r(0,v), r01], [r(u,0), r, r(u,1)], [r10, r(1,v), r11]] [g1 -1 g2]^T = 0.
TEST(CoonsPatch, TheProductFormVanishes) {
  for (const CoonsPatch& patch : random_patches())
    over_grid(patch.domain(), [&](double u, double v) {
      const Domain d = patch.domain();
      const auto f = value_of(patch.f().values_at(d.local_u(u))), g = value_of(patch.g().values_at(d.local_v(v)));
      const double left[] = {f[0], -1, f[1]}, right[] = {g[0], -1, g[1]};
      const double at_u[] = {d.u0, u, d.u1}, at_v[] = {d.v0, v, d.v1};
      Vec3 sum;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum += left[i] * right[j] * value_of(position(patch, at_u[i], at_v[j]));
      EXPECT_TRUE(within_units(sum, {}, double_unit, 16));
    });
}

TEST(CoonsPatch, DerivativesAreLimitsOfDifferences) {
  for (const CoonsPatch& patch : random_patches()) {
    const Domain d = patch.domain();
    const double u = d.u_at(0.4), v = d.v_at(0.7), h = 1e-5;
    const SurfaceJet jet = value_of(evaluate_jet(patch, u, v));
    const SurfaceJet right = value_of(evaluate_jet(patch, u + h, v)), left = value_of(evaluate_jet(patch, u - h, v));
    const SurfaceJet above = value_of(evaluate_jet(patch, u, v + h)), below = value_of(evaluate_jet(patch, u, v - h));
    const auto near = [&](const Vec3& derivative, const Vec3& more, const Vec3& less) {
      EXPECT_LT(max_abs(derivative - (1 / (2 * h)) * (more - less)), 3e-6 * (1 + max_abs(derivative)));
    };
    near(jet.du, right.position, left.position);
    near(jet.dv, above.position, below.position);
    near(jet.duu, right.du, left.du);
    near(jet.duv, above.du, below.du);
    near(jet.duv, right.dv, left.dv);
    near(jet.dvv, above.dv, below.dv);
  }
}

TEST(CoonsPatch, IsAffinelyInvariant) {
  Random random(2);
  const Vec3 columns[] = {uniform_vector(random, -1, 1), uniform_vector(random, -1, 1), uniform_vector(random, -1, 1)};
  const auto moved = [&](const Vec3& p) {
    return p.x * columns[0] + p.y * columns[1] + p.z * columns[2] + Vec3{3, -2, 1};
  };
  const auto mapped = [&](const BorderCurve& border) -> BorderCurve {
    const Curve& curve = std::get<Curve>(border);
    std::vector<Vec3> points;
    for (const Vec3& p : curve.points()) points.push_back(moved(p));
    if (!curve.is_rational()) return value_of(Curve::b_spline(curve.degree(), points, curve.knots()));
    return value_of(Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots()));
  };
  for (const CoonsPatch& patch : random_patches()) {
    const CoonsBorders& b = patch.borders();
    const CoonsPatch image =
        coons({mapped(b.c1), mapped(b.c2), mapped(b.d1), mapped(b.d2)}, {.f = patch.f(), .g = patch.g()});
    over_grid(patch.domain(), [&](double u, double v) {
      EXPECT_TRUE(
          within_units(value_of(position(image, u, v)), moved(value_of(position(patch, u, v))), 4 * double_unit, 8));
    });
  }
}

/// An isoparametric curve of a C2 surface as a function.
ParametricCurve line_of_surface(const BSplineSurface& surface, bool along_u, double at, const Interval& interval) {
  const auto jet = [=](double t) -> CurveJet {
    const SurfaceJet j = along_u ? evaluate_jet(surface, t, at) : evaluate_jet(surface, at, t);
    return along_u ? CurveJet{j.position, j.du, j.duu} : CurveJet{j.position, j.dv, j.dvv};
  };
  return value_of(ParametricCurve::make({.position = [=](double t) { return jet(t).position; }, .jet = jet}, interval));
}

// Four patches in the meshes of a smooth network: the largest jump of derivatives across their common borders.
double largest_jump(const Blend& blend) {
  Random random(3);
  const BSplineSurface smooth = random_surface(random, 3, 3, {3}, {3}, false);
  const Domain d = smooth.domain();
  const double u[] = {d.u0, d.u_at(0.45), d.u1}, v[] = {d.v0, d.v_at(0.6), d.v1};
  std::vector<CoonsPatch> patches;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const Interval along_u{u[a], u[a + 1]}, along_v{v[b], v[b + 1]};
      patches.push_back(
          coons({line_of_surface(smooth, true, v[b], along_u), line_of_surface(smooth, true, v[b + 1], along_u),
                 line_of_surface(smooth, false, u[a], along_v), line_of_surface(smooth, false, u[a + 1], along_v)},
                blend));
    }
  double largest = 0;
  for (std::size_t side = 0; side < 2; ++side)
    for (int k = 0; k <= 20; ++k) {
      const double along_v = v[side] + k * (v[side + 1] - v[side]) / 20,
                   along_u = u[side] + k * (u[side + 1] - u[side]) / 20;
      const SurfaceJet left = value_of(evaluate_jet(patches[side], u[1], along_v));
      const SurfaceJet right = value_of(evaluate_jet(patches[2 + side], u[1], along_v));
      const SurfaceJet below = value_of(evaluate_jet(patches[2 * side], along_u, v[1]));
      const SurfaceJet above = value_of(evaluate_jet(patches[2 * side + 1], along_u, v[1]));
      EXPECT_TRUE(within_units(left.position, right.position, double_unit, 8));  // C0
      EXPECT_TRUE(within_units(below.position, above.position, double_unit, 8));
      largest = std::max({largest, max_abs(left.du - right.du), max_abs(below.dv - above.dv)});
    }
  return largest;
}

TEST(CoonsPatch, OverASmoothNetworkBilinearOnesJoinOnlyContinuouslyAndPartiallyBicubicOnesSmoothly) {
  EXPECT_GT(largest_jump(Blend::linear()), 0.05);
  EXPECT_LT(largest_jump(Blend::cubic()), 1e-13);
}

TEST(CoonsPatch, SmallGapsAreForgivenAndTheBordersOfConstantUKept) {
  const CoonsBorders borders{quadratic({0, 0, 0}, {1, 0, 0}, {}), quadratic({0, 1, 0}, {1, 0, 0}, {}),
                             quadratic({0, 1e-10, 0}, {0, 1, 0}, {}), quadratic({1, 0, 0}, {0, 1, 0}, {})};
  const CoonsPatch patch = coons(borders);
  EXPECT_EQ(patch.corner(0, 0), Vec3{});
  EXPECT_NEAR(value_of(position(patch, 0, 0.5)).y, 0.5 + 1e-10, 1e-15);
  const CoonsOptions strict{.closing_tolerance = 1e-12};
  expect_refused(CoonsPatch::make(borders, strict), StatusCode::invalid_argument, 0, "r(u0, v0)");
}

TEST(CoonsPatch, RefusesBordersThatDoNotCloseAndNamesTheCorner) {
  const Vec3 r[2][2] = {{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 1}}};
  const auto line = [](const Vec3& from, const Vec3& to) { return quadratic(from, to - from, {}); };
  const char* names[] = {"r(u0, v0): border C1 begins at (0, 0, 0), border D1 begins at (0, 0, 0.5)",
                         "r(u0, v1): border C2 begins at (0, 1, 0), border D1 ends at (0, 1, 0.5)",
                         "r(u1, v0): border C1 ends at (1, 0, 0), border D2 begins at (1, 0, 0.5)",
                         "r(u1, v1): border C2 ends at (1, 1, 1), border D2 ends at (1, 1, 1.5)"};
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      Vec3 ends[2][2] = {{r[0][0], r[0][1]}, {r[1][0], r[1][1]}};
      ends[a][b].z += 0.5;
      const auto patch = CoonsPatch::make(
          {line(r[0][0], r[1][0]), line(r[0][1], r[1][1]), line(ends[0][0], ends[0][1]), line(ends[1][0], ends[1][1])});
      const auto corner = static_cast<std::ptrdiff_t>(2 * a + b);
      expect_refused(patch, StatusCode::invalid_argument, corner, names[corner]);
      expect_refused(patch, StatusCode::invalid_argument, corner, "a gap of 0.5");
    }
}

TEST(CoonsPatch, Refuses) {
  const auto invalid = StatusCode::invalid_argument;
  const CoonsBorders good = square_borders();
  const auto longer = [](const Vec3& a, const Vec3& b) {
    return callable([=](double t) { return a + (t / 2) * (b - a); }, {0, 2});
  };
  CoonsBorders borders = good;
  borders.c2 = longer({0, 1, 0}, {1, 1, 2});
  expect_refused(CoonsPatch::make(borders), invalid, -1, "border C1 and border C2 are on different intervals");
  borders = good;
  borders.d1 = longer({0, 0, 0}, {0, 1, 0});
  expect_refused(CoonsPatch::make(borders), invalid, -1,
                 "border D1 and border D2 are on different intervals, [0, 2] and [0, 1]");
  for (const double tolerance : {-1.0, not_a_number, infinity})
    expect_refused(CoonsPatch::make(good, {.closing_tolerance = tolerance}), invalid, -1, "closing tolerance");
  borders = good;
  borders.d2 = callable([](double v) {
    return v == 0.5 ? throw std::runtime_error("gone") : Vec3{1, v, v == 0.25 ? not_a_number : 2 * v};
  });
  const CoonsPatch patch = coons(borders);
  expect_refused(position(patch, 0.3, 0.25), StatusCode::non_finite, -1, "border D2: the curve at t = 0.25");
  expect_refused(evaluate_jet(patch, 0.3, 0.5), invalid, -1, "border D2: the curve at t = 0.5 threw: gone");
  const Curve far = quadratic({1.7e308, 0, 0}, {}, {}), near = quadratic({-1.7e308, 0, 0}, {}, {});
  expect_refused(CoonsPatch::make({far, near, far, near}), StatusCode::non_finite, -1, "too far apart");
  const Curve wide = value_of(Curve::bezier(std::vector<Vec3>{{}, {1.7e308, 0, 0}, {1.7e308, 0, 0}, {}}));
  expect_refused(position(coons({wide, wide, wide, wide}), 0.5, 0.5), StatusCode::non_finite, -1,
                 "(u, v) = (0.5, 0.5)");
  expect_refused(evaluate_jet(coons({wide, wide, wide, wide}), not_a_number, 0.5), StatusCode::non_finite, -1,
                 "border C1: the parameter is nan");
  // Squares of such lengths overflow: the gap is still found.
  const Curve huge = quadratic({0, 0, 0}, {1e300, 0, 0}, {}), other = quadratic({0, 0, 0}, {1e300, 1e300, 0}, {});
  expect_refused(CoonsPatch::make({huge, huge, huge, other}), invalid, 1, "r(u0, v1)");
}

}}  // namespace tessera::test
