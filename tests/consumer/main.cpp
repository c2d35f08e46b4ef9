// Uses every component: a mesh to a file and back, and a ray.

#include <tessera/io.h>
#include <tessera/ray_scene.h>
#include <tessera/tessellation.h>

#include "dome.h"

namespace {

void write_and_read_mesh(const tessera::PatchSet& set) {
  const auto plan = value_of(tessera::Tessellation::make(set, {.rates = tessera::UniformRates{}}));
  tessera::Mesh mesh = value_of(plan.allocate());
  require(plan.run(set, mesh.views()));
  require(tessera::write_mesh(mesh, "dome.ply"));
  const tessera::Mesh read = value_of(tessera::read_mesh("dome.ply"));
  require(read.indices == mesh.indices, "the mesh that was read is not the one that was written");
}

void cast_ray(const tessera::PatchSet& set) {
  const tessera::RayScene scene = value_of(tessera::RayScene::make(set));
  tessera::Ray ray;
  ray.origin = {0.3, 0.2, 5};
  ray.direction = {0, 0, -1};
  const tessera::Hit hit = scene.closest(ray);
  require(hit.kind == tessera::HitKind::hit && std::abs(hit.t - (5 - dome_height(0.3))) < 1e-6,
          "a ray from above does not meet the dome where it stands");
  ray.direction = {0, 0, 1};
  require(scene.occluded(ray) == tessera::HitKind::miss, "a ray away from the dome meets it");
}

}  // namespace

int main() {
  const tessera::PatchSet set = make_dome();
  write_and_read_mesh(set);
  cast_ray(set);
  std::puts("consumer: a mesh written and read, a ray cast");
}
