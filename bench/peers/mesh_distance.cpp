#include "peers/mesh_distance.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "support/triangle_distance.h"

namespace tessera::bench {
namespace {

/// Lists the triangles at each vertex: corners at the same position are one vertex.
class Neighbours {
 public:
  explicit Neighbours(std::span<const SurfaceTriangle> mesh)
      : order_(3 * mesh.size()), first_(order_.size()), last_(order_.size()), seen_(mesh.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    const auto position = [&](std::uint32_t corner) {
      const Vec3& p = mesh[corner / 3].corners[corner % 3];
      return std::tuple{p.x, p.y, p.z};
    };
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return position(a) < position(b); });
    for (std::uint32_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      while (end < order_.size() && position(order_[end]) == position(order_[begin])) ++end;
      for (std::uint32_t k = begin; k < end; ++k) first_[order_[k]] = begin, last_[order_[k]] = end;
    }
  }

  /// Visits the triangles around triangle t, each once: first those that share a vertex with it, then those that share
  /// a vertex with these. Continues with a ring only if `goes_on` says so.
  template <class Visit, class GoesOn>
  void visit_rings(std::uint32_t t, Visit&& visit, GoesOn&& goes_on) {
    ++round_;
    found_.assign(1, t);
    seen_[t] = round_;
    for (std::size_t ring = 0, begin = 0; ring < 2 && goes_on(); ++ring)
      for (const std::size_t end = found_.size(); begin < end; ++begin)
        for (std::uint32_t corner = 3 * found_[begin], stop = corner + 3; corner < stop; ++corner)
          for (std::uint32_t k = first_[corner]; k < last_[corner]; ++k)
            if (const std::uint32_t other = order_[k] / 3; seen_[other] != round_) {
              seen_[other] = round_;
              found_.push_back(other);
              visit(other);
            }
  }

 private:
  std::vector<std::uint32_t> order_;         ///< corners, grouped by vertex
  std::vector<std::uint32_t> first_, last_;  ///< range in order_ of each corner's vertex
  std::vector<std::uint32_t> seen_, found_;  ///< the last round that met each triangle; the triangles of this round
  std::uint32_t round_ = 0;
};

double distance(const Vec3& p, const SurfaceTriangle& t) {
  return test::distance_to_triangle(p, t.corners[0], t.corners[1], t.corners[2]);
}

}  // namespace

std::vector<SurfaceTriangle> triangles_of(const Mesh& mesh) {
  std::vector<SurfaceTriangle> triangles(mesh.triangle_count());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    triangles[k].face = mesh.patches[k];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = mesh.indices[3 * k + c];
      triangles[k].parameters[c] = {mesh.parameters[2 * v], mesh.parameters[2 * v + 1]};
      triangles[k].corners[c] =
          mesh.origin + Vec3{mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
    }
  }
  return triangles;
}

double largest_distance(std::span<const SurfaceTriangle> mesh, FacePoint at, int steps) {
  Neighbours neighbours(mesh);
  double most = 0;
  for (std::uint32_t k = 0; k < mesh.size(); ++k) {
    const SurfaceTriangle& t = mesh[k];
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double a = double(i) / steps, b = double(j) / steps, c = double(steps - i - j) / steps;
        const auto mixed = [&](std::size_t d) {
          return a * t.parameters[0][d] + b * t.parameters[1][d] + c * t.parameters[2][d];
        };
        const Vec3 p = at(t.face, mixed(0), mixed(1));
        double least = distance(p, t);
        if (least <= most) continue;
        neighbours.visit_rings(
            k, [&](std::uint32_t other) { least = std::min(least, distance(p, mesh[other])); },
            [&] { return least > most; });
        most = std::max(most, least);
      }
  }
  return most;
}

}  // namespace tessera::bench
