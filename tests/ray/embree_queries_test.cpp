// Hits of Embree completed in batches, and the calls of Embree that the geometry does not support.

#include <array>
#include <limits>
#include <vector>

#include "embree_world.h"
#include "support/torus.h"

namespace tessera::test { namespace {

/// Rays at a torus in the user's scene, with a triangle beside it, and what they hit.
struct Traced {
  Traced() {
    geometry = value_of(attach(scene, world.scene.get()));
    const Held<RTCGeometry> triangle(rtcNewGeometry(world.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    constexpr std::array<float, 9> corners{-9, -9, -2, 9, -9, -2, 0, 9, -2};
    constexpr std::array<unsigned, 3> indices{0, 1, 2};
    std::copy(corners.begin(), corners.end(),
              static_cast<float*>(
                  rtcSetNewGeometryBuffer(triangle.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3)));
    std::copy(indices.begin(), indices.end(),
              static_cast<unsigned*>(
                  rtcSetNewGeometryBuffer(triangle.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1)));
    rtcCommitGeometry(triangle.get());
    rtcAttachGeometry(world.scene.get(), triangle.get());
    rtcCommitScene(world.scene.get());
    Random random(101);
    for (int k = 0; k < 3000; ++k) {
      const Vec3 eye{uniform(random, -1.5, 1.5), uniform(random, -1.5, 1.5), 3};
      found.push_back(trace(world.scene.get(), ray(eye, {0, uniform(random, 0, 3), -1})));
    }
  }

  PatchSet set = set_of(Torus(8).patches(true));
  RayScene scene = value_of(RayScene::make(set));
  World world;
  unsigned geometry = 0;
  std::vector<RTCRayHit> found;
};

TEST(EmbreeHits, ABatchIsEachHitAlone) {
  const Traced traced;
  std::vector<Hit> hits(traced.found.size() + 1);
  hits.back().patch = 77;
  ASSERT_TRUE(resolve(traced.scene, traced.geometry, traced.found, hits).ok());
  std::size_t met = 0, triangles = 0, missed = 0;
  for (std::size_t k = 0; k < traced.found.size(); ++k) {
    const RTCRayHit& from = traced.found[k];
    missed += from.hit.geomID == nothing;
    triangles += from.hit.geomID != nothing && from.hit.geomID != traced.geometry;
    ASSERT_EQ(hits[k].kind == HitKind::hit, from.hit.geomID == traced.geometry);
    if (hits[k].kind != HitKind::hit) continue;
    ++met;
    const Hit alone = value_of(traced.scene.resolve(from.hit.primID, double{from.hit.u}, double{from.hit.v}));
    EXPECT_EQ(hits[k].position, alone.position);
    EXPECT_EQ(hits[k].normal, alone.normal);
    EXPECT_EQ(hits[k].patch, from.hit.primID);
    EXPECT_EQ(hits[k].t, double{from.ray.tfar});
    EXPECT_EQ(hits[k].instance, Hit::no_instance);
  }
  EXPECT_GT(std::min({met, triangles, missed}), 100u);
  EXPECT_EQ(hits.back().patch, 77u) << "written beyond the hits of Embree";
  EXPECT_TRUE(resolve(traced.scene, traced.geometry, {}, {}).ok());
}

TEST(EmbreeHits, InstancesAreNamed) {
  const Traced traced;
  std::vector<RTCRayHit> from = traced.found;
  for (RTCRayHit& hit : from) hit.hit.instID[0] = 5;
  std::vector<Hit> hits(from.size());
  ASSERT_TRUE(resolve(traced.scene, traced.geometry, from, hits).ok());
  for (const Hit& hit : hits) EXPECT_EQ(hit.instance, hit.kind == HitKind::hit ? 5u : Hit::no_instance);
}

TEST(EmbreeHits, BadHitsAreNamed) {
  Traced traced;
  std::vector<Hit> hits(traced.found.size());
  EXPECT_EQ(resolve(traced.scene, 0, traced.found, std::span(hits).first(9)).code(), StatusCode::buffer_too_small);
  std::vector<RTCRayHit> from = traced.found;
  for (const std::size_t k : {2000u, 700u}) {
    from[k].hit.geomID = traced.geometry, from[k].hit.primID = 64;
    const Status status = resolve(traced.scene, traced.geometry, from, hits);
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_EQ(status.index(), static_cast<std::ptrdiff_t>(k));
    EXPECT_EQ(hits[k].kind, HitKind::miss);
  }
  from[3].hit.geomID = traced.geometry, from[3].hit.primID = 0;
  from[3].hit.u = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(resolve(traced.scene, traced.geometry, from, hits).code(), StatusCode::non_finite);
  EXPECT_EQ(resolve(traced.scene, traced.geometry, from, hits).index(), 3);

  const RayInstance placed{&traced.scene, {}};
  const RayScene instances = value_of(RayScene::make({&placed, 1}));
  EXPECT_EQ(resolve(instances, traced.geometry, traced.found, hits).code(), StatusCode::unsupported);
  ASSERT_TRUE(traced.set.set_control_points(0, traced.set.patch(0).points()).ok());
  EXPECT_EQ(resolve(traced.scene, traced.geometry, traced.found, hits).code(), StatusCode::stale);
}

// Two time steps and three: the patches are the same at each, at any time of a ray.
TEST(EmbreeGeometry, PatchesStandStill) {
  const Traced traced;
  for (const unsigned steps : {1u, 2u, 3u}) {
    const World world;
    const unsigned geometry = value_of(attach(traced.scene, world.scene.get()));
    rtcSetGeometryTimeStepCount(rtcGetGeometry(world.scene.get(), geometry), steps);
    rtcCommitGeometry(rtcGetGeometry(world.scene.get(), geometry));
    rtcCommitScene(world.scene.get());
    EXPECT_EQ(rtcGetDeviceError(world.device.get()), RTC_ERROR_NONE);
    for (const float time : {0.0f, 0.3f, 1.0f}) {
      std::size_t differ = 0;
      for (const RTCRayHit& expected : traced.found) {
        if (expected.hit.geomID != traced.geometry) continue;
        RTCRayHit again = expected;
        again.ray.time = time, again.ray.tfar = std::numeric_limits<float>::infinity();
        again.hit.geomID = nothing;
        EmbreeContext context = embree_context();
        intersect(world.scene.get(), context, Coherence::incoherent, again);
        differ += again.hit.geomID == nothing || again.ray.tfar != expected.ray.tfar;
      }
      EXPECT_EQ(differ, 0u) << steps << " steps, time " << time;
    }
  }
}

bool count_query(RTCPointQueryFunctionArguments* arguments) {
  ++*static_cast<int*>(arguments->userPtr);
  return false;
}

TEST(EmbreeGeometry, PointQueriesFindNothing) {
  const Traced traced;
  RTCPointQuery query{};
  query.x = 1, query.z = 0.4f, query.radius = 0.5f;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  EXPECT_FALSE(rtcPointQuery(traced.world.scene.get(), &query, &context, nullptr, nullptr));
  EXPECT_EQ(query.radius, 0.5f);
  EXPECT_EQ(rtcGetDeviceError(traced.world.device.get()), RTC_ERROR_NONE);
  int calls = 0;
  rtcPointQuery(traced.world.scene.get(), &query, &context, &count_query, &calls);
  EXPECT_EQ(calls, 2) << "a function of the query itself is called for the triangle, and once for all patches";
}

}}  // namespace tessera::test
