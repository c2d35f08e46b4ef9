#include <tessera/ray_scene.h>

#include "families.h"
#include "hash.h"
#include "models.h"

namespace {

std::uint64_t rays(tessera::Isa isa, tessera::RayMode mode) {
  const tessera::PatchSet set = some_set();
  tessera::RaySceneOptions options;
  options.mode = mode;
  options.isa = isa;
  const auto scene = value_of(tessera::RayScene::make(set, options));
  const tessera::Box3 box = set.box();
  Seeded seeded(9);
  const auto point = [&] {
    return tessera::Vec3{seeded.between(box.lower.x, box.upper.x), seeded.between(box.lower.y, box.upper.y),
                         seeded.between(box.lower.z, box.upper.z)};
  };
  std::vector<tessera::Ray> rays(4000);
  for (tessera::Ray& ray : rays) {
    ray.origin = point();  // one draw after the other: operands have no order
    ray.origin.z += seeded.between(0, 5);
    ray.direction = point() - ray.origin;
  }
  std::vector<tessera::Hit> hits(rays.size());
  require(scene.closest(rays, hits));
  Hash hash;
  for (const tessera::Hit& hit : hits) {
    hash.add(hit.kind);
    if (hit.kind != tessera::HitKind::hit) continue;
    hash.add(hit.patch);
    for (const double x : {hit.t, hit.u, hit.v, hit.residual}) hash.add(x);
    hash.add(hit.position);
    hash.add(hit.normal);
  }
  std::vector<std::uint8_t> occluded(rays.size());
  require(scene.occluded(rays, occluded));
  hash.add(occluded);
  return hash.value();
}

}  // namespace

std::vector<Family> ray_families() {
  return {{"rays_exact", [](tessera::Isa isa) { return rays(isa, tessera::RayMode::exact); }},
          {"rays_grid", [](tessera::Isa isa) { return rays(isa, tessera::RayMode::grid); }}};
}
