// Trimmed quadrics: their loops are in the canonical parameters, though arcs of their patches are rational.

#include <functional>
#include <numbers>

#include "support/quadrics.h"
#include "tess_trim/trimmed_face.h"
#include "tessera/trim_region.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

ModelSurface trimmed(const QuadricPiece& part, std::vector<TrimLoop> loops) {
  return {.name = std::string("face"), .surface = part, .trims = std::move(loops)};
}

TrimRegion region_of(const ModelSurface& face) {
  return value_of(TrimRegion::make(*value_of(grid_trims(face)), value_of(to_bezier(face))));
}

/// Compares the sides of random points with `distance`, which is positive where (u,v) is kept.
void expect_sides(const ModelSurface& face, const std::function<double(double, double)>& distance) {
  const TrimRegion region = region_of(face);
  const Domain d = domain(face.surface);
  Random random(1);
  int kept = 0;
  for (int k = 0; k < 4000; ++k) {
    const double u = uniform(random, d.u0, d.u1), v = uniform(random, d.v0, d.v1), beyond = distance(u, v);
    const auto at = grid_parameters(face.surface, u, v);
    kept += beyond > 0;
    if (std::abs(beyond) > 1e-7) {
      ASSERT_EQ(region.locate(at[0], at[1]), beyond > 0 ? TrimSide::inside : TrimSide::outside) << u << ", " << v;
    }
  }
  EXPECT_GT(kept, 200);
  EXPECT_LT(kept, 3800);
}

TEST(QuadricFaces, KeepTheirCanonicalParametersOnEveryKind) {
  for (const QuadricSample& sample : quadric_samples()) {
    if (!is_surface(sample.kind)) continue;
    SCOPED_TRACE(name(sample.kind));
    const Domain d = sample_range(sample.kind);
    const QuadricPiece part = piece(quadric(sample.coefficients), d);
    const ParameterPoint centre{d.u_at(0.4), d.v_at(0.55)};
    const double a = 0.31 * (d.u1 - d.u0), b = 0.22 * (d.v1 - d.v0);
    expect_sides(trimmed(part, {ellipse(centre, a, b, true)}),
                 [&](double u, double v) { return std::hypot((u - centre.u) / a, (v - centre.v) / b) - 1; });
    // A slanted half-plane, whose loop leaves the domain.
    const TrimLoop half =
        polygon({{d.u_at(-0.3), d.v_at(-0.5)}, {d.u_at(1.2), d.v_at(1.4)}, {d.u_at(1.2), d.v_at(-0.5)}});
    expect_sides(trimmed(part, {half}), [&](double u, double v) {
      const double x = (u - d.u0) / (d.u1 - d.u0), y = (v - d.v0) / (d.v1 - d.v0);
      return (x + 0.3) / 1.5 - (y + 0.5) / 1.9;
    });
  }
}

TEST(QuadricFaces, CrossTheSeam) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = 1, .k = -1}), {0, 2 * std::numbers::pi, -1, 2});
  const auto beyond = [](double u, double v) {
    return std::hypot(std::remainder(u + 0.2, 2 * std::numbers::pi), v - 0.4) - 0.9;
  };
  for (const double turns : {-1.0, 0.0, 1.0, 2.0})
    expect_sides(trimmed(part, {circle({2 * std::numbers::pi * turns - 0.2, 0.4}, 0.9, true)}), beyond);
}

TEST(QuadricFaces, KeepLinesAlongAParameterStraight) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}),
                                  {0, 2 * std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 2});
  const ModelSurface face = trimmed(part, {rectangle(0.3, std::numbers::pi / 2, -0.4, std::numbers::pi / 2, true)});
  const Shared<std::vector<TrimLoop>> loops = value_of(grid_trims(face));
  for (const Curve& curve : loops->at(0).curves) {
    EXPECT_EQ(curve.degree(), 1);
    for (const Vec3& p : curve.points()) {
      const auto own = own_parameters(face.surface, p.x, p.y);
      EXPECT_LE(std::min(std::abs(own[0] - 0.3), std::abs(own[0] - std::numbers::pi / 2)), 1e-15);
      EXPECT_LE(std::min(std::abs(own[1] + 0.4), std::abs(own[1] - std::numbers::pi / 2)), 1e-15);
    }
  }
  EXPECT_TRUE(loops->at(0).hole);
  const ModelSurface plane = trimmed(piece(quadric({.g = 2}), {0, 1, 0, 1}), {circle({0.5, 0.5}, 0.2)});
  EXPECT_EQ(*value_of(grid_trims(plane)), *plane.trims);
}

TEST(QuadricFaces, SayWhichLoopIsTooLong) {
  const QuadricPiece part = piece(quadric({.a = 1, .b = 1, .k = -1}), {0, 2 * std::numbers::pi, 0, 1});
  const ModelSurface face =
      trimmed(part, {circle({1, 0.5}, 0.1), polygon({{0, 0}, {65 * 2 * std::numbers::pi, 0}, {1, 1}})});
  const Status status = grid_trims(face).status();
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_EQ(status.index(), 1);
  const PatchSet set = value_of(make_patch_set(Model{.name = {}, .surfaces = {face}}));
  ASSERT_EQ(set.trim_faults().size(), 1u);
  EXPECT_EQ(set.trim_faults()[0].message(),
            "surface 0 (face): loop 1 runs over more than 64 times the ranges of the quadric");
}

double area(const Mesh& mesh) {
  const auto position = [&](std::size_t corner) {
    const float* p = &mesh.positions[3 * std::size_t{mesh.indices[corner]}];
    return Vec3{p[0], p[1], p[2]};
  };
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    sum += length(cross(position(3 * t + 1) - position(3 * t), position(3 * t + 2) - position(3 * t))) / 2;
  return sum;
}

double meshed_area(const ModelSurface& face, double tolerance) {
  const PatchSet set = value_of(make_patch_set(Model{.name = {}, .surfaces = {face}}));
  EXPECT_TRUE(set.trim_faults().empty());
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance}));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  return area(mesh);
}

/// A mesh within 1e-5 of a face about as large as 1 has an area that is off by 1e-5 of it and of its border's length.
TEST(QuadricFaces, HaveTheAreaOfTheirFormulas) {
  constexpr double tolerance = 1e-5, slack = 40 * tolerance;
  const QuadricPiece ball = piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}),
                                  {0, 2 * std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 2});
  const double window = 0.8 * (std::sin(0.9) - std::sin(-0.35));
  EXPECT_NEAR(meshed_area(trimmed(ball, {rectangle(0.4, 1.2, -0.35, 0.9)}), tolerance), window, slack);
  EXPECT_NEAR(meshed_area(trimmed(ball, {rectangle(0.4, 1.2, -0.35, 0.9, true)}), tolerance),
              4 * std::numbers::pi - window, slack);
  const QuadricPiece pipe = piece(quadric({.a = 1, .b = 1, .k = -1}), {0, 2 * std::numbers::pi, -1, 1});
  EXPECT_NEAR(meshed_area(trimmed(pipe, {circle({0.4, 0.1}, 0.7)}), tolerance), std::numbers::pi * 0.49, slack);
  EXPECT_NEAR(meshed_area(trimmed(pipe, {circle({0, 0.1}, 0.7, true)}), tolerance),
              4 * std::numbers::pi - std::numbers::pi * 0.49, slack);
  // A cone's area is the integral of sqrt(2) v; the ellipse's moment is that of its centre.
  const QuadricPiece cone = piece(quadric({.a = 1, .b = 1, .c = -1}), {0, 2 * std::numbers::pi, 0, 2});
  EXPECT_NEAR(meshed_area(trimmed(cone, {ellipse({1, 1.1}, 0.9, 0.4)}), tolerance),
              std::sqrt(2) * 1.1 * std::numbers::pi * 0.9 * 0.4, slack);
}

}}  // namespace tessera::test
