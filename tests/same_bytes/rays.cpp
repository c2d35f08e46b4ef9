#include <tessera/ray_scene.h>

#include "families.h"
#include "hash.h"
#include "models.h"

std::uint64_t hits_hash(const tessera::PatchSet& set, std::size_t count, bool exact, tessera::Isa isa) {
  tessera::RaySceneOptions options;
  options.mode = exact ? tessera::RayMode::exact : tessera::RayMode::grid;
  options.isa = isa;
  const auto scene = value_of(tessera::RayScene::make(set, options));
  const tessera::Box3 box = set.box();
  Seeded seeded(9);
  const auto point = [&] {
    return tessera::Vec3{seeded.between(box.lower.x, box.upper.x), seeded.between(box.lower.y, box.upper.y),
                         seeded.between(box.lower.z, box.upper.z)};
  };
  std::vector<tessera::Ray> rays(count);
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

std::vector<Family> ray_families() {
  return {{"rays_exact", [](tessera::Isa isa) { return hits_hash(some_set(), 4000, true, isa); }},
          {"rays_grid", [](tessera::Isa isa) { return hits_hash(some_set(), 4000, false, isa); }}};
}
