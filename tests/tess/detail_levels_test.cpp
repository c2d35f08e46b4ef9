// Levels of detail: plans with one border tolerance, any of which may draw any patch without cracks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/sampled_distance.h"
#include "support/synthetic_sets.h"
#include "tess/certificate_sets.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

struct Levels {
  PatchSet set;
  std::vector<Tessellation> plans;
  std::vector<Mesh> meshes;

  Levels(const std::vector<BezierPatch>& patches, const std::vector<double>& tolerances) : set(set_of(patches)) {
    for (const double tolerance : tolerances) {
      plans.push_back(good(Tessellation::make(set, {.tolerance = tolerance, .border_tolerance = tolerances.front()})));
      meshes.push_back(mesh_of(set, plans.back()));
    }
  }
  /// A mesh of patches from any of the levels.
  Mesh mixed(Random& random) const {
    std::vector<std::size_t> level(set.patch_count());
    for (std::size_t& of : level) of = random() % meshes.size();
    Mesh mesh;
    mesh.origin = meshes[0].origin;
    for (std::size_t l = 0; l < meshes.size(); ++l) {
      const Mesh& from = meshes[l];
      const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
      mesh.positions.insert(mesh.positions.end(), from.positions.begin(), from.positions.end());
      mesh.normals.insert(mesh.normals.end(), from.normals.begin(), from.normals.end());
      for (std::size_t t = 0; t < from.triangle_count(); ++t)
        if (level[from.patches[t]] == l)
          for (std::size_t c = 0; c < 3; ++c) mesh.indices.push_back(first + from.indices[3 * t + c]);
    }
    return mesh;
  }
};

TEST(DetailLevels, MixedLevelsHaveNoCracks) {
  Random random(1);
  for (const CertificateSet& chosen : certificate_sets()) {
    if (chosen.name == "size 1e6, at 1e7") continue;  // no tolerance of these is kept there
    const double size = set_of(chosen.patches).box().diagonal();
    const Levels levels(chosen.patches, {1e-3 * size, 1e-2 * size, 0.1 * size});
    const MeshReport fine = good(check(levels.meshes[0]));
    for (int turn = 0; turn < 2; ++turn) {
      const MeshReport report = good(check(levels.mixed(random)));
      EXPECT_EQ(report.open_edges, fine.open_edges) << chosen.name;
      EXPECT_EQ(report.t_junctions, fine.t_junctions) << chosen.name;
      EXPECT_EQ(report.non_manifold_edges, fine.non_manifold_edges) << chosen.name;
    }
  }
}

TEST(DetailLevels, EachKeepsItsToleranceWithFewerTriangles) {
  Random random(2);
  for (const bool is_body : {false, true}) {
    const std::vector<double> tolerances{1e-4, 1e-3, 1e-2, 0.1};
    const Levels levels(is_body ? closed_body() : wavy_field(6, 6), tolerances);
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (std::size_t l = 0; l < tolerances.size(); ++l) {
      const Tessellation& plan = levels.plans[l];
      EXPECT_LE(plan.bound(), tolerances[l]);
      EXPECT_TRUE(plan.patches_beyond_tolerance().empty());
      EXPECT_LE(plan.capacity().triangles, before);
      before = plan.capacity().triangles;
      const SampledMesh sampled(levels.meshes[l], levels.set.patch_count(), false);
      for (std::size_t k = 0; k < levels.set.patch_count(); ++k)
        for (int sample = 0; sample < 12; ++sample) {
          const auto& face = sampled.faces(k)[static_cast<std::size_t>(random() % sampled.faces(k).size())];
          double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
          if (a + b > 1) a = 1 - a, b = 1 - b;
          const Vec3 p = a * face.corners[0] + b * face.corners[1] + (1 - a - b) * face.corners[2];
          const double bound = double(plan.bounds()[k]);
          EXPECT_LE(distance_to_patch(levels.set.patch(k), p, bound), bound) << "level " << l << " patch " << k;
        }
    }
    EXPECT_LT(4 * levels.plans[2].capacity().triangles, levels.plans[0].capacity().triangles);
    // The finest level is a plain plan.
    const Mesh plain = mesh_of(levels.set, good(Tessellation::make(levels.set, {.tolerance = 1e-4})));
    EXPECT_EQ(plain.positions, levels.meshes[0].positions);
    EXPECT_EQ(plain.indices, levels.meshes[0].indices);
  }
}

TEST(DetailLevels, FollowEditsTogether) {
  Levels levels(wavy_field(5, 5), {1e-3, 2e-2});
  Random random(3);
  const std::vector<std::uint32_t> patches{7, 12};
  for (int turn = 0; turn < 5; ++turn) {
    std::vector<Vec3> points;
    for (const std::uint32_t patch : patches)
      for (const Vec3& p : levels.set.patch(patch).points()) points.push_back({p.x, p.y, p.z * (turn % 2 ? 0.7 : 1.5)});
    for (std::size_t l = 0; l < levels.plans.size(); ++l) {
      const PatchEdits edits = l == 0 ? PatchEdits{patches, points} : PatchEdits{};
      const MeshChange change = good(levels.plans[l].update(levels.set, edits, levels.meshes[l].views()));
      if (change.topology) levels.meshes[l] = mesh_of(levels.set, levels.plans[l]);
    }
    EXPECT_LE(levels.plans[1].bound(), 2e-2);
    const MeshReport fine = good(check(levels.meshes[0])), report = good(check(levels.mixed(random)));
    EXPECT_EQ(report.open_edges, fine.open_edges);
    EXPECT_EQ(report.t_junctions, fine.t_junctions);
  }
}

TEST(DetailLevels, WrongOnesAreRefused) {
  const PatchSet set = set_of(wavy_field(2, 2));
  const auto refused = [&](const TessellationOptions& options, const std::string& message) {
    const Status status = Tessellation::make(set, options).status();
    EXPECT_EQ(status.code(), StatusCode::invalid_argument) << status.message();
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
  };
  for (const double wrong : {0.0, -1.0, std::nan(""), 0.2})
    refused({.tolerance = 0.1, .border_tolerance = wrong}, "above 0 and at most the tolerance");
  refused({.border_tolerance = 0.1, .angle = 0.1}, "needs a tolerance");
  refused({.tolerance = 0.1, .border_tolerance = 0.1, .angle = 0.1}, "none of angle");
  refused({.tolerance = 0.1, .relative = true, .border_tolerance = 0.1}, "as a length");
  refused({.rates = UniformRates{2, 2}, .border_tolerance = 0.1}, "rates");
}

}}  // namespace tessera::test
