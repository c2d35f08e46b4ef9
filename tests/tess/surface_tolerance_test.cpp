// Surfaces with tolerances of their own in one set: each keeps its own, and where they meet there are no cracks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/sampled_distance.h"
#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

/// A field of which each column is a surface.
PatchSet columns(const std::vector<BezierPatch>& patches, std::size_t per_surface) {
  std::vector<PatchSource> sources;
  for (std::size_t k = 0; k < patches.size(); ++k)
    sources.push_back({.surface = static_cast<std::uint32_t>(k / per_surface)});
  return good(PatchSet::make(patches, PatchSetOptions{.sources = sources}));
}

TEST(SurfaceTolerances, EachSurfaceKeepsItsOwnWithoutCracks) {
  const PatchSet set = columns(wavy_field(6, 6), 6);
  const std::vector<double> tolerances{1e-4, 1e-2, 1e-3, 0.1, 3e-5, 0.05};
  for (TessellationOptions options :
       {TessellationOptions{}, {.angle = 0.3}, {.joining = {.crease_angle = 0.1, .share_vertices = true}}}) {
    options.surface_tolerances = tolerances;
    const Tessellation plan = good(Tessellation::make(set, options));
    EXPECT_EQ(plan.tolerance(), 0.1);
    EXPECT_TRUE(plan.patches_beyond_tolerance().empty());
    const Mesh mesh = mesh_of(set, plan);
    EXPECT_EQ(good(check(mesh)).open_edges, plan.open_edges());
    const SampledMesh sampled(mesh, set.patch_count(), false);
    Random random(1);
    std::vector<std::size_t> triangles(tolerances.size(), 0);
    for (const std::uint32_t patch : mesh.patches) ++triangles[patch / 6];
    for (std::size_t k = 0; k < set.patch_count(); ++k) {
      const double tolerance = tolerances[k / 6];
      EXPECT_LE(double(plan.bounds()[k]), tolerance * (1 + 1e-7));
      const auto& face = sampled.faces(k)[static_cast<std::size_t>(random() % sampled.faces(k).size())];
      const Vec3 middle = (1.0 / 3) * (face.corners[0] + face.corners[1] + face.corners[2]);
      EXPECT_LE(distance_to_patch(set.patch(k), middle, tolerance), tolerance);
    }
    EXPECT_GT(triangles[4], 10 * triangles[3]);
    // The finest tolerance everywhere takes many more.
    TessellationOptions fine = options;
    fine.surface_tolerances.clear(), fine.tolerance = 3e-5;
    EXPECT_GT(good(Tessellation::make(set, fine)).capacity().triangles, 2 * plan.capacity().triangles);
  }
}

TEST(SurfaceTolerances, EqualOnesAreATolerance) {
  const PatchSet set = columns(wavy_field(4, 4), 8);
  const Mesh one = mesh_of(set, good(Tessellation::make(set, {.tolerance = 0.01})));
  const Mesh same = mesh_of(set, good(Tessellation::make(set, {.surface_tolerances = {0.01, 0.01}})));
  EXPECT_EQ(one.positions, same.positions);
  EXPECT_EQ(one.indices, same.indices);
  const double size = set.model_box().diagonal();
  const Tessellation part =
      good(Tessellation::make(set, {.surface_tolerances = {0.01 / size, 0.001 / size}, .relative = true}));
  EXPECT_NEAR(part.tolerance(), 0.01, 1e-12);
  EXPECT_LE(part.bounds()[15], 0.001f * (1 + 1e-6f));
}

TEST(SurfaceTolerances, EditsKeepThem) {
  PatchSet set = columns(wavy_field(6, 6), 18);
  Tessellation plan = good(Tessellation::make(set, {.surface_tolerances = {1e-4, 1e-2}}));
  Mesh mesh = mesh_of(set, plan);
  for (int frame = 1; frame <= 8; ++frame) {
    std::vector<std::uint32_t> patches{20, 3, 17, 18};
    std::vector<Vec3> points;
    for (const std::uint32_t patch : patches)
      for (const Vec3& p : set.patch(patch).points()) points.push_back({p.x, p.y, p.z * (frame % 2 == 0 ? 1.3 : 0.7)});
    const MeshChange change = good(plan.update(set, PatchEdits{patches, points}, mesh.views()));
    if (change.topology) mesh = mesh_of(set, plan);
    for (std::size_t k = 0; k < set.patch_count(); ++k)
      EXPECT_LE(double(plan.bounds()[k]), (k < 18 ? 1e-4 : 1e-2) * (1 + 1e-7)) << "frame " << frame << " patch " << k;
  }
}

TEST(SurfaceTolerances, WrongOnesAreRefused) {
  const PatchSet set = columns(wavy_field(2, 2), 2);
  const auto refused = [&](const TessellationOptions& options, StatusCode code, std::ptrdiff_t index,
                           const std::string& message) {
    const Status status = Tessellation::make(set, options).status();
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.index(), index);
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
  };
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    refused({.surface_tolerances = {0.1, wrong}}, StatusCode::invalid_argument, 1, "the tolerance of surface 1 is ");
  refused({.surface_tolerances = {0.1}}, StatusCode::count_mismatch, -1,
          "the set has 2 surfaces, found 1 surface tolerance");
  refused({.tolerance = 0.1, .surface_tolerances = {0.1, 0.1}}, StatusCode::invalid_argument, -1,
          "both surface tolerances and a tolerance");
  refused({.surface_tolerances = {0.1, 0.1}, .budget = 100}, StatusCode::invalid_argument, -1,
          "both surface tolerances and a budget");
  refused({.rates = UniformRates{2, 2}, .surface_tolerances = {0.1, 0.1}}, StatusCode::invalid_argument, -1, "rates");
  // A tolerance below what floats keep names the smallest that the patch keeps.
  refused({.surface_tolerances = {1e-12, 1e-12}}, StatusCode::invalid_argument, 0, "the tolerance 1e-12 must be above");
}

}}  // namespace tessera::test
