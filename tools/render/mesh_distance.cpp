#include "render/mesh_distance.h"

#include <algorithm>
#include <array>
#include <string>

namespace tessera::render {

Vec3 position_of(const Mesh& mesh, std::size_t vertex) {
  if (!mesh.model_positions.empty()) {
    const double* const p = &mesh.model_positions[3 * vertex];
    return {p[0], p[1], p[2]};
  }
  const float* const p = &mesh.positions[3 * vertex];
  return mesh.origin + Vec3{p[0], p[1], p[2]};
}

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = dot(along, along);
  return length2 > 0 ? a + std::clamp(dot(p - a, along) / length2, 0.0, 1.0) * along : a;
}

namespace {

constexpr std::size_t leaf_triangles = 4;

double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

double squared_distance(const Vec3& p, const Box3& box) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = coordinate(p, axis);
    const double beside = std::max({coordinate(box.lower, axis) - x, x - coordinate(box.upper, axis), 0.0});
    sum += beside * beside;
  }
  return sum;
}

/// The nearest of the foot on the plane, if it lies inside the triangle, and of the nearest points of the edges. Each
/// is a point of the triangle up to rounding, of needles too: no distance is too small.
///
/// Source: the foot's barycentric coordinates, Ericson, Real-Time Collision Detection, section 3.4.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<Vec3, 3> on_edges{nearest_on_segment(p, a, b), nearest_on_segment(p, b, c),
                                     nearest_on_segment(p, c, a)};
  const auto squared = [&](const Vec3& q) { return dot(q - p, q - p); };
  const Vec3 nearest = *std::ranges::min_element(on_edges, {}, squared);
  const Vec3 ab = b - a, ac = c - a, ap = p - a, normal = cross(ab, ac);
  const double size2 = dot(normal, normal);
  if (!(size2 > 0)) return nearest;
  const double of_b = dot(cross(ap, ac), normal) / size2, of_c = dot(cross(ab, ap), normal) / size2;
  if (!(of_b >= 0 && of_c >= 0 && of_b + of_c <= 1)) return nearest;
  const Vec3 foot = a + of_b * ab + of_c * ac;
  return squared(foot) < squared(nearest) ? foot : nearest;
}

}  // namespace

Result<MeshDistance> MeshDistance::make(const Mesh& mesh) {
  const std::size_t vertices = mesh.vertex_count();
  if (mesh.indices.empty()) return Status(StatusCode::invalid_argument, "the mesh has no triangle");
  MeshDistance made;
  made.triangles_.reserve(mesh.triangle_count());
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
    std::array<Vec3, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t vertex = mesh.indices[3 * k + c];
      if (vertex >= vertices)
        return Status(StatusCode::invalid_argument, "triangle " + std::to_string(k) + " has vertex " +
                                                        std::to_string(vertex) + ", there are " +
                                                        std::to_string(vertices));
      corners[c] = position_of(mesh, vertex);
      if (!is_finite(corners[c]))
        return Status(StatusCode::non_finite, "vertex " + std::to_string(vertex) + " is not finite");
    }
    made.triangles_.push_back({corners[0], corners[1], corners[2]});
  }
  made.build(0, made.triangles_.size());
  return made;
}

void MeshDistance::build(std::size_t begin, std::size_t end) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  Box3 box, middles;
  const auto middle = [](const Triangle& t) { return (1.0 / 3) * (t.a + t.b + t.c); };
  for (std::size_t k = begin; k < end; ++k) {
    for (const Vec3& corner : {triangles_[k].a, triangles_[k].b, triangles_[k].c}) box.extend(corner);
    middles.extend(middle(triangles_[k]));
  }
  nodes_[at].box = box;
  if (end - begin <= leaf_triangles) {
    nodes_[at].first = static_cast<std::uint32_t>(begin);
    nodes_[at].count = static_cast<std::uint32_t>(end - begin);
    return;
  }
  const Vec3 extent = middles.upper - middles.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = (begin + end) / 2;
  const auto place = [&](std::size_t k) { return triangles_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(place(begin), place(half), place(end), [&](const Triangle& a, const Triangle& b) {
    return coordinate(middle(a), axis) < coordinate(middle(b), axis);
  });
  build(begin, half);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

std::optional<Vec3> MeshDistance::nearest(const Vec3& point, double within) const {
  std::array<std::uint32_t, 64> waiting;  // enough: repeated halving of 2^32 triangles is at most 32 deep
  std::size_t count = 0;
  waiting[count++] = 0;
  double least = within * within;
  std::optional<Vec3> found;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const Node& node = nodes_[at];
    if (squared_distance(point, node.box) >= least) continue;
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Vec3 near = nearest_on_triangle(point, triangles_[k].a, triangles_[k].b, triangles_[k].c);
      const double squared = dot(near - point, near - point);
      if (squared < least) least = squared, found = near;
    }
    if (node.count > 0) continue;
    const std::uint32_t children[] = {at + 1, node.first};
    const bool second_is_nearer =
        squared_distance(point, nodes_[children[1]].box) < squared_distance(point, nodes_[children[0]].box);
    waiting[count++] = children[second_is_nearer ? 0 : 1];
    waiting[count++] = children[second_is_nearer ? 1 : 0];
  }
  return found;
}

double MeshDistance::distance(const Vec3& point, double within) const {
  const std::optional<Vec3> found = nearest(point, within);
  return found ? length(*found - point) : within;
}

}  // namespace tessera::render
