// Checks the promise of certified tessellations against the true largest distance, found by branch and bound.

#include <algorithm>
#include <cmath>

#include "base/impl_access.h"
#include "support/true_distance.h"
#include "tess/certificate_sets.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

/// The reference itself: a paraboloid's chord error is known.
TEST(TrueDistance, OfAParaboloid) {
  // z = u^2 + v^2 over the triangle (0,0), (1,0), (0,1): the plane is z = u + v, and the largest distance from it lies
  // at (1/2, 1/2): (u + v - u^2 - v^2) / sqrt 3 = 0.5 / sqrt 3.
  const double h = 0.5;
  const BezierPatch patch = polynomial(
      2, 2, {{0, 0, 0}, {0, h, 0}, {0, 1, 1}, {h, 0, 0}, {h, h, 0}, {h, 1, 1}, {1, 0, 1}, {1, h, 1}, {1, 1, 2}});
  const MeshTriangle triangle{{{{0, 0}, {1, 0}, {0, 1}}}, {Vec3{0, 0, 0}, Vec3{1, 0, 1}, Vec3{0, 1, 1}}};
  const DistanceRange found = largest_distance(patch, triangle, 1e-4, 20000);
  EXPECT_LE(found.low, 0.5 / std::sqrt(3.0) + 1e-12);
  EXPECT_GE(found.high, 0.5 / std::sqrt(3.0) - 1e-12);
  EXPECT_LE(found.high, 1.001 * found.low);
}

/// Thirty triangles of a set's mesh.
void expect_certificates(const CertificateSet& chosen, const TessellationOptions& options, Random& random) {
  const PatchSet set = set_of(chosen.patches);
  const Tessellation plan = good(Tessellation::make(set, options));
  Mesh mesh = good(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  double tightest = 0;
  for (int sample = 0; sample < 30; ++sample) {
    const std::size_t t = random() % mesh.triangle_count();
    const double bound = plan.bounds()[mesh.patches[t]];
    const BezierPatch patch = set.patch(mesh.patches[t]);
    const DistanceRange found = largest_distance(patch, triangle_of(mesh, t), 0.1, 60);
    // Points of a scaled sweep may lie nearest to the triangle's neighbours.
    if (found.low > bound) {
      EXPECT_LE(largest_distance(patch, mesh, t, 0, mesh.triangle_count(), 0.1, 60).low, bound) << chosen.name;
    }
    tightest = std::max(tightest, found.high / bound);
  }
  EXPECT_GE(tightest, chosen.bicubic ? 0.25 : 1e-4) << chosen.name;
}

TEST(Certificate, IsNeverExceededByTheTrueDistance) {
  Random random(1);
  for (const CertificateSet& chosen : certificate_sets())
    for (const bool fewest : {false, true})
      expect_certificates(chosen, {.tolerance = 0.02, .relative = true, .fewest = fewest}, random);
}

/// Bounds of halves, where a border of an odd rate has a triangle across the middle.
TEST(Certificate, HoldsAcrossTheMiddleOfEvenRates) {
  std::size_t straddling = 0;
  for (const double relative : {2e-2, 1e-2, 5e-3, 3e-3, 2e-3}) {
    const PatchSet set = set_of(wavy_field(9, 9));
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = relative, .relative = true}));
    const Mesh mesh = mesh_of(set, plan);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::uint32_t patch = mesh.patches[t];
      const Rates rates = proven_mesh_of(plan).plan().patches().segments[patch].rates();
      const MeshTriangle triangle = triangle_of(mesh, t);
      const auto straddles = [&](std::size_t along) {
        const auto at = [&](std::size_t c) { return triangle.parameters[c][along]; };
        return std::min({at(0), at(1), at(2)}) < 0.5 && std::max({at(0), at(1), at(2)}) > 0.5;
      };
      if (!(rates.u % 2 == 0 && straddles(0)) && !(rates.v % 2 == 0 && straddles(1))) continue;
      ++straddling;
      EXPECT_LE(largest_distance(set.patch(patch), triangle, 0.05, 400).low, plan.bounds()[patch]);
      EXPECT_LE(plan.bounds()[patch], relative * set.box().diagonal() * (1 + 1e-6));
    }
  }
  EXPECT_GT(straddling, 30u);
}

}}  // namespace tessera::test
