// Tables that the plans of a set share.

#include "tess/write/mesh_tables.h"

#include <cmath>
#include <memory>

#include "base/impl_access.h"
#include "support/synthetic_sets.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

Tessellation mesh_tables_plan_of(const PatchSet& set, double tolerance) {
  return good(Tessellation::make(set, {.tolerance = tolerance}));
}
const MeshTables& tables_of(const Tessellation& plan) { return proven_mesh_of(plan).tables(); }

TEST(MeshTables, PlansThatNeedTheSameShareThem) {
  const PatchSet body = set_of(closed_body()), ball = set_of(sphere());
  const Tessellation before = mesh_tables_plan_of(body, 0.01), coarse = mesh_tables_plan_of(body, 0.02),
                     after = mesh_tables_plan_of(body, 0.01), other = mesh_tables_plan_of(ball, 0.01);
  EXPECT_EQ(&tables_of(after), &tables_of(coarse));  // to which the coarse ones were added
  EXPECT_NE(&tables_of(after), &tables_of(other));
}

TEST(MeshTables, PlansOutliveTheSet) {
  auto first = std::make_unique<PatchSet>(set_of(closed_body()));
  const Tessellation plan = mesh_tables_plan_of(*first, 0.01);
  const std::size_t bytes = tables_of(plan).bytes();
  first.reset();
  EXPECT_EQ(tables_of(plan).bytes(), bytes);
  Mesh mesh = good(plan.allocate());
  EXPECT_EQ(plan.run(set_of(closed_body()), mesh.views()).code(), StatusCode::stale);
}

TEST(MeshTables, LargeOnesAreOfTheirPlanAlone) {
  const PatchSet body = set_of(closed_body());
  const Tessellation large = mesh_tables_plan_of(body, 1.5e-6), next = mesh_tables_plan_of(body, 0.01);
  EXPECT_GT(tables_of(large).bytes(), MeshTables::max_common_bytes);
  EXPECT_LE(tables_of(next).bytes(), MeshTables::max_common_bytes);
}

TEST(MeshTables, CommonOnesStaySmall) {
  const PatchSet body = set_of(closed_body());
  std::size_t largest = 0, times_anew = 0, last = 0;
  for (int step = 0; step < 300; ++step) {
    (void)mesh_tables_plan_of(body, 0.3 * std::pow(0.97, step));
    const Tessellation plan = mesh_tables_plan_of(body, 0.01);
    const std::size_t bytes = tables_of(plan).bytes();
    EXPECT_LE(bytes, MeshTables::max_common_bytes);
    times_anew += bytes < last;
    last = bytes;
    largest = std::max(largest, bytes);
  }
  EXPECT_GT(largest, MeshTables::max_common_bytes / 2);
  EXPECT_GT(times_anew, 0u);
}

TEST(MeshTables, MeshesAreTheSameWhateverCameBefore) {
  const auto meshes = [](int first) {
    std::vector<Mesh> all(12);
    for (int n = 0; n < 12; ++n) {
      const int k = (first + 5 * n) % 12;
      const PatchSet set = set_of(mixed_patches(static_cast<std::uint64_t>(k), 20));
      all[static_cast<std::size_t>(k)] = mesh_of(set, mesh_tables_plan_of(set, k % 2 == 0 ? 0.1 : 0.01));
    }
    return all;
  };
  const std::vector<Mesh> a = meshes(0), b = meshes(7);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].positions, b[k].positions);
    EXPECT_EQ(a[k].normals, b[k].normals);
    EXPECT_EQ(a[k].indices, b[k].indices);
  }
}

}}  // namespace tessera::test
