// Orders triangles for the cache of vertices: fans around one vertex after the other, the next one among those still in
// the cache (Sander, Nehab and Barczak 2007, Fast triangle reordering for vertex locality and reduced overdraw).

#include <algorithm>
#include <string>
#include <vector>

#include "base/text.h"
#include "tess/cells/mesh_faces.h"
#include "tess/mesh/mesh_parts.h"
#include "tessera/gpu_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::uint32_t none = ~0u;

/// Orders a run of a mesh's triangles.
class FanOrder {
 public:
  FanOrder(const Mesh& mesh, int cache)
      : mesh_(mesh), cache_(static_cast<std::uint32_t>(cache)), local_(mesh.vertex_count(), none) {}

  /// Returns the triangles from `begin` to `end` in their new order.
  std::vector<std::uint32_t> run(std::size_t begin, std::size_t end) {
    collect(begin, end);
    std::vector<std::uint32_t> order;
    order.reserve(end - begin);
    for (std::uint32_t fan = next_live(); fan != none; fan = next_fan()) {
      around_.clear();
      for (std::uint32_t k = first_[fan]; k < first_[fan + 1]; ++k) {
        const std::uint32_t triangle = triangles_[k];
        if (is_out_[triangle]) continue;
        is_out_[triangle] = 1;
        order.push_back(static_cast<std::uint32_t>(begin + triangle));
        for (std::size_t c = 0; c < 3; ++c) use(corners_[3 * triangle + c]);
      }
    }
    for (const std::uint32_t vertex : vertices_) local_[vertex] = none;
    return order;
  }

 private:
  /// Numbers the run's vertices, and lists the triangles at each.
  void collect(std::size_t begin, std::size_t end) {
    vertices_.clear(), corners_.clear(), around_.clear(), recent_.clear();
    for (std::size_t k = 3 * begin; k < 3 * end; ++k) {
      std::uint32_t& local = local_[mesh_.indices[k]];
      if (local == none) {
        local = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(mesh_.indices[k]);
      }
      corners_.push_back(local);
    }
    live_.assign(vertices_.size(), 0), entered_.assign(vertices_.size(), 0);
    for (const std::uint32_t corner : corners_) ++live_[corner];
    first_.assign(vertices_.size() + 1, 0);
    for (std::size_t v = 0; v < live_.size(); ++v) first_[v + 1] = first_[v] + live_[v];
    triangles_.resize(corners_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t k = 0; k < corners_.size(); ++k) triangles_[next[corners_[k]]++] = k / 3;
    is_out_.assign(end - begin, 0);
    time_ = cache_ + 1, lowest_ = 0;
  }
  void use(std::uint32_t vertex) {
    around_.push_back(vertex), recent_.push_back(vertex);
    --live_[vertex];
    if (time_ - entered_[vertex] > cache_) entered_[vertex] = time_++;
  }
  /// The vertex of the last fan that will still be in the cache when its own fan is out, and entered it first. Without
  /// one, the last used vertex with triangles left, or else the first of all.
  std::uint32_t next_fan() {
    std::uint32_t best = none, oldest = 0;
    for (const std::uint32_t vertex : around_) {
      if (live_[vertex] == 0) continue;
      const std::uint32_t age = time_ - entered_[vertex];
      const std::uint32_t rank = age + 2 * live_[vertex] <= cache_ ? age : 0;
      if (best == none || rank > oldest) best = vertex, oldest = rank;
    }
    for (; best == none && !recent_.empty(); recent_.pop_back())
      if (live_[recent_.back()] > 0) best = recent_.back();
    return best == none ? next_live() : best;
  }
  std::uint32_t next_live() {
    while (lowest_ < live_.size() && live_[lowest_] == 0) ++lowest_;
    return lowest_ < live_.size() ? lowest_ : none;
  }

  const Mesh& mesh_;
  const std::uint32_t cache_;
  std::vector<std::uint32_t> local_;               ///< `[vertex of the mesh]`: its number in the run
  std::vector<std::uint32_t> vertices_, corners_;  ///< the run's vertices; three per triangle, by their numbers
  std::vector<std::uint32_t> first_, triangles_;   ///< the triangles at each vertex
  std::vector<std::uint32_t> live_, entered_;      ///< `[vertex]`: triangles left, and when it entered the cache
  std::vector<std::uint8_t> is_out_;               ///< `[triangle]`
  std::vector<std::uint32_t> around_, recent_;     ///< vertices of the last fan; of all fans
  std::uint32_t time_ = 0, lowest_ = 0;
};

}  // namespace

Status order_for_vertex_cache(Mesh& mesh, int cache_size) {
  return guarded([&]() -> Status {
    if (cache_size < 3 || cache_size > 1024)
      return {StatusCode::invalid_argument,
              "the cache holds " + std::to_string(cache_size) + " vertices, it must be from 3 to 1024"};
    if (Status status = check_face_corners("triangle", mesh.indices, 3, mesh.vertex_count()); !status.ok())
      return status;
    const std::size_t count = mesh.triangle_count();
    if (!mesh.patches.empty() && mesh.patches.size() != count)
      return {StatusCode::count_mismatch,
              counted(mesh.patches.size(), "patch", "patches") + " for " + counted(count, "triangle")};
    if (Status status = check_parts(mesh); !status.ok()) return status;
    FanOrder fans(mesh, cache_size);
    std::vector<std::uint32_t> order;
    const auto add = [&](std::size_t begin, std::size_t end) {
      const std::vector<std::uint32_t> of = fans.run(begin, end);
      order.insert(order.end(), of.begin(), of.end());
    };
    for (const MeshPart& part : mesh.parts) add(part.first_triangle, part.first_triangle + part.triangle_count);
    if (mesh.parts.empty()) add(0, count);
    std::vector<std::uint32_t> indices(mesh.indices.size()), patches(mesh.patches.size());
    for (std::size_t k = 0; k < count; ++k) {
      std::copy_n(mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * order[k]), 3,
                  indices.begin() + static_cast<std::ptrdiff_t>(3 * k));
      if (!patches.empty()) patches[k] = mesh.patches[order[k]];
    }
    mesh.indices = std::move(indices), mesh.patches = std::move(patches);
    return {};
  });
}

}}  // namespace tessera::abi_0_1
