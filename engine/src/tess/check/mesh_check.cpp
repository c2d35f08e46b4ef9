#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/point_tree.h"
#include "base/text.h"
#include "tess/edges/position_bits.h"
#include "tessera/geometry.h"
#include "tessera/guard.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool lies_inside(const Vec3& p, const Vec3& a, const Vec3& b, double reach) {
  const Vec3 edge = b - a;
  const double t = dot(p - a, edge) / dot(edge, edge);
  return t >= 1e-3 && t <= 1 - 1e-3 && length(p - (a + t * edge)) <= reach;
}

/// Returns how many of the vertices at the ends of `edges` lie inside another edge: at most 1e-6 of its length plus
/// `rounding` (relative to its largest coordinate) beside it, and at least 1e-3 of its length from its ends.
std::size_t count_t_junctions(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 2>> edges,
                              double rounding) {
  std::vector<std::uint32_t> ends;
  for (const auto& edge : edges)
    for (const std::uint32_t end : edge)
      if (is_finite(vertices[end])) ends.push_back(end);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Vec3> points;
  for (const std::uint32_t end : ends) points.push_back(vertices[end]);
  const PointTree tree(std::move(points));
  std::vector<std::uint32_t> found;
  for (const auto& [first, second] : edges) {
    const Vec3 &a = vertices[first], &b = vertices[second];
    if (!is_finite(a) || !is_finite(b)) continue;
    const double reach = 1e-6 * length(b - a) + rounding * std::max(max_abs(a), max_abs(b));
    Box3 box;
    box.extend(a);
    box.extend(b);
    const Vec3 margin{reach, reach, reach};
    box = {box.lower - margin, box.upper + margin};
    tree.visit_box(box, [&, first = first, second = second](std::uint32_t end) {
      const std::uint32_t k = ends[end];
      if (k != first && k != second && lies_inside(vertices[k], a, b, reach)) found.push_back(k);
    });
  }
  std::sort(found.begin(), found.end());
  return static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

/// The limit of an edge's 32 bits, which hold a vertex and a direction.
constexpr std::size_t max_vertices = std::size_t{1} << 31;

/// The positions that are checked: those in double if there are any, else those in float.
struct FloatPlaces {
  static constexpr double rounding = 0x1p-23;
  const Mesh& mesh;
  PositionBits bits(std::size_t vertex) const { return position_bits(&mesh.positions[3 * vertex]); }
  Vec3 at(std::size_t vertex) const {
    const float* const p = &mesh.positions[3 * vertex];
    return {p[0], p[1], p[2]};
  }
};
struct DoublePlaces {
  static constexpr double rounding = 0x1p-52;
  const Mesh& mesh;
  DoublePositionBits bits(std::size_t vertex) const { return position_bits(&mesh.model_positions[3 * vertex]); }
  Vec3 at(std::size_t vertex) const {
    const double* const p = &mesh.model_positions[3 * vertex];
    return {p[0], p[1], p[2]};
  }
};

struct Welded {
  std::vector<std::uint32_t> place;  ///< `[vertex]`: the number of its position, 0 .. count - 1
  std::size_t count = 0;
};

/// Numbers the distinct positions, by a hash table with open addressing of the first vertex at each.
template <class Places>
Welded weld(const Mesh& mesh, const Places& places) {
  Welded welded;
  welded.place.resize(mesh.vertex_count());
  std::vector<std::uint32_t> table(std::bit_ceil(2 * mesh.vertex_count() + 1), no_id);
  const std::size_t mask = table.size() - 1;
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const auto bits = places.bits(k);
    std::size_t slot = hash(bits) & mask;
    while (table[slot] != no_id && places.bits(table[slot]) != bits) slot = (slot + 1) & mask;
    if (table[slot] == no_id) {
      table[slot] = static_cast<std::uint32_t>(k);
      welded.place[k] = static_cast<std::uint32_t>(welded.count++);
    } else {
      welded.place[k] = welded.place[table[slot]];
    }
  }
  return welded;
}

Status check_counts(const Mesh& mesh) {
  const auto bad = [](std::string message) { return Status(StatusCode::invalid_argument, std::move(message)); };
  const auto fits = [](const auto& values, std::size_t wanted) { return values.empty() || values.size() == wanted; };
  if (mesh.positions.size() % 3 != 0)
    return bad(std::to_string(mesh.positions.size()) + " numbers in positions are not three per vertex");
  if (mesh.indices.size() % 3 != 0)
    return bad(std::to_string(mesh.indices.size()) + " indices are not three per triangle");
  if (mesh.quads.size() % 4 != 0) return bad(std::to_string(mesh.quads.size()) + " indices are not four per quad");
  if (mesh.vertex_count() > max_vertices)
    return bad(std::to_string(mesh.vertex_count()) + " vertices are more than " + std::to_string(max_vertices));
  if (!fits(mesh.model_positions, mesh.positions.size()))
    return bad(std::to_string(mesh.model_positions.size()) + " numbers in positions in double, " +
               std::to_string(mesh.positions.size()) + " in positions");
  if (!fits(mesh.normals, mesh.positions.size()))
    return bad(std::to_string(mesh.normals.size()) + " numbers in normals, " + std::to_string(mesh.positions.size()) +
               " in positions");
  if (!fits(mesh.parameters, 2 * mesh.vertex_count()))
    return bad(std::to_string(mesh.parameters.size()) + " numbers in parameters for " +
               std::to_string(mesh.vertex_count()) + " vertices");
  if (!fits(mesh.patches, mesh.triangle_count()))
    return bad(counted(mesh.patches.size(), "patch", "patches") + " for " + counted(mesh.triangle_count(), "triangle"));
  if (!fits(mesh.quad_patches, mesh.quad_count()))
    return bad(counted(mesh.quad_patches.size(), "patch", "patches") + " for " + counted(mesh.quad_count(), "quad"));
  return {};
}

/// Checks that all indices are vertices. `corners`: the number per face.
Status check_indices(std::span<const std::uint32_t> indices, std::ptrdiff_t corners, const char* face,
                     std::size_t vertices) {
  const auto bad = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t k) { return k >= vertices; });
  if (bad == indices.end()) return {};
  const std::ptrdiff_t place = bad - indices.begin();
  return {StatusCode::invalid_argument,
          "corner " + std::to_string(place % corners) + " of " + face + " " + std::to_string(place / corners) +
              " is vertex " + std::to_string(*bad) + ", the mesh has " + std::to_string(vertices),
          place};
}

template <class Places>
std::size_t count_non_finite(const Mesh& mesh, const Places& places) {
  const auto finite = [](const float* p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); };
  std::size_t count = 0;
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k)
    count += !is_finite(places.at(k)) || (!mesh.normals.empty() && !finite(&mesh.normals[3 * k]));
  return count;
}

Vec3 vertex(const std::vector<float>& values, std::size_t k) {
  return {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}

using Triangle = std::array<std::uint32_t, 3>;

/// Whether the corners of a triangle are collinear. Products of differences of floats are exact in double unless their
/// exponents lie far apart, so no tolerance is needed.
template <class Places>
bool has_no_area(const Places& places, const Triangle& corners) {
  const auto point = [&](std::size_t k) { return places.at(corners[k]); };
  return cross(point(1) - point(0), point(2) - point(0)) == Vec3{};
}

/// The edges of triangles, grouped by their lower vertex. An edge is stored as twice its upper vertex, plus 1 if it
/// runs from that vertex to the lower one.
class EdgeTable {
 public:
  EdgeTable(const std::vector<Triangle>& triangles, std::size_t vertices) : first_(vertices + 1) {
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) ++first_[std::min(t[k], t[(k + 1) % 3]) + 1];
    for (std::size_t k = 0; k < vertices; ++k) first_[k + 1] += first_[k];
    edges_.resize(first_[vertices]);
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        edges_[next[std::min(a, b)]++] = 2 * std::max(a, b) + (a > b);
      }
  }

  /// Counts the faults of edges; also lists the open edges.
  void count_into(MeshReport& report, std::vector<std::array<std::uint32_t, 2>>& open) {
    for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
      const std::span<std::uint32_t> edges(edges_.data() + first_[k], first_[k + 1] - first_[k]);
      std::sort(edges.begin(), edges.end());
      for (std::size_t from = 0, to = 0; from < edges.size(); from = to) {
        while (to < edges.size() && edges[to] / 2 == edges[from] / 2) ++to;
        if (to - from == 1) open.push_back({static_cast<std::uint32_t>(k), edges[from] / 2});
        report.inconsistent_edges += to - from == 2 && edges[from] == edges[from + 1];
        report.non_manifold_edges += to - from > 2;
      }
    }
    report.open_edges = open.size();
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> edges_;
};

/// Whether the triangle faces away from the sum of the normals at its corners.
template <class Places>
bool is_flipped(const Mesh& mesh, const Places& places, const Triangle& corners) {
  const auto at = [&](std::size_t k) { return places.at(corners[k]); };
  Vec3 normals;
  for (const std::uint32_t corner : corners) normals += vertex(mesh.normals, corner);
  return dot(cross(at(1) - at(0), at(2) - at(0)), normals) < 0;
}

template <class Places>
MeshReport count(const Mesh& mesh, const Places& places) {
  MeshReport report;
  const Welded welded = weld(mesh, places);
  report.vertices = mesh.vertex_count();
  report.distinct_positions = welded.count;
  report.triangles = mesh.triangle_count() + 2 * mesh.quad_count();
  report.quads = mesh.quad_count();
  report.non_finite_vertices = count_non_finite(mesh, places);
  std::vector<Triangle> sound;
  sound.reserve(report.triangles);
  const auto look_at = [&](const Triangle& corners) {
    const Triangle t{welded.place[corners[0]], welded.place[corners[1]], welded.place[corners[2]]};
    const bool is_point = t[0] == t[1] || t[1] == t[2] || t[2] == t[0],
               is_line = !is_point && has_no_area(places, corners);
    report.degenerate_triangles += is_point || is_line;
    if (!is_point) sound.push_back(t);  // a line fills a gap between edges whose vertices differ
    report.flipped_triangles += !is_point && !is_line && !mesh.normals.empty() && is_flipped(mesh, places, corners);
  };
  for (auto corner = mesh.indices.begin(); corner != mesh.indices.end(); corner += 3)
    look_at({corner[0], corner[1], corner[2]});
  for (auto corner = mesh.quads.begin(); corner != mesh.quads.end(); corner += 4) {
    look_at({corner[0], corner[1], corner[2]});
    look_at({corner[0], corner[2], corner[3]});
  }
  std::vector<std::array<std::uint32_t, 2>> open;
  EdgeTable(sound, welded.count).count_into(report, open);
  std::vector<Vec3> distinct(welded.count);
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) distinct[welded.place[k]] = places.at(k);
  report.t_junctions = count_t_junctions(distinct, open, Places::rounding);
  return report;
}

}  // namespace

Result<MeshReport> check(const Mesh& mesh) {
  return guarded([&]() -> Result<MeshReport> {
    if (Status status = check_counts(mesh); !status.ok()) return status;
    const std::size_t vertices = mesh.vertex_count();
    if (Status status = check_indices(mesh.indices, 3, "triangle", vertices); !status.ok()) return status;
    if (Status status = check_indices(mesh.quads, 4, "quad", vertices); !status.ok()) return status;
    return mesh.model_positions.empty() ? count(mesh, FloatPlaces{mesh}) : count(mesh, DoublePlaces{mesh});
  });
}

}}  // namespace tessera::abi_0_1
