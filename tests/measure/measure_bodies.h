#pragma once
// Bodies of the tests of measures, and what is expected of their measures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/errors.h"
#include "support/quadrics.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/bezier_operations.h"
#include "tessera/measures.h"

namespace tessera::test {

/// Expects that the truth lies within the error, and that the error is at most a share of it. The truth is itself a
/// number of 53 bits, computed by a few operations.
inline void expect_measured(const Measured& found, double truth, double share, const std::string& what) {
  EXPECT_LE(std::abs(found.value - truth), found.error + 1e-15 * std::abs(truth))
      << what << ": " << found.value << " +- " << found.error << ", true " << truth;
  EXPECT_LE(found.error, share * std::abs(truth)) << what;
}
inline void expect_point(const MeasuredPoint& found, const Vec3& truth, double most, const std::string& what) {
  EXPECT_LE(max_abs(found.value - truth), found.error + 1e-15 * max_abs(truth)) << what;
  EXPECT_LE(found.error, most) << what;
}

inline ModelSurface placed_surface(const Surface& surface, const Affine& map = {}) {
  ModelSurface of{"", surface};
  of.placement = map;
  return of;
}
inline Model model_of(std::vector<ModelSurface> surfaces) {
  Model model;
  model.surfaces = std::move(surfaces);
  return model;
}
inline std::vector<ModelSurface> surfaces_of(const std::vector<BezierPatch>& patches) {
  std::vector<ModelSurface> surfaces;
  for (const BezierPatch& patch : patches) surfaces.push_back(placed_surface(patch));
  return surfaces;
}

inline BezierPolygon reversed(BezierPolygon curve) {
  std::ranges::reverse(curve.points), std::ranges::reverse(curve.weights);
  return curve;
}

/// A patch, and the cones from an apex to its sides, which close it. All normals point to the same side.
inline std::vector<BezierPatch> cone_over(const BezierPatch& patch, const Vec3& apex) {
  std::vector<BezierPatch> patches{patch};
  for (const Side side : {Side::v0, Side::u1, Side::v1, Side::u0}) {
    const BezierPolygon curve = value_of(boundary_curve(patch, side));
    const bool runs_along = side == Side::v0 || side == Side::u1;
    patches.push_back(value_of(make_cone(apex, runs_along ? reversed(curve) : curve)));
  }
  return patches;
}

/// The volume and the first moments of cone_over() by composite Gauss rules of 5 x 5 nodes in n x n cells, with the
/// reference evaluator: a cone's volume is a third of its base's flux, its centroid 3/4 of the way from the apex.
struct ReferenceCone {
  double volume = 0;
  Vec3 moment;  ///< about the apex
};
inline ReferenceCone reference_cone(const BezierPatch& patch, const Vec3& apex, int n) {
  constexpr double x[] = {0.04691007703066800, 0.2307653449471585, 0.5, 0.7692346550528415, 0.9530899229693320};
  constexpr double w[] = {0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832,
                          0.1184634425280945};
  ReferenceCone all;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int a = 0; a < 5; ++a)
        for (int b = 0; b < 5; ++b) {
          const SurfaceJet jet = evaluate_jet(patch, (i + x[a]) / n, (j + x[b]) / n);
          const Vec3 r = jet.position - apex;
          const double flux = w[a] * w[b] / (n * n) * dot(r, cross(jet.du, jet.dv)) / 3;
          all.volume += flux;
          all.moment += 0.75 * flux * r;
        }
  return all;
}

}  // namespace tessera::test
