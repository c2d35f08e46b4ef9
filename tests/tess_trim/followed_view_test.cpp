// Plans of shapes follow a camera: the mesh stays closed, and keeps the pixels of each view.

#include <gtest/gtest.h>

#include "tess_trim/closed_shape.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

TEST(FollowedView, MeshesOfShapesStayClosed) {
  PatchSet set = value_of(make_patch_set(joined(drilled_plate(), 1e-6)));
  for (const bool shares : {false, true}) {
    TessellationOptions options{.pixels = PixelTolerance{0.5, {}}, .joining = {.share_vertices = shares}};
    options.pixels->view.eye = {9, -7, 6}, options.pixels->view.target = {2, 1.5, 0.5};
    Tessellation plan = value_of(Tessellation::make(set, options));
    Mesh mesh = value_of(plan.allocate());
    ASSERT_TRUE(plan.run(set, mesh.views()).ok());
    const std::size_t far = plan.capacity().triangles;
    for (const double distance : {1.0, 0.5, 0.3, 0.7}) {
      View view = options.pixels->view;
      view.eye = view.target + distance * (view.eye - view.target);
      ASSERT_TRUE(plan.set_view(view).ok());
      const auto change = plan.update(set, mesh.views());
      ASSERT_TRUE(change.ok()) << change.status().message();
      EXPECT_EQ(change->topology, distance < 1);
      if (change->topology) {
        mesh = value_of(plan.allocate());
        ASSERT_TRUE(plan.run(set, mesh.views()).ok());
      }
      EXPECT_LE(plan.pixels(), 0.5);
      EXPECT_TRUE(value_of(check(mesh)).closed()) << distance;
      EXPECT_TRUE(distance == 1 || plan.capacity().triangles > far);
    }
  }
}

}}  // namespace tessera::test
