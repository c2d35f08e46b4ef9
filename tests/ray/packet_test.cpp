// Coherent rays are traced as packets: whatever their number, each meets what it meets alone.

#include "ray_support.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test {
namespace {

PatchSet torus_set() {
  Model model;
  model.surfaces.push_back({.name = std::string("torus"), .surface = value_of(nurbs_torus({}, 2, 0.8))});
  return value_of(make_patch_set(model));
}

/// Side by side, towards the torus from aslant; the wider they lie, the more pass it by.
std::vector<Ray> side_by_side(std::size_t count, double width) {
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = width * (static_cast<double>(k) / static_cast<double>(count) - 0.5);
    rays.push_back(ray({x, -6, 4.5}, {0.01 * x, 6, -4.2 + 0.3 * width}));
  }
  return rays;
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

}  // namespace
}  // namespace tessera::test
