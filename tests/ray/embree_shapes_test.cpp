// Shapes and trimmed faces in the user's own Embree scene.

#include "embree_world.h"
#include "ray/frayed_scene.h"
#include "tess_trim/trimmed_face.h"
#include "tessera/ray_embree.h"

namespace tessera::test { namespace {

// Its box is that of what loops keep.
TEST(EmbreeShapes, BoxesAreThoseOfTheKeptPart) {
  const Face face(plane(), {circle_loop(3.2, 2.3, 0.02, false)});
  const RayScene scene = value_of(RayScene::make(face.set));
  const World world;
  ASSERT_TRUE(attach(scene, world.scene.get()));
  rtcCommitScene(world.scene.get());
  RTCBounds bounds;
  rtcGetSceneBounds(world.scene.get(), &bounds);
  EXPECT_NEAR(bounds.lower_x, 3.2, 0.03);
  EXPECT_NEAR(bounds.upper_y, 2.3, 0.03);
}

// A scene of the user's own sees edges as well. Its rays are in float.
TEST(EmbreeShapes, EdgesAreMet) {
  const Frayed cube;
  const World world;
  ASSERT_TRUE(attach(cube.scene, world.scene.get()));
  rtcCommitScene(world.scene.get());
  std::size_t seams = 0, differ = 0;
  for (const Ray& given : cube.at_edges(2000, 4)) {
    const Ray at = in_float(given);
    const RTCRayHit found = trace(world.scene.get(), at);
    const Hit hit = cube.scene.closest(at);
    ASSERT_EQ(found.hit.geomID != nothing, hit.kind == HitKind::hit);
    if (hit.kind != HitKind::hit) continue;
    seams += hit.flags.edge;
    EXPECT_NEAR(found.ray.tfar, hit.t, 1e-6);
    differ += found.hit.primID != hit.patch;
  }
  EXPECT_GT(seams, 200u);
  EXPECT_LE(differ, seams / 20);  // where two patches are met at one t in float
}

}}  // namespace tessera::test
