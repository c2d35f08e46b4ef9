// Coherent rays are traced as packets: for any number of rays, each hits what it hits alone.

#include "ray_support.h"
#include "support/torus.h"
#include "tessera/bezier_operations.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

PatchSet torus_set() {
  Model model;
  model.surfaces.push_back({.name = std::string("torus"), .surface = value_of(make_nurbs_torus({}, 2, 0.8))});
  return value_of(make_patch_set(model));
}

/// Rays side by side, towards the torus at a slant; the wider they lie, the more miss it.
std::vector<Ray> side_by_side(std::size_t count, double width) {
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = width * (static_cast<double>(k) / static_cast<double>(count) - 0.5);
    rays.push_back(ray({x, -6, 4.5}, {0.01 * x, 6, -4.2 + 0.3 * width}));
  }
  return rays;
}

/// A picture in rows from an eye outside, the lower part of it so fine that many rays meet one piece.
std::vector<Ray> picture() {
  std::vector<Ray> rays;
  const Vec3 eye{1.4, -1.7, 1.2};
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const double fine = y < 48 ? 1 : 0.02, across = fine * (x / 48.0 - 1), above = fine * (y / 48.0 - 1);
      rays.push_back(ray(eye, Vec3{0.1 * above, 0, 0} + Vec3{1.1 * across, 0.9 * across, 0.8 * above} - eye));
    }
  }
  return rays;
}

void packet_expect_same(const Hit& a, const Hit& b) {
  EXPECT_EQ(a.kind, b.kind);
  if (a.kind != HitKind::hit || b.kind != HitKind::hit) return;
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.patch_u, b.patch_u);
  EXPECT_EQ(a.patch_v, b.patch_v);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.du, b.du);
  EXPECT_EQ(a.dv, b.dv);
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(a.flags.uncertified, b.flags.uncertified);
}

/// Bicubic pieces, rational ones, and pieces that no kernel takes: each ray gives the bits that it gives alone.
TEST(Packets, HaveTheBitsOfEachRay) {
  const std::vector<Ray> rays = picture();
  std::vector<BezierPatch> quartic;
  for (const BezierPatch& patch : Torus(5).patches(false)) quartic.push_back(value_of(elevate_degree(patch, 4, 4)));
  for (const auto& patches : {Torus(7).patches(false), Torus(7).patches(true), quartic}) {
    const PatchSet set = value_of(PatchSet::make(patches));
    for (const Isa isa : available_isas()) {
      RaySceneOptions options;
      options.isa = isa;
      const RayScene scene = value_of(RayScene::make(set, options));
      const std::vector<Hit> hits = closest(scene, rays);
      std::vector<std::uint8_t> occluded(rays.size());
      ASSERT_TRUE(scene.occluded(rays, occluded).ok());
      std::size_t met = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        const Hit alone = scene.closest(rays[k]);
        packet_expect_same(hits[k], alone);
        EXPECT_EQ(occluded[k] != 0, alone.kind == HitKind::hit);
        ASSERT_FALSE(HasFailure()) << name(isa) << ", ray " << k;
        met += alone.kind == HitKind::hit;
      }
      EXPECT_GT(met, rays.size() / 4);
      EXPECT_LT(met, rays.size());
    }
  }
}

TEST(Packets, OfAnyNumberMeetWhatEachRayMeets) {
  const PatchSet set = torus_set();
  for (const Isa isa : available_isas()) {
    RaySceneOptions options;
    options.isa = isa;
    const RayScene scene = value_of(RayScene::make(set, options));
    for (std::size_t count = 1; count <= 40; ++count) {
      for (const double width : {0.5, 1.5, 2.5, 4.0, 6.0}) {
        const std::vector<Ray> rays = side_by_side(count, width);
        const std::vector<Hit> hits = closest(scene, rays);
        std::vector<std::uint8_t> occluded(count);
        ASSERT_TRUE(scene.occluded(rays, occluded).ok());
        for (std::size_t k = 0; k < count; ++k) {
          const Hit alone = scene.closest(rays[k]);
          EXPECT_EQ(hits[k].kind, alone.kind) << name(isa) << ", ray " << k << " of " << count;
          EXPECT_EQ(hits[k].t, alone.t) << name(isa) << ", ray " << k << " of " << count;
          EXPECT_EQ(occluded[k] != 0, alone.kind == HitKind::hit) << name(isa) << ", ray " << k << " of " << count;
        }
      }
    }
  }
}

}}  // namespace tessera::test
