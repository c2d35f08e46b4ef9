#pragma once
// Surfaces with trimming loops, and their meshes.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/tessellation.h"

namespace tessera::test {

inline BSplineSurface wavy(double x = 0) {
  std::vector<Vec3> points;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 6; ++j) points.push_back({x + i, double(j), std::sin(1.3 * i) * std::cos(0.9 * j)});
  const std::vector<double> u{0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}, v{0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  return value_of(BSplineSurface::polynomial(3, u, 3, v, points));
}
/// A quarter of a cylinder of radius 2, rational along u, over [0, 4] x [0, 3].
inline BSplineSurface cylinder() {
  const std::vector<Vec3> points{{2, 0, 0}, {2, 0, 6}, {2, 2, 0}, {2, 2, 6}, {0, 2, 0}, {0, 2, 6}};
  const double w = std::sqrt(0.5);
  const std::vector<double> u{0, 0, 0, 4, 4, 4}, v{0, 0, 3, 3}, weights{1, 1, w, w, 1, 1};
  return value_of(BSplineSurface::rational(2, u, 1, v, points, weights));
}
inline BSplineSurface plane() {
  const std::vector<double> u{0, 0, 4, 4}, v{0, 0, 3, 3};
  const std::vector<Vec3> points{{0, 0, 1}, {0, 3, 1}, {4, 0, 1}, {4, 3, 1}};
  return value_of(BSplineSurface::polynomial(1, u, 1, v, points));
}

/// A trimmed face, and what is made of it.
struct Face {
  Face(const BSplineSurface& surface, std::vector<TrimLoop> loops)
      : model{.name = {}, .surfaces = {{.name = std::string("face"), .surface = surface, .trims = std::move(loops)}}},
        grid(value_of(to_bezier(surface))),
        set(value_of(make_patch_set(model))) {}

  /// The mesh within a tolerance, whose bound is `bound`, with parameters of patches unless others are asked for.
  Mesh mesh(TessellationOptions options) {
    if (!options.parameters && !options.joining.share_vertices) options.parameters = VertexParameters::patch;
    const Tessellation plan = value_of(Tessellation::make(set, options));
    bound = plan.bound();
    open_edges = plan.open_edges();
    Mesh made = value_of(plan.allocate());
    const Status status = plan.run(set, made.views());
    EXPECT_TRUE(status.ok()) << status.message();
    return made;
  }
  Mesh mesh(double tolerance) { return mesh({.tolerance = tolerance}); }

  Model model;
  PatchGrid grid;
  PatchSet set;
  double bound = 0;
  std::size_t open_edges = 0;
};

inline ParameterPoint parameters(const Face& face, const Mesh& mesh, std::size_t triangle, const double (&shares)[3]) {
  const Domain domain = face.set.source(mesh.patches[triangle]).domain;
  ParameterPoint at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float* p = &mesh.parameters[2 * std::size_t{mesh.indices[3 * triangle + k]}];
    at.u += shares[k] * (domain.u0 + p[0] * (domain.u1 - domain.u0));
    at.v += shares[k] * (domain.v0 + p[1] * (domain.v1 - domain.v0));
  }
  return at;
}

/// The area of a mesh in the parameters of its face.
inline double plane_area(const Face& face, const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const ParameterPoint a = parameters(face, mesh, t, {1, 0, 0}), b = parameters(face, mesh, t, {0, 1, 0}),
                         c = parameters(face, mesh, t, {0, 0, 1});
    sum += ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)) / 2;
  }
  return sum;
}

}  // namespace tessera::test
