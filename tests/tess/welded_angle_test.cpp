// Angles of patches with a short border that welding makes a point: proven of the surface itself, or not at all.

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/reference.h"
#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// The largest angle between two normals of the surface over one triangle, by the reference evaluator.
double largest_turn(const BezierPatch& patch, const Mesh& mesh) {
  double most = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::vector<RealVec3> normals;
    for (int a = 0; a <= 4; ++a)
      for (int b = 0; a + b <= 4; ++b) {
        const double share[] = {a / 4.0, b / 4.0, (4 - a - b) / 4.0};
        double u = 0, v = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          u += share[c] * double(mesh.parameters[2 * mesh.indices[3 * t + c]]);
          v += share[c] * double(mesh.parameters[2 * mesh.indices[3 * t + c] + 1]);
        }
        const RealJet jet = reference_jet(patch, u, v);
        normals.push_back(normalized(cross(jet.du, jet.dv)));
      }
    for (const RealVec3& a : normals)
      for (const RealVec3& b : normals) {
        const RealVec3 c = cross(a, b);
        most = std::max(most, double(std::atan2(std::sqrt(dot(c, c)), dot(a, b))));
      }
  }
  return most;
}

/// A random patch whose border v = 0 is about `length` long.
BezierPatch with_short_border(Random& random, double length) {
  const int m = 1 + static_cast<int>(random() % 4), n = 1 + static_cast<int>(random() % 4);
  const Vec3 tip = 0.5 * uniform_vector(random, -1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      points.push_back(j == 0 ? tip + length * uniform_vector(random, -1, 1)
                              : Vec3{double(i) / m, double(j) / n, 0} + 0.35 * uniform_vector(random, -1, 1));
  return polynomial(m, n, points);
}

TEST(WeldedAngle, HoldsForTheSurfaceOrIsNotClaimed) {
  Random random(1);
  std::size_t proven = 0, unproven = 0, apart = 0;
  for (int k = 0; k < 400; ++k) {
    const double length = std::pow(10.0, uniform(random, -3.5, -1.5));
    const PatchSet set = set_of({with_short_border(random, length)});
    TessellationOptions options{.angle = uniform(random, 0.1, 0.5), .angle_rate = 8, .max_triangles = 20000};
    if (k % 2) options.joining.weld = std::min(4 * length, 0.049 * set.box().diagonal());
    const auto plan = Tessellation::make(set, options);
    if (!plan) continue;
    const bool is_welded = plan->welded_borders() > 0, has_bound = std::isfinite(plan->angles()[0]);
    EXPECT_EQ(plan->patches_without_angle(), has_bound ? 0u : 1u);
    (!is_welded ? apart : has_bound ? proven : unproven) += 1;
    if (!has_bound) continue;
    EXPECT_LE(plan->angle(), *options.angle * (1 + 1e-6));
    // Parameters are floats.
    EXPECT_LE(largest_turn(set.patch(0), mesh_of(set, *plan)), double(plan->angles()[0]) * (1 + 1e-5) + 2e-6)
        << k << ": welded " << is_welded << ", border " << length;
  }
  EXPECT_GT(unproven, 20u);
  EXPECT_GT(apart, 20u);
  EXPECT_GT(proven + apart, 20u);
}

/// A flat patch with a short border has normals that do not turn, welded or not.
TEST(WeldedAngle, OfAFlatPatchIsProven) {
  const PatchSet set = set_of({polynomial(1, 1, {{0, 0, 0}, {-0.5, 1, 0}, {1e-3, 0, 0}, {0.5, 1, 0}})});
  const Tessellation plan = good(Tessellation::make(set, {.angle = 0.1, .joining = {.weld = 0.01}}));
  EXPECT_EQ(plan.welded_borders(), 1u);
  EXPECT_EQ(plan.patches_without_angle(), 0u);
  EXPECT_LE(plan.angle(), 1e-3);
  EXPECT_EQ(plan.capacity().triangles, 1u);
}

/// Poles that are points but for noise cost as many triangles as exact ones: most of such a patch has the angle.
TEST(WeldedAngle, NoisyPolesCostNoTriangles) {
  const std::vector<BezierPatch> exact = sphere();
  std::vector<BezierPatch> noisy;
  Random random(9);
  for (const BezierPatch& patch : exact) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (std::size_t j = 6; j < 9; ++j) points[j] = points[j] + 1e-7 * uniform_vector(random, -1, 1);
    noisy.push_back(good(patch.with_points(points)));
  }
  const TessellationOptions options{.angle = 0.1, .joining = {.weld = 1e-6}};
  const Tessellation plan = good(Tessellation::make(set_of(noisy), options));
  EXPECT_EQ(plan.patches_without_angle(), 8u);
  EXPECT_EQ(plan.angle(), 0);
  const Tessellation of_exact = good(Tessellation::make(set_of(exact), options));
  EXPECT_EQ(of_exact.patches_without_angle(), 0u);
  EXPECT_NEAR(double(plan.capacity().triangles), double(of_exact.capacity().triangles),
              0.05 * double(of_exact.capacity().triangles));
}

}}  // namespace tessera::test
