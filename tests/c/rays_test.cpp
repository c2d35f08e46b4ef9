// Rays through C: the hits of C++, bit for bit, in arrays of float and double.

#include <cstring>
#include <random>

#include "c/c_objects.h"
#include "tessera/ray_scene.h"

namespace tessera::test { namespace {

constexpr std::size_t ray_count = 500;

/// Rays from above at the field, some beside it.
std::vector<Ray> rays_at(int size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-1, static_cast<float>(size) + 1), tilt(-0.3f, 0.3f);
  std::vector<Ray> rays(ray_count);
  for (Ray& ray : rays)
    ray.origin = {place(random), place(random), 4}, ray.direction = {tilt(random), tilt(random), -1};
  return rays;
}

template <class T>
struct RayMemory {
  explicit RayMemory(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays)
      for (const auto& [from, to] : {std::pair(&ray.origin, &origin), {&ray.direction, &direction}})
        to->insert(to->end(), {static_cast<T>(from->x), static_cast<T>(from->y), static_cast<T>(from->z)});
  }
  tsr_rays rays() const {
    tsr_rays made = sized<tsr_rays>();
    made.is_double = sizeof(T) == 8;
    made.origin = in_of(origin, 3), made.direction = in_of(direction, 3);
    return made;
  }
  std::vector<T> origin, direction;
};

template <class T>
struct HitMemory {
  explicit HitMemory(std::size_t count)
      : kind(count),
        flags(count),
        patch(count),
        surface(count),
        t(count),
        uv(2 * count),
        patch_uv(2 * count),
        residual(count),
        position(3 * count),
        normal(3 * count),
        du(3 * count),
        dv(3 * count) {}
  tsr_hits_out out() {
    tsr_hits_out made = sized<tsr_hits_out>();
    made.is_double = sizeof(T) == 8;
    made.kind = out_of(kind, 1), made.flags = out_of(flags, 1);
    made.patch = out_of(patch, 1), made.surface = out_of(surface, 1);
    made.t = out_of(t, 1), made.uv = out_of(uv, 2), made.patch_uv = out_of(patch_uv, 2);
    made.residual = out_of(residual, 1), made.position = out_of(position, 3), made.normal = out_of(normal, 3);
    made.du = out_of(du, 3), made.dv = out_of(dv, 3);
    return made;
  }
  std::vector<std::uint8_t> kind, flags;
  std::vector<std::uint32_t> patch, surface;
  std::vector<T> t, uv, patch_uv, residual, position, normal, du, dv;
};

template <class T>
void expect_hit(const HitMemory<T>& found, std::size_t k, const Hit& wanted) {
  EXPECT_EQ(found.kind[k], static_cast<std::uint8_t>(wanted.kind));
  EXPECT_EQ(found.t[k], static_cast<T>(wanted.t));
  if (wanted.kind != HitKind::hit) return;
  EXPECT_EQ(found.patch[k], wanted.patch);
  EXPECT_EQ(found.uv[2 * k], static_cast<T>(wanted.u));
  EXPECT_EQ(found.uv[2 * k + 1], static_cast<T>(wanted.v));
  EXPECT_EQ(found.patch_uv[2 * k + 1], static_cast<T>(wanted.patch_v));
  EXPECT_EQ(found.position[3 * k + 2], static_cast<T>(wanted.position.z));
  EXPECT_EQ(found.normal[3 * k], static_cast<T>(wanted.normal.x));
  EXPECT_EQ(found.du[3 * k + 1], static_cast<T>(wanted.du.y));
  EXPECT_EQ((found.flags[k] & TSR_HIT_UNCERTIFIED) != 0, wanted.flags.uncertified);
}

template <class R, class H>
void check_closest(std::size_t least_hits) {
  const std::vector<BezierPatch> patches = wavy_field(4, 4);
  const std::vector<Ray> rays = rays_at(4);
  const PatchSet set = value_of(PatchSet::make(patches));
  const RayScene scene = value_of(RayScene::make(set));
  const Handle<tsr_scene> of = scene_of(set_of(patches).get());
  const RayMemory<R> memory(rays);
  HitMemory<H> found(ray_count);
  const tsr_rays from = memory.rays();
  const tsr_hits_out to = found.out();
  ASSERT_C(tsr_scene_closest(of.get(), &from, &to, nullptr));
  std::vector<std::uint8_t> occluded(ray_count);
  const tsr_out shade = out_of(occluded, 1);
  ASSERT_C(tsr_scene_occluded(of.get(), &from, &shade, nullptr));
  std::size_t hits = 0;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const Hit wanted = scene.closest(rays[k]);
    expect_hit(found, k, wanted);
    EXPECT_EQ(occluded[k], wanted.kind == HitKind::hit);
    hits += wanted.kind == HitKind::hit;
  }
  EXPECT_GE(hits, least_hits);
  EXPECT_LT(hits, ray_count);
}

TEST(CRays, ClosestHitsOfCpp) {
  check_closest<double, double>(200);
  check_closest<float, double>(200);
  check_closest<double, float>(200);
  check_closest<float, float>(200);
}

TEST(CRays, FlagsAreTheBitsOfCpp) {
  const std::pair<HitFlags, int> flags[] = {{{.degenerate_normal = true}, TSR_HIT_DEGENERATE_NORMAL},
                                            {{.uncertified = true}, TSR_HIT_UNCERTIFIED},
                                            {{.incomplete = true}, TSR_HIT_INCOMPLETE},
                                            {{.tangential = true}, TSR_HIT_TANGENTIAL},
                                            {{.within_tolerance = true}, TSR_HIT_WITHIN_TOLERANCE},
                                            {{.edge = true}, TSR_HIT_EDGE}};
  for (const auto& [in_cpp, in_c] : flags) {
    std::uint8_t bits = 0;
    std::memcpy(&bits, &in_cpp, 1);
    EXPECT_EQ(bits, in_c);
  }
}

TEST(CRays, AllHitsOfCpp) {
  const std::vector<BezierPatch> patches = wavy_field(4, 4);
  std::vector<Ray> rays = rays_at(4);
  for (Ray& ray : rays) ray.direction.z *= 0.1;  // flat, so that some meet several waves
  const PatchSet set = value_of(PatchSet::make(patches));
  const RayScene scene = value_of(RayScene::make(set));
  HitLists wanted;
  ASSERT_TRUE(scene.all(rays, wanted).ok());
  const Handle<tsr_scene> of = scene_of(set_of(patches).get());
  const RayMemory<double> memory(rays);
  const tsr_rays from = memory.rays();
  tsr_hits* made = nullptr;
  ASSERT_C(tsr_scene_all(&made, of.get(), &from, nullptr));
  const Handle<tsr_hits> hits(made);
  std::size_t count = 0;
  std::vector<std::uint64_t> first(ray_count + 1);
  ASSERT_C(tsr_hits_read(made, &count, first.data(), nullptr));
  ASSERT_EQ(count, wanted.hits.size());
  EXPECT_TRUE(std::ranges::equal(first, wanted.first));
  HitMemory<double> found(count);
  tsr_hits_out to = found.out();
  ASSERT_C(tsr_hits_read(made, nullptr, nullptr, &to));
  for (std::size_t k = 0; k < count; ++k) expect_hit(found, k, wanted.hits[k]);
  HitMemory<float> less(count - 1);
  to = less.out();
  expect_c_error(tsr_hits_read(made, nullptr, nullptr, &to), TSR_BUFFER_TOO_SMALL, "there are");
}

TEST(CRays, OneOriginForAllRays) {
  const Handle<tsr_scene> scene = scene_of(set_of(wavy_field(2, 2)).get());
  const std::vector<double> eye{1, 1, 6};
  std::vector<double> direction;
  for (int k = 0; k < 100; ++k) direction.insert(direction.end(), {0.001 * k, -0.0004 * k, -1.0});
  tsr_rays rays = sized<tsr_rays>();
  rays.is_double = 1, rays.origin = in_of(eye, 3), rays.direction = in_of(direction, 3);
  HitMemory<double> found(100);
  const tsr_hits_out out = found.out();
  ASSERT_C(tsr_scene_closest(scene.get(), &rays, &out, nullptr));
  EXPECT_TRUE(std::ranges::all_of(found.kind, [](std::uint8_t kind) { return kind == TSR_HIT; }));
  tsr_hits* made = nullptr;
  ASSERT_C(tsr_scene_all(&made, scene.get(), &rays, nullptr));
  const Handle<tsr_hits> all(made);
  std::size_t count = 0;
  ASSERT_C(tsr_hits_read(made, &count, nullptr, nullptr));
  EXPECT_EQ(count, 100u);
}

TEST(CRays, RefitsFollowEdits) {
  const std::vector<BezierPatch> patches = wavy_field(2, 2);
  const Handle<tsr_set> set = set_of(patches);
  const Handle<tsr_scene> scene = scene_of(set.get());
  std::vector<Vec3> points(patches[0].points().begin(), patches[0].points().end());
  for (Vec3& point : points) point.z = 2;
  const std::uint32_t patch = 0;
  ASSERT_C(tsr_set_edit(set.get(), &patch, 1, &points[0].x, 16));
  const RayMemory<double> memory({{.origin = {0.5, 0.5, 5}, .direction = {0, 0, -1}}});
  const tsr_rays rays = memory.rays();
  HitMemory<double> found(1);
  const tsr_hits_out out = found.out();
  expect_c_error(tsr_scene_closest(scene.get(), &rays, &out, nullptr), TSR_STALE, "");
  ASSERT_C(tsr_scene_refit(scene.get(), nullptr));
  ASSERT_C(tsr_scene_closest(scene.get(), &rays, &out, nullptr));
  EXPECT_NEAR(found.t[0], 3, 1e-14);
}

}}  // namespace tessera::test
