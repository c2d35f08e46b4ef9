// Clusters: triangles are cut in halves along the longest side of the box of their middles, or of their normals where
// these differ more, until few are left.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/text.h"
#include "tess/cells/mesh_faces.h"
#include "tessera/gpu_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_cluster_triangles = 512, max_cluster_vertices = 256;

class ClusterMaker {
 public:
  ClusterMaker(const Mesh& mesh, std::span<const float> bounds, const ClusterOptions& options,
               const Execution& execution)
      : mesh_(mesh),
        bounds_(bounds),
        options_(options),
        cancel_(execution.cancel),
        middles_(mesh.triangle_count()),
        normals_(mesh.triangle_count()),
        places_(mesh.vertex_count(), 0),
        cluster_of_(mesh.vertex_count(), 0) {
    made_.triangles.resize(mesh.triangle_count());
    for (std::uint32_t t = 0; t < made_.triangles.size(); ++t) {
      made_.triangles[t] = t;
      const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      middles_[t] = (1.0 / 3) * (a + b + c);
      const Vec3 across = cross(b - a, c - a);
      const double size = length(across);
      if (size > 0) normals_[t] = (1 / size) * across;
    }
    made_.corners.resize(mesh.indices.size());
  }

  /// Makes the clusters of a run of triangles. Both halves are smaller, so it ends. Errors: cancelled.
  Status divide(std::size_t begin, std::size_t end) {
    if (cancel_ && cancel_->load(std::memory_order_relaxed)) return {StatusCode::cancelled, "cancelled"};
    const std::size_t count = end - begin, most = static_cast<std::size_t>(options_.max_triangles);
    if (count <= most && add(begin, end)) return {};
    const Longest middle_of = longest(middles_, begin, end), normal_of = longest(normals_, begin, end);
    // Normals that go all ways count as much as the whole box, so that opposite sides come apart.
    const bool by_normals = normal_of.size > 1.5;
    const std::vector<Vec3>& of = by_normals ? normals_ : middles_;
    double Vec3::*const along = (by_normals ? normal_of : middle_of).along;
    // Full clusters on one side: the fewest in all.
    const std::size_t half = count > most ? (count / 2 + most - 1) / most * most : count / 2;
    const std::size_t middle = begin + std::clamp<std::size_t>(half, 1, count - 1);
    const auto at = [this](std::size_t k) { return made_.triangles.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return of[a].*along != of[b].*along ? of[a].*along < of[b].*along : a < b;
    });
    const Status status = divide(begin, middle);
    return status.ok() ? divide(middle, end) : status;
  }
  MeshClusters take() && { return std::move(made_); }

 private:
  /// The longest side of a box.
  struct Longest {
    double Vec3::*along;
    double size;
  };
  Longest longest(const std::vector<Vec3>& of, std::size_t begin, std::size_t end) const {
    Box3 box;
    for (std::size_t k = begin; k < end; ++k) box.extend(of[made_.triangles[k]]);
    const Vec3 size = box.upper - box.lower;
    if (size.x >= size.y && size.x >= size.z) return {&Vec3::x, size.x};
    return size.y >= size.z ? Longest{&Vec3::y, size.y} : Longest{&Vec3::z, size.z};
  }
  Vec3 corner(std::size_t triangle, std::size_t k) const { return vertex_of(mesh_, mesh_.indices[3 * triangle + k]); }

  /// Makes one cluster; false if it has too many vertices.
  bool add(std::size_t begin, std::size_t end) {
    const auto at = [this](std::size_t k) { return made_.triangles.begin() + static_cast<std::ptrdiff_t>(k); };
    std::sort(at(begin), at(end));  // the order of the mesh suits caches of vertices
    const auto number = static_cast<std::uint32_t>(made_.clusters.size() + 1);
    MeshCluster cluster;
    cluster.first_triangle = static_cast<std::uint32_t>(begin);
    cluster.triangle_count = static_cast<std::uint32_t>(end - begin);
    cluster.first_vertex = static_cast<std::uint32_t>(made_.vertices.size());
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = mesh_.indices[3 * made_.triangles[k] + c];
        if (cluster_of_[vertex] != number) {
          if (cluster.vertex_count == static_cast<std::uint32_t>(options_.max_vertices)) {
            for (std::size_t v = cluster.first_vertex; v < made_.vertices.size(); ++v)
              cluster_of_[made_.vertices[v]] = 0;
            made_.vertices.resize(cluster.first_vertex);
            return false;
          }
          cluster_of_[vertex] = number;
          places_[vertex] = static_cast<std::uint8_t>(cluster.vertex_count++);
          made_.vertices.push_back(vertex);
          cluster.box.extend(vertex_of(mesh_, vertex));
        }
        made_.corners[3 * k + c] = places_[vertex];
      }
    describe(cluster);
    made_.clusters.push_back(cluster);
    return true;
  }

  /// Finds the cone of normals and the bound.
  void describe(MeshCluster& cluster) const {
    const std::span<const std::uint32_t> triangles =
        std::span(made_.triangles).subspan(cluster.first_triangle, cluster.triangle_count);
    Vec3 sum;
    for (const std::uint32_t t : triangles) sum = sum + normals_[t];
    const double size = length(sum);
    cluster.axis = size > 0 ? (1 / size) * sum : Vec3{0, 0, 1};
    double least = 1;
    for (const std::uint32_t t : triangles) {
      const Vec3& of = normals_[t];
      if (dot(of, of) > 0) least = std::min(least, dot(of, cluster.axis));
      cluster.bound = std::max(
          cluster.bound, bounds_.empty() ? std::numeric_limits<double>::infinity() : double(bounds_[mesh_.patches[t]]));
    }
    constexpr double rounding = 1e-12;
    cluster.spread = size > 0 ? std::acos(std::clamp(least - rounding, -1.0, 1.0)) : std::numbers::pi;
  }

  const Mesh& mesh_;
  std::span<const float> bounds_;
  const ClusterOptions& options_;
  const std::atomic<bool>* cancel_;
  std::vector<Vec3> middles_, normals_;    ///< `[triangle]`
  std::vector<std::uint8_t> places_;       ///< `[vertex]`, in the cluster that has it
  std::vector<std::uint32_t> cluster_of_;  ///< `[vertex]`: one more than the last cluster that has it
  MeshClusters made_;
};

}  // namespace

Result<MeshClusters> make_clusters(const Mesh& mesh, std::span<const float> bounds, const ClusterOptions& options,
                                   const Execution& execution) {
  return guarded([&]() -> Result<MeshClusters> {
    const auto check = [](const char* what, int value, int least, int most) {
      return value >= least && value <= most
                 ? Status()
                 : Status(StatusCode::invalid_argument, std::string(what) + " is " + std::to_string(value) +
                                                            ", it must be from " + std::to_string(least) + " to " +
                                                            std::to_string(most));
    };
    Status status = check("max_triangles", options.max_triangles, 1, max_cluster_triangles);
    if (status.ok()) status = check("max_vertices", options.max_vertices, 3, max_cluster_vertices);
    if (status.ok()) status = check_face_corners("triangle", mesh.indices, 3, mesh.vertex_count());
    if (status.ok() && !bounds.empty()) status = check_face_patches(mesh, bounds.size());
    if (!status.ok()) return status;
    ClusterMaker maker(mesh, bounds, options, execution);
    if (mesh.triangle_count() > 0) status = maker.divide(0, mesh.triangle_count());
    if (!status.ok()) return status;
    return std::move(maker).take();
  });
}

}}  // namespace tessera::abi_0_1
