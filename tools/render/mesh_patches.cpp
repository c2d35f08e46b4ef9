#include "render/mesh_patches.h"

#include <algorithm>
#include <limits>
#include <string>

#include "render/mesh_distance.h"
#include "tessera/bezier_patch.h"

namespace tessera::render {
namespace {

Vec3 normal_of(const Mesh& mesh, std::size_t vertex) {
  if (mesh.normals.size() != mesh.positions.size()) return {};
  const float* const n = &mesh.normals[3 * vertex];
  return {n[0], n[1], n[2]};
}

Status check_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  const auto bad = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t index) { return index >= vertices; });
  if (bad == indices.end()) return {};
  return {StatusCode::invalid_argument,
          "a face has vertex " + std::to_string(*bad) + ", the mesh has " + std::to_string(vertices)};
}

Status check_positions(const Mesh& mesh) {
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k)
    if (!is_finite(position_of(mesh, k)))
      return {StatusCode::non_finite, "vertex " + std::to_string(k) + " is not finite"};
  return {};
}

}  // namespace

Status MeshPatches::add(const Mesh& mesh) {
  for (const auto* const indices : {&mesh.indices, &mesh.quads})
    if (Status status = check_indices(*indices, mesh.vertex_count()); !status.ok()) return status;
  if (Status status = check_positions(mesh); !status.ok()) return status;
  const bool has_patches = mesh.has_patches();
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
    const std::uint32_t* const corners = &mesh.indices[3 * k];
    add_triangle(mesh, {corners[0], corners[1], corners[2]}, {true, true, true}, has_patches ? mesh.patches[k] : 0);
  }
  for (std::size_t k = 0; k < mesh.quad_count(); ++k) {
    const std::uint32_t *const quad = &mesh.quads[4 * k], patch = has_patches ? mesh.quad_patches[k] : 0;
    add_triangle(mesh, {quad[0], quad[1], quad[2]}, {true, true, false}, patch);
    add_triangle(mesh, {quad[0], quad[2], quad[3]}, {false, true, true}, patch);
  }
  return {};
}

void MeshPatches::add_triangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners,
                               const std::array<bool, 3>& is_edge, std::uint32_t patch) {
  Triangle triangle{{}, {}, is_edge, patch};
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.corners[k] = position_of(mesh, corners[k]);
    triangle.normals[k] = normal_of(mesh, corners[k]);
  }
  const auto& [a, b, c] = triangle.corners;
  if (cross(b - a, c - a) != Vec3{}) triangles_.push_back(triangle);
}

Result<PatchSet> MeshPatches::pack() const {
  if (triangles_.empty()) return Status(StatusCode::invalid_argument, "the mesh has no triangle with an area");
  std::vector<BezierPatch> patches;
  patches.reserve(triangles_.size());
  for (const Triangle& triangle : triangles_) {
    const auto& [a, b, c] = triangle.corners;
    Result<BezierPatch> patch = BezierPatch::polynomial(1, 1, std::array{a, a, b, c});
    if (!patch) return patch.status();
    patches.push_back(*std::move(patch));
  }
  return PatchSet::make(patches);
}

Vec3 MeshPatches::normal(const Hit& hit) const {
  const Triangle& triangle = triangles_[hit.patch];
  const double u = hit.patch_u, v = hit.patch_v;
  const Vec3 sum = (1 - u) * triangle.normals[0] + u * ((1 - v) * triangle.normals[1] + v * triangle.normals[2]);
  const auto& [a, b, c] = triangle.corners;
  return normalized(is_finite(sum) && sum != Vec3{} ? sum : cross(b - a, c - a));
}

Vec3 MeshPatches::nearest_edge(const Hit& hit) const {
  const Triangle& triangle = triangles_[hit.patch];
  Vec3 nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!triangle.is_edge[k]) continue;
    const Vec3 point = nearest_on_segment(hit.position, triangle.corners[k], triangle.corners[(k + 1) % 3]);
    const double distance = length(point - hit.position);
    if (distance < least) least = distance, nearest = point;
  }
  return nearest;
}

}  // namespace tessera::render
