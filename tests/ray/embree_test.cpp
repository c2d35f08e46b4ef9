// Patches in the user's own Embree scene: the same hits; masks, instances and filters have their effect; edits.

#include "tessera/ray_embree.h"

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "embree_world.h"
#include "ray_support.h"
#include "support/torus.h"

namespace tessera::test { namespace {

std::vector<Ray> rays_at_torus(std::size_t count) {
  Random random(51);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 origin = 3.0 * normalized(random_direction(random)), at = uniform_vector(random, -1.2, 1.2);
    rays.push_back(in_float(ray(origin, Vec3{at.x, at.y, 0.3 * at.z} - origin)));
  }
  return rays;
}

void expect_same(const RTCRay& ray, const RTCHit& hit, const Hit& expected) {
  ASSERT_EQ(hit.geomID != nothing, expected.kind == HitKind::hit);
  if (hit.geomID == nothing) return;
  EXPECT_EQ(hit.primID, expected.patch);
  EXPECT_EQ(ray.tfar, static_cast<float>(expected.t));
  EXPECT_NEAR(hit.u, expected.patch_u, 1e-7);
  EXPECT_NEAR(hit.v, expected.patch_v, 1e-7);
  EXPECT_LT(length(Vec3{hit.Ng_x, hit.Ng_y, hit.Ng_z} - expected.normal), 1e-6);
}

TEST(EmbreeGeometry, SameHitsAsTheRayScene) {
  for (const bool editable : {false, true}) {
    const PatchSet set = set_of(Torus(8).patches(editable));
    const RayScene scene = value_of(RayScene::make(set, {.editable = editable}));
    const World world;
    EXPECT_EQ(value_of(attach(scene, world.scene.get())), 0u);
    rtcCommitScene(world.scene.get());
    const std::vector<Ray> rays = rays_at_torus(4000);
    const std::vector<Hit> expected = closest(scene, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const RTCRayHit one = trace(world.scene.get(), rays[k]);
      expect_same(one.ray, one.hit, expected[k]);
      EXPECT_EQ(is_occluded(world.scene.get(), rays[k]), expected[k].kind == HitKind::hit);
    }
  }
}

/// 16 rays, of which each fifth is inactive.
struct Packet {
  RTCRayHit16 rays;
  alignas(64) std::array<int, 16> valid;

  explicit Packet(std::span<const Ray> from) {
    for (unsigned k = 0; k < 16; ++k) {
      const RTCRayHit one = embree_ray(from[k]);
      RTCRay16& ray = rays.ray;
      valid[k] = k % 5 == 4 ? 0 : -1;
      ray.org_x[k] = one.ray.org_x, ray.org_y[k] = one.ray.org_y, ray.org_z[k] = one.ray.org_z;
      ray.dir_x[k] = one.ray.dir_x, ray.dir_y[k] = one.ray.dir_y, ray.dir_z[k] = one.ray.dir_z;
      ray.tnear[k] = 0, ray.tfar[k] = one.ray.tfar, ray.time[k] = 0, ray.mask[k] = ~0u;
      ray.id[k] = k, ray.flags[k] = 0;
      rtcCopyHitToHitN(hits(), &one.hit, 16, k);
    }
  }
  RTCRay ray(unsigned k) { return rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&rays.ray), 16, k); }
  RTCHit hit(unsigned k) { return rtcGetHitFromHitN(hits(), 16, k); }

 private:
  RTCHitN* hits() { return reinterpret_cast<RTCHitN*>(&rays.hit); }
};

/// Embree's own instruction sets that this machine has, the narrowest first.
std::vector<std::string> embree_isas() {
  std::vector<std::string> isas;
  for (const Isa isa : available_isas()) isas.emplace_back(name(isa));
  return isas;
}

TEST(EmbreeGeometry, Packets) {
  const PatchSet set = set_of(Torus(8).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  const std::vector<Ray> rays = rays_at_torus(1600);
  const std::vector<Hit> expected = closest(scene, rays);
  for (const std::string& isa : embree_isas()) {
    SCOPED_TRACE(isa);
    const World world(",isa=" + isa);
    (void)value_of(attach(scene, world.scene.get()));
    rtcCommitScene(world.scene.get());
    for (std::size_t first = 0; first < rays.size(); first += 16) {
      Packet packet{std::span(rays).subspan(first, 16)};
      RTCRay16 shadows = packet.rays.ray;
      EmbreeContext context = embree_context();
      intersect(world.scene.get(), context, Coherence::coherent, packet.valid.data(), packet.rays);
      occluded(world.scene.get(), context, Coherence::coherent, packet.valid.data(), shadows);
      for (unsigned k = 0; k < 16; ++k) {
        if (packet.valid[k] == 0) {
          EXPECT_EQ(packet.hit(k).geomID, nothing);
          EXPECT_GE(shadows.tfar[k], 0) << "an inactive lane was traced";
          continue;
        }
        expect_same(packet.ray(k), packet.hit(k), expected[first + k]);
        EXPECT_EQ(shadows.tfar[k] < 0, expected[first + k].kind == HitKind::hit);
      }
    }
  }
}

TEST(EmbreeGeometry, NothingLeavesAClosedBody) {
  const PatchSet set = set_of(closed_body());
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  (void)value_of(attach(scene, world.scene.get()));
  rtcCommitScene(world.scene.get());
  Random random(52);
  std::size_t missed = 0;
  for (int k = 0; k < 50000; ++k) {
    const Vec3 origin = 0.3 * random_direction(random);
    const BezierPatch patch = set.patch(random() % set.patch_count());
    const Vec3 border = de_casteljau(patch, k % 2, uniform(random, 0, 1));
    const Ray out = in_float(ray(origin, k % 3 == 0 ? random_direction(random) : border - origin));
    missed += trace(world.scene.get(), out).hit.geomID == nothing;
  }
  EXPECT_EQ(missed, 0u);
}

TEST(EmbreeGeometry, EndsOfTheRayAndBadRays) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  (void)value_of(attach(scene, world.scene.get()));
  rtcCommitScene(world.scene.get());
  Ray down = ray({0.125, 0.25, 3}, {0, 0, -1});
  const float first = trace(world.scene.get(), down).ray.tfar;
  down.tnear = first + 1e-3f;
  const float second = trace(world.scene.get(), down).ray.tfar;
  EXPECT_NEAR(6 - first, second, 1e-6);
  down.tfar = second - 1e-3f;
  EXPECT_EQ(trace(world.scene.get(), down).hit.geomID, nothing);
  EXPECT_FALSE(is_occluded(world.scene.get(), down));
}

TEST(EmbreeGeometry, Masks) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  const unsigned id = value_of(attach(scene, world.scene.get()));
  const RTCGeometry geometry = rtcGetGeometry(world.scene.get(), id);
  for (const unsigned mask : {0u, 1u, 6u, ~0u}) {
    rtcSetGeometryMask(geometry, mask);
    rtcCommitGeometry(geometry);
    rtcCommitScene(world.scene.get());
    for (const unsigned of_ray : {0u, 2u, 8u}) {
      RTCRayHit one = embree_ray(ray({0.1, 0.2, 3}, {0, 0, -1}));
      one.ray.mask = of_ray;
      EmbreeContext context = embree_context();
      intersect(world.scene.get(), context, Coherence::incoherent, one);
      EXPECT_EQ(one.hit.geomID != nothing, (mask & of_ray) != 0) << mask << " " << of_ray;
    }
  }
}

/// The values that a filter sees of its context, which the user has extended.
struct Log {
  EmbreeContext context;  // first: one points to the other
  std::vector<float> t;
  std::size_t to_reject = 0;  ///< of the first ones
};

void reject_first(const RTCFilterFunctionNArguments* arguments) {
  Log& log = *reinterpret_cast<Log*>(arguments->context);
  for (unsigned k = 0; k < arguments->N; ++k) {
    if (arguments->valid[k] == 0) continue;
    EXPECT_EQ(RTCHitN_geomID(arguments->hit, arguments->N, k), 0u);
    log.t.push_back(RTCRayN_tfar(arguments->ray, arguments->N, k));
    if (log.t.size() <= log.to_reject) arguments->valid[k] = 0;
  }
}

TEST(EmbreeGeometry, FiltersSeeEachRootUntilOneIsAccepted) {
  // One patch that folds back twice over (x, y): three roots in a leaf or several.
  std::vector<Vec3> points;
  const double z[4] = {0, 4, -3, 1}, x[4] = {0, 2, 1, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) points.push_back({x[i], static_cast<double>(j), z[i]});
  }
  const PatchSet set = set_of({polynomial(3, 3, points)});
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  const unsigned id = value_of(attach(scene, world.scene.get()));
  const RTCGeometry geometry = rtcGetGeometry(world.scene.get(), id);
  rtcSetGeometryIntersectFilterFunction(geometry, &reject_first);
  rtcSetGeometryOccludedFilterFunction(geometry, &reject_first);
  rtcCommitGeometry(geometry);
  rtcCommitScene(world.scene.get());
  const Ray across = in_float(ray({-2, 1.3, 0.55}, {1, 0, 0}));
  HitLists lists;
  ASSERT_TRUE(scene.all({&across, 1}, lists).ok());
  ASSERT_EQ(lists.hits.size(), 3u);
  for (std::size_t rejected = 0; rejected <= 4; ++rejected) {
    Log log{embree_context(), {}, rejected};
    RTCRayHit one = embree_ray(across);
    intersect(world.scene.get(), log.context, Coherence::incoherent, one);
    ASSERT_EQ(log.t.size(), std::min<std::size_t>(rejected + 1, 3)) << rejected;
    for (std::size_t k = 0; k < log.t.size(); ++k) EXPECT_EQ(log.t[k], static_cast<float>(lists.hits[k].t));
    EXPECT_EQ(one.hit.geomID != nothing, rejected < 3);
    if (rejected < 3) {
      EXPECT_EQ(one.ray.tfar, static_cast<float>(lists.hits[rejected].t));
    } else {
      EXPECT_EQ(one.ray.tfar, std::numeric_limits<float>::infinity());
    }

    Log shadow{embree_context(), {}, rejected};
    one = embree_ray(across);
    occluded(world.scene.get(), shadow.context, Coherence::incoherent, one.ray);
    EXPECT_EQ(one.ray.tfar < 0, rejected < 3);
  }
}

#if RTC_VERSION_MAJOR < 4
TEST(EmbreeGeometry, FilterOfTheContext) {
  const PatchSet set = set_of(sphere());
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  rtcSetSceneFlags(world.scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  (void)value_of(attach(scene, world.scene.get()));
  rtcCommitScene(world.scene.get());
  for (const std::size_t rejected : {0u, 1u, 9u}) {
    Log log{embree_context(), {}, rejected};
    log.context.filter = &reject_first;
    RTCRayHit one = embree_ray(ray({0.1, 0.2, 3}, {0, 0, -1}));
    rtcIntersect1(world.scene.get(), &log.context, &one);
    EXPECT_EQ(one.hit.geomID != nothing, rejected < 2);
    EXPECT_EQ(log.t.size(), rejected == 0 ? 1u : 2u);
  }
}
#endif

/// A map as Embree has it: three columns, and the translation.
using ColumnMap = std::array<float, 12>;

void add_instances(const World& world, RTCScene scene, std::span<const ColumnMap> maps) {
  for (const auto& map : maps) {
    const Held<RTCGeometry> instance(rtcNewGeometry(world.device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance.get(), scene);
    rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, map.data());
    rtcCommitGeometry(instance.get());
    rtcAttachGeometry(world.scene.get(), instance.get());
  }
}

/// Adds a floor of two triangles at z = -2, and returns its id.
unsigned add_floor(const World& world) {
  const Held<RTCGeometry> floor(rtcNewGeometry(world.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  const std::array<float, 12> corners{-9, -9, -2, 9, -9, -2, 9, 9, -2, -9, 9, -2};
  const std::array<unsigned, 6> indices{0, 1, 2, 0, 2, 3};
  std::copy(
      corners.begin(), corners.end(),
      static_cast<float*>(rtcSetNewGeometryBuffer(floor.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4)));
  std::copy(
      indices.begin(), indices.end(),
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(floor.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 2)));
  rtcCommitGeometry(floor.get());
  return rtcAttachGeometry(world.scene.get(), floor.get());
}

TEST(EmbreeGeometry, InstancesBesideTriangles) {
  const PatchSet set = set_of(Torus(8).patches(false));
  const RayScene scene = value_of(RayScene::make(set));
  const World world;
  const Held<RTCScene> torus = world.make_scene();
  (void)value_of(attach(scene, torus.get()));
  rtcCommitScene(torus.get());
  // One long and thin, one mirrored, columns first; and a floor of two triangles.
  const std::array<ColumnMap, 2> maps{
      {{2, 0, 0, 0, 0.5f, 0, 0, 0, 1, 3, 0, 0}, {-1, 0, 0, 0, 1, 0, 0, 0, 1, -3, 0, 0.25f}}};
  add_instances(world, torus.get(), maps);
  const unsigned floor_id = add_floor(world);
  rtcCommitScene(world.scene.get());

  Random random(53);
  std::size_t met[3] = {0, 0, 0};
  for (int k = 0; k < 4000; ++k) {
    const Vec3 origin{uniform(random, -6, 6), uniform(random, -4, 4), 6};
    const Ray down = in_float(ray(origin, {uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3), -1}));
    double expected = (-2 - down.origin.z) / down.direction.z;
    unsigned nearest = 2;
    for (unsigned j = 0; j < 2; ++j) {
      const auto& m = maps[j];
      const auto back = [&](const Vec3& a, double moved) {
        return Vec3{(a.x - moved * m[9]) / m[0], (a.y - moved * m[10]) / m[4], (a.z - moved * m[11]) / m[8]};
      };
      const Hit hit = scene.closest(ray(back(down.origin, 1), back(down.direction, 0)));
      if (hit.t < expected) expected = hit.t, nearest = j;
    }
    const RTCRayHit one = trace(world.scene.get(), down);
    ++met[nearest];
    ASSERT_NE(one.hit.geomID, nothing);
    EXPECT_NEAR(one.ray.tfar, expected, 1e-4);
    EXPECT_EQ(one.hit.instID[0], nearest == 2 ? nothing : nearest) << k;
    EXPECT_EQ(one.hit.geomID, nearest == 2 ? floor_id : 0);
  }
  EXPECT_GT(std::min({met[0], met[1], met[2]}), 100u);
}

TEST(EmbreeGeometry, FollowsEdits) {
  PatchSet set = set_of(sphere());
  RayScene scene = value_of(RayScene::make(set, {.editable = true}));
  const World world;
  const unsigned id = value_of(attach(scene, world.scene.get()));
  const RTCGeometry geometry = rtcGetGeometry(world.scene.get(), id);
  rtcCommitScene(world.scene.get());
  const Ray down = ray({0.125, 0.25, 5}, {0, 0, -1});
  const float before = trace(world.scene.get(), down).ray.tfar;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    std::vector<Vec3> points(set.patch(k).points().begin(), set.patch(k).points().end());
    for (Vec3& p : points) p.z += 1;
    ASSERT_TRUE(set.set_control_points(k, points).ok());
  }
  EXPECT_EQ(trace(world.scene.get(), down).hit.geomID, nothing);
  EXPECT_EQ(update_embree_geometry(scene, geometry).code(), StatusCode::stale);
  ASSERT_TRUE(scene.refit().ok());
  ASSERT_TRUE(update_embree_geometry(scene, geometry).ok());
  rtcCommitScene(world.scene.get());
  EXPECT_NEAR(trace(world.scene.get(), down).ray.tfar, before - 1, 1e-6);
}

TEST(EmbreeGeometry, RefusalsSayWhy) {
  PatchSet set = set_of(sphere());
  const RayScene grid = scene_of(set), exact = value_of(RayScene::make(set)), other = value_of(RayScene::make(set));
  const World world;
  EXPECT_EQ(make_embree_geometry(exact, nullptr).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(attach(exact, nullptr).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(update_embree_geometry(exact, nullptr).code(), StatusCode::invalid_argument);
  EXPECT_EQ(attach(grid, world.scene.get()).status().code(), StatusCode::unsupported);
  const Held<RTCGeometry> geometry(value_of(make_embree_geometry(exact, world.device.get())));
  EXPECT_EQ(update_embree_geometry(other, geometry.get()).code(), StatusCode::invalid_argument);
  const PatchSet huge = set_of(placed(sphere(), 1e20, {}));
  EXPECT_EQ(attach(value_of(RayScene::make(huge)), world.scene.get()).status().code(), StatusCode::unsupported);
  ASSERT_TRUE(set.set_control_points(0, sphere()[0].points()).ok());
  EXPECT_EQ(attach(exact, world.scene.get()).status().code(), StatusCode::stale);
}

}}  // namespace tessera::test
