#pragma once
// How far a mesh and its patches lie apart, by samples of both. Shares no code with the bounds that plans are made
// with.

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "support/triangle_distance.h"
#include "tessera/bezier_operations.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"

namespace tessera::test {

/// The triangles of a mesh in double, by patch. Quads are divided along either diagonal.
class SampledMesh {
 public:
  struct Face {
    std::array<std::uint32_t, 3> vertices;
    std::array<Vec3, 3> corners;
  };

  SampledMesh(const Mesh& mesh, std::size_t patches, bool other_diagonal) : mesh_(mesh), faces_(patches) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::uint32_t* const k = &mesh.indices[3 * t];
      add(mesh.patches[t], {k[0], k[1], k[2]});
    }
    for (std::size_t q = 0; q < mesh.quad_count(); ++q) {
      const std::uint32_t *const k = &mesh.quads[4 * q], patch = mesh.quad_patches[q];
      const std::size_t from = other_diagonal ? 1 : 0;
      add(patch, {k[from], k[from + 1], k[from + 2]});
      add(patch, {k[from], k[from + 2], k[(from + 3) % 4]});
    }
  }

  const std::vector<Face>& faces(std::size_t patch) const { return faces_[patch]; }
  Vec3 position(std::size_t vertex) const {
    const std::size_t k = 3 * vertex;
    if (!mesh_.model_positions.empty())
      return {mesh_.model_positions[k], mesh_.model_positions[k + 1], mesh_.model_positions[k + 2]};
    return mesh_.origin + Vec3{mesh_.positions[k], mesh_.positions[k + 1], mesh_.positions[k + 2]};
  }

  /// The distance of a point from the mesh, or the first one found that is at most `enough`; faces of the patch first.
  double distance(const Vec3& p, std::size_t patch, double enough) const {
    double nearest = distance_to(p, patch, enough, std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < faces_.size() && !(nearest <= enough); ++k)
      nearest = distance_to(p, k, enough, nearest);
    return nearest;
  }

 private:
  void add(std::uint32_t patch, const std::array<std::uint32_t, 3>& k) {
    faces_[patch].push_back({k, {position(k[0]), position(k[1]), position(k[2])}});
  }
  double distance_to(const Vec3& p, std::size_t patch, double enough, double nearest) const {
    for (const Face& face : faces_[patch]) {
      nearest = std::min(nearest, distance_to_triangle(p, face.corners[0], face.corners[1], face.corners[2]));
      if (nearest <= enough) break;
    }
    return nearest;
  }

  const Mesh& mesh_;
  std::vector<std::vector<Face>> faces_;  ///< `[patch]`
};

/// The distance of a point from a patch, or one found that is at most `enough`: the best of a grid, and descents from
/// its best places. Never less than the true distance; more by up to about 1e-8 of the patch's size.
inline double distance_to_patch(const BezierPatch& patch, const Vec3& p, double enough) {
  for (const int grid : {6, 40}) {
    struct Place {
      double distance, u, v;
    };
    std::vector<Place> places;
    for (int i = 0; i <= grid; ++i)
      for (int j = 0; j <= grid; ++j) {
        const double u = double(i) / grid, v = double(j) / grid;
        places.push_back({length(de_casteljau(patch, u, v) - p), u, v});
        if (places.back().distance <= enough) return places.back().distance;
      }
    std::ranges::sort(places, {}, &Place::distance);
    double nearest = places.front().distance;
    for (std::size_t k = 0; k < 6; ++k) {
      Place at = places[k];
      for (double step = 0.5 / grid; step > 1e-10;) {
        const Place before = at;
        for (int way = 0; way < 8; ++way) {
          constexpr int along_u[] = {1, -1, 0, 0, 1, 1, -1, -1}, along_v[] = {0, 0, 1, -1, 1, -1, 1, -1};
          const double u = std::clamp(before.u + step * along_u[way], 0.0, 1.0),
                       v = std::clamp(before.v + step * along_v[way], 0.0, 1.0),
                       distance = length(de_casteljau(patch, u, v) - p);
          if (distance < at.distance) at = {distance, u, v};
        }
        if (at.distance <= enough) return at.distance;
        if (at.distance == before.distance) step /= 2;
      }
      nearest = std::min(nearest, at.distance);
    }
    if (nearest <= enough) return nearest;
    if (grid == 40) return nearest;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace tessera::test
