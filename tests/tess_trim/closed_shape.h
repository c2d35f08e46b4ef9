#pragma once
// Shapes whose faces share edges, and their meshes.

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "join/unjoined_faces.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/tessellation.h"

namespace tessera::test {

/// A rectangle at `corner` along the vectors a and b; u runs along a from 0 to its length, v along b.
inline ModelSurface rectangle_face(const Vec3& corner, const Vec3& a, const Vec3& b, std::vector<TrimLoop> trims = {}) {
  const double m = length(a), n = length(b);
  const std::vector<double> u{0, 0, m, m}, v{0, 0, n, n};
  const std::vector<Vec3> points{corner, corner + b, corner + a, corner + a + b};
  return {.name = std::string("rectangle"),
          .surface = value_of(BSplineSurface::polynomial(1, u, 1, v, points)),
          .trims = std::move(trims)};
}

/// A circle as a loop of one rational curve of four arcs, which starts at an angle of `turn`.
inline TrimLoop circle_loop(double x, double y, double radius, bool hole, double turn = 0) {
  const Affine place = Affine::translated({x, y, 0}) * Affine::rotated({0, 0, 1}, turn);
  std::vector<Vec3> points;
  const Curve circle = value_of(make_nurbs_circle({}, radius));
  for (const Vec3& p : circle.points()) points.push_back(place.point(p));
  return {{value_of(Curve::nurbs(2, points, circle.weights(), circle.knots()))}, hole};
}

/// The wall of a round hole of a plate of thickness 1, its normals towards the axis.
inline ModelSurface hole_wall(double x, double y, double radius) {
  const Curve circle = value_of(make_nurbs_circle({}, radius));
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < circle.points().size(); ++k)
    for (const double z : {1.0, 0.0}) {
      points.push_back(circle.points()[k] + Vec3{x, y, z});
      weights.push_back(circle.weight(k));
    }
  const std::vector<double> knots(circle.knots().begin(), circle.knots().end()), v{0, 0, 1, 1};
  return {.name = std::string("wall"), .surface = value_of(BSplineSurface::rational(2, knots, 1, v, points, weights))};
}

/// The faces of a plate of 4 x 3 x 1 with a round hole. `turn`: where the loops on top and bottom start.
inline std::vector<ModelSurface> drilled_plate(double x = 1.7, double y = 1.4, double radius = 0.6, double turn = 0) {
  return {rectangle_face(
              {0, 0, 1}, {4, 0, 0}, {0, 3, 0},
              {space_polygon({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}), circle_loop(x, y, radius, true, turn)}),
          rectangle_face(
              {0, 0, 0}, {0, 3, 0}, {4, 0, 0},
              {space_polygon({{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}}), circle_loop(y, x, radius, true, turn)}),
          rectangle_face({0, 0, 0}, {4, 0, 0}, {0, 0, 1}),
          rectangle_face({0, 3, 0}, {0, 0, 1}, {4, 0, 0}),
          rectangle_face({0, 0, 0}, {0, 0, 1}, {0, 3, 0}),
          rectangle_face({4, 0, 0}, {0, 3, 0}, {0, 0, 1}),
          hole_wall(x, y, radius)};
}
inline double drilled_volume(double radius = 0.6) { return 12 - std::numbers::pi * radius * radius; }

/// A mesh of a shape, and what its plan states.
struct ShapeMesh {
  Mesh mesh;
  MeshReport report;
  double bound = 0, gap = 0;
  std::vector<float> edge_gaps;
  std::size_t open_edges = 0;
};

inline ShapeMesh mesh_of(const Shape& shape, const TessellationOptions& options, const Execution& execution = {}) {
  const PatchSet set = value_of(make_patch_set(shape));
  const Tessellation plan = value_of(Tessellation::make(set, options, execution));
  ShapeMesh made;
  made.mesh = value_of(plan.allocate());
  made.bound = plan.bound(), made.gap = plan.gap();
  const Status status = plan.run(set, made.mesh.views(), execution);
  EXPECT_TRUE(status.ok()) << status.message();
  made.edge_gaps.assign(plan.edge_gaps().begin(), plan.edge_gaps().end());
  made.open_edges = plan.open_edges();
  made.report = value_of(check(made.mesh));
  return made;
}

inline Vec3 vertex(const Mesh& mesh, std::size_t k) {
  const float* p = &mesh.positions[3 * k];
  return mesh.origin + Vec3{p[0], p[1], p[2]};
}

/// The volume that a mesh encloses, and its area.
inline std::array<double, 2> volume_and_area(const Mesh& mesh) {
  double volume = 0, area = 0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const Vec3 a = vertex(mesh, mesh.indices[t]), b = vertex(mesh, mesh.indices[t + 1]),
               c = vertex(mesh, mesh.indices[t + 2]);
    volume += dot(a, cross(b, c)) / 6;
    area += length(cross(b - a, c - a)) / 2;
  }
  return {volume, area};
}

}  // namespace tessera::test
