#pragma once
// Parts far from each other, and the expectations on their meshes.

#include <tbb/task_arena.h>
#include <algorithm>
#include <cmath>
#include <string>
#include "base/impl_access.h"
#include "support/crack_survey.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/cells/f64_points.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"
#include "tessera/bezier_operations.h"
#include "tessera/tessellation.h"

namespace tessera::test {

/// The bodies at both ends of a length along x.
inline std::vector<BezierPatch> far_apart(const std::vector<BezierPatch>& body, double apart) {
  std::vector<BezierPatch> patches = placed(body, 1, {-apart / 2, 0.3, 0.1});
  const std::vector<BezierPatch> other = placed(body, 1, {apart / 2, -0.2, 0.7});
  patches.insert(patches.end(), other.begin(), other.end());
  return patches;
}

/// The side of a cylinder about the z axis, as four rational patches.
inline std::vector<BezierPatch> cylinder(double radius, double height) {
  constexpr double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  std::vector<BezierPatch> patches;
  for (int quarter = 0; quarter < 4; ++quarter) {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int i = 0; i <= 2; ++i)
      for (const double z : {0.0, height}) {
        points.push_back({radius * x[2 * quarter + i], radius * y[2 * quarter + i], z});
        weights.push_back(i == 1 ? std::sqrt(0.5) : 1);
      }
    patches.push_back(rational(2, 1, points, weights));
  }
  return patches;
}

/// Every control point moved by some units in its last place, and each patch turned; poles stay points.
inline std::vector<BezierPatch> shaken_bits(const std::vector<BezierPatch>& patches, std::uint64_t seed,
                                            double by = 1e-15) {
  Random random(seed);
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) {
      const bool is_pole = std::count(patch.points().begin(), patch.points().end(), p) > 1;
      const Vec3 shift = uniform_vector(random, -1, 1);
      if (!is_pole) p = p + by * length(p) * shift;
    }
    out.push_back(reoriented(good(patch.with_points(points)), static_cast<int>(random() % 8)));
  }
  return out;
}

/// GCC 12 omits the rounding when it vectorizes conversions to float and back.
inline double as_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return double{rounded};
}

/// Moves every control point as far as its float, relative to the origin, does not change, and turns each patch.
inline std::vector<BezierPatch> shaken_within_floats(const std::vector<BezierPatch>& patches, std::uint64_t seed) {
  Random random(seed);
  const auto shaken = [&](double x) {
    const double packed = as_float(x);
    return packed + 0x1p-25 * uniform(random, -0.99, 0.99) * std::abs(packed);
  };
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) p = {shaken(p.x), shaken(p.y), shaken(p.z)};
    out.push_back(reoriented(good(patch.with_points(points)), static_cast<int>(random() % 8)));
  }
  return out;
}

/// Compares about `count` triangles of a mesh with the true distance.
inline void expect_bounds(const PatchSet& set, const Mesh& mesh, std::span<const float> bounds,
                          std::size_t count = 200) {
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 1 + mesh.triangle_count() / count) {
    const std::uint32_t patch = mesh.patches[t];
    EXPECT_LE(largest_distance(set.patch(patch), triangle_of(mesh, t), 0.1, 60).low, bounds[patch]) << t;
  }
}

inline void expect_closed(const Mesh& mesh) {
  const MeshReport report = good(check(mesh));
  EXPECT_TRUE(report.closed()) << report.open_edges << " open, " << report.non_manifold_edges << " not manifold";
  EXPECT_EQ(report.degenerate_triangles, 0u);
}

inline bool is_f64(const Tessellation& plan, std::size_t patch) { return proven_mesh_of(plan).plan().is_f64(patch); }
/// Whether vertices of any patch come from doubles.
inline bool is_f64(const Tessellation& plan) {
  return !proven_mesh_of(plan).plan().patches().rare->f64_patches.empty();
}

}  // namespace tessera::test
