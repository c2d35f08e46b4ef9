// Faces of files without topology, joined and meshed.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/synthetic_sets.h"
#include "tessera/edge_matching.h"
#include "tessera/io.h"
#include "tessera/mesh.h"
#include "tessera/tessellation.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

// Trimmed faces without topology, whose edges CAD curves state to 1e-4: vertices that nearly coincide along an edge
// must not draw its ends together. Lines that close gaps in loops cross from patch to patch, and loops pass corners of
// patches within rounding.
TEST(JoinedFaces, OfAWingletLeaveNoOpenEdge) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const Model model = value_of(read_model(std::filesystem::path(data) / "g2_gotools" / "splipy_winglet_from_step.g2"));
  const Shape shape = value_of(joined_shape(model.surfaces, 1.4e-3));
  EXPECT_EQ(value_of(closed_shells(shape)), std::vector<bool>{true});
  const PatchSet set = value_of(make_patch_set(shape));
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance, .relative = true}));
    EXPECT_LT(plan.gap(), 2e-3) << tolerance;
    EXPECT_GT(plan.gap(), 1e-4) << tolerance;
    EXPECT_EQ(plan.open_edges(), 0u) << tolerance;
    Mesh mesh = value_of(plan.allocate());
    ASSERT_TRUE(plan.run(set, mesh.views()).ok());
    EXPECT_EQ(value_of(check(mesh)).open_edges, 0u) << tolerance;
  }
}

}}  // namespace tessera::test
