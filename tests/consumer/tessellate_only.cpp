// Uses only the core: a patch set, a grid of points, a mesh.

#include <tessera/evaluate.h>
#include <tessera/mesh.h>
#include <tessera/tessellation.h>

#include <vector>

#include "dome.h"

namespace {

void evaluate_grid(const tessera::PatchSet& set) {
  const std::vector<double> parameters = tessera::uniform_parameters(5);
  const tessera::GridPlan plan = value_of(tessera::GridPlan::make(set, parameters, parameters));
  std::vector<float> memory(3 * plan.capacity());
  tessera::QuantityViews<float> views;
  views.position = tessera::View3<float>::interleaved(memory);
  require(tessera::evaluate(set, plan, views));
  for (std::size_t k = 0; k < plan.capacity(); ++k) {
    const double x = views.position.at(k, 0) + set.origin().x, z = views.position.at(k, 2) + set.origin().z;
    require(std::abs(z - dome_height(x)) < 1e-6, "a point of the grid is not on the surface");
  }
}

void tessellate(const tessera::PatchSet& set) {
  const auto plan = value_of(tessera::Tessellation::make(set, {.rates = tessera::UniformRates{4, 3}}));
  tessera::Mesh mesh = value_of(plan.allocate());
  require(plan.run(set, mesh.views()));
  const tessera::MeshReport report = value_of(tessera::check(mesh));
  require(report.triangles == 24 && report.open_edges == 14 && report.non_manifold_edges == 0 &&
              report.degenerate_triangles == 0,
          "the mesh is not a whole sheet of 4 x 3 quadrangles");
}

}  // namespace

int main() {
  const tessera::PatchSet set = make_dome();
  evaluate_grid(set);
  tessellate(set);
  std::puts("tessellate_only: a grid and a mesh");
}
