#include "peers/face_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "peers/triangle_tree.h"

namespace tessera::bench {
namespace {

constexpr double mixes[][3] = {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1. / 3, 1. / 3, 1. / 3},
                               {1, 0, 0},     {0, 1, 0},     {0, 0, 1}};

/// The distance from starts where one corner's parameter has no say: at a pole it may be any.
double distance_at_poles(const TrueFace& face, const Vec3& p, const SurfaceTriangle& t, const Parameters& mixed) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 3; ++c) {
    const Parameters &a = t.parameters[(c + 1) % 3], &b = t.parameters[(c + 2) % 3];
    least = std::min(
        {least, face.distance(p, {(a[0] + b[0]) / 2, mixed[1]}), face.distance(p, {mixed[0], (a[1] + b[1]) / 2})});
  }
  return least;
}

}  // namespace

std::vector<SurfaceTriangle> triangles_on_faces(const TrimmedCase& one, const PatchSet& set, const Mesh& mesh,
                                                std::size_t first, const Affine& placement) {
  std::vector<SurfaceTriangle> triangles = triangles_of(mesh);
  for (SurfaceTriangle& triangle : triangles) {
    const PatchSource& source = set.source(triangle.face);
    const Domain& d = source.domain;
    triangle.face = first + source.surface;
    for (Vec3& corner : triangle.corners) corner = placement.point(corner);
    for (auto& [u, v] : triangle.parameters) {
      const Parameters at = one.faces[triangle.face]->theirs({d.u0 + u * (d.u1 - d.u0), d.v0 + v * (d.v1 - d.v0)});
      u = at[0], v = at[1];
    }
  }
  return triangles;
}

FaceErrorMeter::FaceErrorMeter(const TrimmedCase& one, std::size_t samples) : case_(one), samples_(samples) {
  double area = 0, perimeter = 0;
  for (const auto& face : one.faces) area += face->area(), perimeter += face->perimeter();
  std::mt19937 random(1);
  for (std::size_t k = 0; k < one.faces.size(); ++k) {
    const TrueFace& face = *one.faces[k];
    const auto inner = 8 + static_cast<std::size_t>(0.6 * static_cast<double>(samples) * face.area() / area);
    for (std::size_t tried = 0, found = 0; found < inner && tried < 20 * inner; ++tried)
      if (const Parameters at = face.random(random); face.contains(at)) {
        kept_.push_back({k, face.point(at)});
        ++found;
      }
    const double border = 0.4 * static_cast<double>(samples) * face.perimeter() / perimeter;
    const std::size_t edges = face.border_points(1).size();
    if (edges == 0) continue;
    for (const Vec3& p : face.border_points(4 + static_cast<std::size_t>(border) / edges)) kept_.push_back({k, p});
  }
}

FaceErrors FaceErrorMeter::measure(std::span<const SurfaceTriangle> mesh) const {
  FaceErrors errors;
  const std::size_t each = std::size(mixes), budget = std::max<std::size_t>(samples_ / each, 1);
  const std::size_t step = std::max<std::size_t>(mesh.size() / budget, 1);
  for (std::size_t k = 0; k < mesh.size(); k += step) {
    const SurfaceTriangle& t = mesh[k];
    for (const auto& [a, b, c] : mixes) {
      const Vec3 p = a * t.corners[0] + b * t.corners[1] + c * t.corners[2];
      const auto mixed = [&](std::size_t d) {
        return a * t.parameters[0][d] + b * t.parameters[1][d] + c * t.parameters[2][d];
      };
      double distance = case_.faces[t.face]->distance(p, {mixed(0), mixed(1)});
      if (distance > errors.from_mesh)
        distance = std::min(distance, distance_at_poles(*case_.faces[t.face], p, t, {mixed(0), mixed(1)}));
      ++errors.mesh_points;
      if (distance > errors.from_mesh) errors.from_mesh = distance, errors.mesh_face = t.face;
    }
  }
  std::vector<std::vector<const SurfaceTriangle*>> by_face(case_.faces.size());
  for (const SurfaceTriangle& t : mesh) by_face[t.face].push_back(&t);
  std::vector<TriangleTree> trees;
  for (auto& triangles : by_face) trees.emplace_back(std::move(triangles));
  for (const KeptPoint& point : kept_) {
    const double distance = trees[point.face].distance(point.position, std::numeric_limits<double>::infinity());
    ++errors.kept_points;
    if (distance > errors.from_faces) errors.from_faces = distance, errors.kept_face = point.face;
  }
  return errors;
}

}  // namespace tessera::bench
