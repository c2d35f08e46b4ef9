// Tables that plans share.

#include "tess/write/mesh_tables.h"

#include "base/impl_access.h"
#include "support/synthetic_sets.h"
#include "tess/plan/certified_tessellation_impl.h"
#include "tess/tessellate_support.h"

namespace tessera::test {
namespace {

CertifiedTessellation plan_of(const PatchSet& set, double tolerance) {
  return good(CertifiedTessellation::make(set, {.tolerance = tolerance}));
}
const MeshTables& tables_of(const CertifiedTessellation& plan) { return impl_of(plan).tables(); }

TEST(MeshTables, PlansThatNeedTheSameShareThem) {
  const PatchSet body = set_of(closed_body()), ball = set_of(sphere());
  const CertifiedTessellation before = plan_of(body, 0.01), between = plan_of(ball, 0.01), after = plan_of(body, 0.01),
                              again = plan_of(ball, 0.01);
  EXPECT_EQ(&tables_of(after), &tables_of(again));
  EXPECT_EQ(&tables_of(after), &tables_of(between));  // to which the ball's were added
}

TEST(MeshTables, LargeOnesAreOfTheirPlanAlone) {
  const PatchSet body = set_of(closed_body());
  const CertifiedTessellation large = plan_of(body, 3e-6), next = plan_of(body, 0.01);
  EXPECT_GT(tables_of(large).bytes(), MeshTables::max_common_bytes);
  EXPECT_LE(tables_of(next).bytes(), MeshTables::max_common_bytes);
}

TEST(MeshTables, CommonOnesStaySmall) {
  const PatchSet body = set_of(closed_body());
  std::size_t most = 0, times_anew = 0, last = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    for (const double tolerance : {0.3, 0.03, 0.01}) (void)plan_of(set_of(mixed_patches(seed, 6)), tolerance);
    const CertifiedTessellation plan = plan_of(body, 0.01);
    const std::size_t bytes = tables_of(plan).bytes();
    EXPECT_LE(bytes, MeshTables::max_common_bytes);
    times_anew += bytes < last;
    last = bytes;
    most = std::max(most, bytes);
  }
  EXPECT_GT(most, MeshTables::max_common_bytes / 2);
  EXPECT_GT(times_anew, 0u);
}

TEST(MeshTables, MeshesAreTheSameWhateverCameBefore) {
  const auto meshes = [](int first) {
    std::vector<Mesh> all(12);
    for (int n = 0; n < 12; ++n) {
      const int k = (first + 5 * n) % 12;
      const PatchSet set = set_of(mixed_patches(static_cast<std::uint64_t>(k), 20));
      all[static_cast<std::size_t>(k)] = mesh_of(set, plan_of(set, k % 2 == 0 ? 0.1 : 0.01));
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

}  // namespace
}  // namespace tessera::test
