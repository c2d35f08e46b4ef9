// Rays of the user's Embree scene that leave patches: no offset, no hit at the origin, no leak; bad origins do no harm.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "embree_world.h"

namespace tessera::test { namespace {

#if RTC_VERSION_MAJOR < 4
void query(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
void query(RTCScene scene, EmbreeContext& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
#else
void query(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
  intersect(scene, context, Coherence::incoherent, ray);
}
void query(RTCScene scene, EmbreeContext& context, RTCRay& ray) {
  occluded(scene, context, Coherence::incoherent, ray);
}
#endif

RTCRayHit trace_from(RTCScene scene, const EmbreeOrigin& origin, const Ray& ray) {
  RTCRayHit out = embree_ray(ray);
  EmbreeOriginContext context(origin);
  query(scene, context, out);
  return out;
}

bool is_occluded_from(RTCScene scene, const EmbreeOrigin& origin, const Ray& ray) {
  RTCRayHit out = embree_ray(ray);
  EmbreeOriginContext context(origin);
  query(scene, context, out.ray);
  return out.ray.tfar < 0;
}

/// A point of a patch as the origin of rays, in the geometry and the instance of a hit.
EmbreeOrigin origin_at(unsigned geometry, std::uint32_t patch, double u, double v, unsigned instance = nothing) {
  EmbreeOrigin origin;
  origin.geometry = geometry, origin.patch = patch, origin.u = u, origin.v = v, origin.instance[0] = instance;
  return origin;
}

/// The direction of a ray as Embree has it.
Vec3 direction_of(const RTCRayHit& ray) { return {ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z}; }

/// The hit of Tessera's own scene for a ray of Embree that leaves a point.
Hit expected_from(const RayScene& scene, const Vec3& at, const RTCRayHit& of) {
  Ray exact = ray(at, direction_of(of));
  exact.spawn_offset = scene.spawn_offset();
  return scene.closest(exact);
}

/// Parameters inside, on an edge, at a corner, and so near an edge that float cannot tell.
std::array<double, 2> place(Random& random, int kind) {
  const double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
  switch (kind % 5) {
    case 1:
      return {std::round(u), v};
    case 2:
      return {u, std::round(v)};
    case 3:
      return {std::round(u), std::round(v)};
    case 4:
      return {std::abs(std::round(u) - 1e-9), v};
    default:
      return {u, v};
  }
}

/// A scene of patches in the user's own.
struct Attached {
  explicit Attached(const std::vector<BezierPatch>& patches, const EmbreeGeometryOptions& options = {.origins = true})
      : set(set_of(patches)), scene(value_of(RayScene::make(set))) {
    geometry = value_of(attach(scene, world.scene.get(), options));
    rtcCommitScene(world.scene.get());
  }
  RTCScene in() const { return world.scene.get(); }

  PatchSet set;
  RayScene scene;
  World world;
  unsigned geometry = 0;
};

// Far from zero, float moves the origin by up to 4e-6, so it lies on either side of the surface.
TEST(EmbreeOrigin, LeavingASphereAtAnyAngle) {
  for (const Vec3& centre : {Vec3{}, Vec3{100, -30, 7}}) {
    const Attached ball(placed(sphere(), 1, centre));
    Random random(81);
    std::size_t plain_hits = 0;
    for (int k = 0; k < 2000; ++k) {
      const auto patch = static_cast<std::uint32_t>(random() % ball.set.patch_count());
      const auto [u, v] = place(random, k);
      const Hit from = value_of(ball.scene.resolve(patch, u, v));
      const Vec3 out = normalized(from.position - centre), along = normalized(cross(out, random_direction(random)));
      const double sine = std::pow(10, uniform(random, -5, 0)) * (k % 2 == 0 ? 1 : -1);
      const Ray leaves = ray(from.position, std::sqrt(1 - sine * sine) * along + sine * out);
      const EmbreeOrigin origin = origin_at(ball.geometry, patch, u, v);
      const RTCRayHit found = trace_from(ball.in(), origin, leaves);
      EXPECT_EQ(is_occluded_from(ball.in(), origin, leaves), found.hit.geomID != nothing) << k << " " << sine;
      const double rise = dot(normalized(direction_of(found)), out);  // float has turned the direction by 1e-7
      if (rise > 0) {
        EXPECT_EQ(found.hit.geomID, nothing) << k << " " << sine;
        if (k % 5 == 0) plain_hits += is_occluded(ball.in(), leaves);
      } else if (rise < -3e-5) {  // a flatter chord is no deeper than the tolerance
        ASSERT_NE(found.hit.geomID, nothing) << k << " " << sine;
        EXPECT_NEAR(found.ray.tfar, -2 * rise, 1e-6 - 1e-11 * (1 + max_abs(centre)) / rise) << k << " " << sine;
      }
    }
    EXPECT_GT(plain_hits, 30u) << "without origins, many rays meet the surface that they leave";
  }
}

// Rays leave the seams of a closed body, in all directions: they have the hits of the ray scene's own rays.
TEST(EmbreeOrigin, SeamsNeitherHitThemselvesNorLeak) {
  const Attached body(closed_body());
  Random random(82);
  std::size_t hits = 0, same = 0, plain = 0;
  for (int k = 0; k < 8000; ++k) {
    const auto patch = static_cast<std::uint32_t>(random() % body.set.patch_count());
    const auto [u, v] = place(random, k);
    const Hit from = value_of(body.scene.resolve(patch, u, v));
    const Ray leaves = ray(from.position, random_direction(random));
    const EmbreeOrigin origin = origin_at(body.geometry, patch, u, v);
    const RTCRayHit found = trace_from(body.in(), origin, leaves);
    const Hit expected = expected_from(body.scene, from.position, found);
    ASSERT_EQ(found.hit.geomID != nothing, expected.kind == HitKind::hit) << k;
    EXPECT_EQ(is_occluded_from(body.in(), origin, leaves), expected.kind == HitKind::hit) << k;
    if (expected.kind != HitKind::hit) continue;
    ++hits;
    // The origin's last digits may differ, and near the origin t has few more.
    same += std::abs(double{found.ray.tfar} - expected.t) <= 1e-7 * expected.t + 1e-12 &&
            found.hit.primID == expected.patch;
    plain += trace(body.in(), leaves).ray.tfar == found.ray.tfar;
  }
  EXPECT_GT(hits, 2000u);
  EXPECT_EQ(same, hits);
  EXPECT_LT(plain, hits - 200) << "without origins, many rays meet the surface that they leave";
}

// A hit of Embree names its own origin, in an instance as well; rays that another instance meets keep their origin.
TEST(EmbreeOrigin, InInstancesOfAHit) {
  const Attached ball(sphere());
  const World world;
  constexpr std::array<std::array<float, 12>, 2> maps{
      {{2, 0, 0, 0, 0.5f, 0, 0, 0, 1, 1000, 0, 0}, {1, 0, 0, 0, -1, 0, 0, 0, 1, 1000, 2.5f, 0}}};
  for (const auto& map : maps) {
    const Held<RTCGeometry> instance(rtcNewGeometry(world.device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance.get(), ball.in());
    rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, map.data());
    rtcCommitGeometry(instance.get());
    rtcAttachGeometry(world.scene.get(), instance.get());
  }
  rtcCommitScene(world.scene.get());
  Random random(83);
  std::size_t other = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 eye{1000 + uniform(random, -1.9, 1.9), uniform(random, -0.45, 0.45), 5};
    const RTCRayHit first = trace(world.scene.get(), ray(eye, {0, 0, -1}));
    if (first.hit.geomID == nothing) continue;
    ASSERT_EQ(first.hit.instID[0], 0u);
    const Vec3 at{eye.x, eye.y, eye.z - double{first.ray.tfar}};
    const Vec3 normal{(at.x - 1000) / 4, at.y * 4, at.z};
    const double steep = std::pow(10, uniform(random, -3, 0));
    const Vec3 along = normalized(cross(normal, random_direction(random)));
    const RTCRayHit out =
        trace_from(world.scene.get(), EmbreeOrigin(first.hit), ray(at, along + steep * normalized(normal)));
    EXPECT_TRUE(out.hit.geomID == nothing || out.hit.instID[0] == 1) << k << " " << steep;
    other += out.hit.geomID != nothing;
    const RTCRayHit down = trace_from(world.scene.get(), EmbreeOrigin(first.hit), ray(at, {0, 0, -1}));
    ASSERT_NE(down.hit.geomID, nothing) << k;
    EXPECT_NEAR(down.ray.tfar, 2 * at.z, 1e-3);
  }
  EXPECT_GT(other, 50u);
}

TEST(EmbreeOrigin, OfEachRayOfAPacket) {
  const Attached ball(sphere());
  Random random(84);
  for (int turn = 0; turn < 200; ++turn) {
    RTCRayHit16 packet{};
    alignas(64) std::array<int, 16> valid;
    std::array<EmbreeOrigin, 16> origins;
    for (unsigned k = 0; k < 16; ++k) {
      const auto patch = static_cast<std::uint32_t>(random() % ball.set.patch_count());
      const auto [u, v] = place(random, static_cast<int>(k));
      origins[k] = origin_at(ball.geometry, patch, u, v);
      const Hit from = value_of(ball.scene.resolve(patch, u, v));
      const RTCRayHit one = embree_ray(ray(from.position, from.position + 0.9 * random_direction(random)));
      valid[k] = -1;
      RTCRay16& rays = packet.ray;
      rays.org_x[k] = one.ray.org_x, rays.org_y[k] = one.ray.org_y, rays.org_z[k] = one.ray.org_z;
      rays.dir_x[k] = one.ray.dir_x, rays.dir_y[k] = one.ray.dir_y, rays.dir_z[k] = one.ray.dir_z;
      rays.tfar[k] = one.ray.tfar, rays.mask[k] = ~0u, rays.id[k] = k;
      packet.hit.geomID[k] = packet.hit.instID[0][k] = nothing;
    }
    EmbreeOriginContext context(origins);
#if RTC_VERSION_MAJOR < 4
    context.set_coherent(turn % 2 == 0);
    rtcIntersect16(valid.data(), ball.in(), &context, &packet);
#else
    intersect(ball.in(), context, Coherence::coherent, valid.data(), packet);
#endif
    for (unsigned k = 0; k < 16; ++k) EXPECT_EQ(packet.hit.geomID[k], nothing) << "ray " << k << " went outwards";
  }
}

/// Origins that name no point of a patch of the geometry.
std::vector<EmbreeOrigin> bad_origins(const Attached& ball) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  std::vector<EmbreeOrigin> bad(2);
  bad[1] = EmbreeOrigin(embree_ray({}).hit);  // a miss
  const auto patches = static_cast<unsigned>(ball.set.patch_count());
  for (const unsigned patch : {patches, nothing}) bad.push_back(origin_at(ball.geometry, patch, 0.5, 0.5));
  for (const double u : {nan, inf, -inf, -1e-9, 1 + 1e-9, 1e300}) {
    bad.push_back(origin_at(ball.geometry, 0, u, 0.5));
    bad.push_back(origin_at(ball.geometry, 0, 0.5, u));
  }
  bad.push_back(origin_at(ball.geometry + 1, 0, 0.5, 0.5));
  bad.push_back(origin_at(ball.geometry, 0, 0.5, 0.5, 3));
  return bad;
}

TEST(EmbreeOrigin, BadOriginsAreIgnored) {
  const Attached ball(sphere());
  const Ray down = ray({0.125, 0.25, 3}, {0, 0, -1});
  const float expected = trace(ball.in(), down).ray.tfar;
  for (const EmbreeOrigin& bad : bad_origins(ball)) {
    EXPECT_EQ(trace_from(ball.in(), bad, down).ray.tfar, expected) << bad.patch << " " << bad.u << " " << bad.v;
    EXPECT_TRUE(is_occluded_from(ball.in(), bad, down));
  }
  EmbreeOriginContext none;
  RTCRayHit one = embree_ray(down);
  query(ball.in(), none, one);
  EXPECT_EQ(one.ray.tfar, expected);
  const std::vector<EmbreeOrigin> two(2, origin_at(ball.geometry, 0, 0.5, 0.5));
  EmbreeOriginContext others(two);
  one = embree_ray(down);
  one.ray.id = 2;  // beyond the origins
  query(ball.in(), others, one);
  EXPECT_EQ(one.ray.tfar, expected);
}

#if RTC_VERSION_MAJOR < 4
/// A plain context whose neighbours in memory look like origins.
struct Surrounded {
  RTCIntersectContext context;
  std::array<std::uintptr_t, 8> behind;
};

TEST(EmbreeOrigin, PlainContextsAreNotRead) {
  for (const bool origins : {false, true}) {
    const Attached ball(sphere(), {.origins = origins});
    const Ray down = ray({0.125, 0.25, 3}, {0, 0, -1});
    for (const RTCIntersectContextFlags flags :
         {RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT, RTC_INTERSECT_CONTEXT_FLAG_COHERENT}) {
      Surrounded plain;
      plain.behind.fill(1);  // a pointer to nowhere, and a count of one
      rtcInitIntersectContext(&plain.context);
      plain.context.flags = flags;
      RTCRayHit one = embree_ray(down);
      rtcIntersect1(ball.in(), &plain.context, &one);
      EXPECT_NEAR(one.ray.tfar, 3 - std::sqrt(1 - 0.125 * 0.125 - 0.25 * 0.25), 1e-6);
      one = embree_ray(down);
      rtcOccluded1(ball.in(), &plain.context, &one.ray);
      EXPECT_LT(one.ray.tfar, 0);
    }
  }
}
#endif

// A user's context may go on behind Tessera's, and the filters of the geometry see it.
struct Counting : EmbreeOriginContext {
  using EmbreeOriginContext::EmbreeOriginContext;
  int roots = 0;
};

TEST(EmbreeOrigin, FiltersSeeTheUsersContext) {
  const Attached ball(sphere());
  const RTCGeometry geometry = rtcGetGeometry(ball.in(), ball.geometry);
  rtcSetGeometryIntersectFilterFunction(geometry, [](const RTCFilterFunctionNArguments* arguments) {
    ++static_cast<Counting*>(arguments->context)->roots;
    arguments->valid[0] = 0;
  });
  rtcCommitGeometry(geometry);
  rtcCommitScene(ball.in());
  const Hit from = value_of(ball.scene.resolve(0, 0.3, 0.4));
  const EmbreeOrigin origin = origin_at(ball.geometry, 0, 0.3, 0.4);
  Counting context(origin);
  RTCRayHit inwards = embree_ray(ray(from.position, -from.position));
  query(ball.in(), context, inwards);
  EXPECT_EQ(inwards.hit.geomID, nothing);
  EXPECT_EQ(context.roots, 1) << "the root at the origin is none";
}

}}  // namespace tessera::test
