#include "tess/trimmed/vertex_merger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tess/trimmed/patch_points.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Edges up to this many times the rounding are looked at: bounds of their lengths may be far too large.
constexpr double max_edge = 1024;

bool is_end(double t) { return t == 0 || t == 1; }
/// The number of sides of the patch that a vertex lies on.
int sides_of(const ParameterPoint& at) { return is_end(at.u) + is_end(at.v); }
bool share_a_side(const ParameterPoint& a, const ParameterPoint& b) {
  return (is_end(a.u) && a.u == b.u) || (is_end(a.v) && a.v == b.v);
}

/// A position by its bits. (g++ 12 leaves out double(float(x)) where it vectorizes.)
DoublePositionBits rounded_position(const VertexRounding& rounding, const Vec3& p) {
  if (rounding.is_double) {
    const Vec3 moved = rounding.origin + p;
    return position_bits(std::array{moved.x, moved.y, moved.z}.data());
  }
  const std::array floats{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  const PositionBits bits = position_bits(floats.data());
  return {bits[0], bits[1], bits[2]};
}

}  // namespace

bool VertexMerger::find(const VertexRounding& rounding, const SpeedBound& speed,
                        std::span<const ParameterPoint> vertices, std::span<const Triangle> triangles) {
  short_edges_.clear();
  for (const Triangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      const double du = std::abs(vertices[a].u - vertices[b].u), dv = std::abs(vertices[a].v - vertices[b].v);
      if (speed.u * du + speed.v * dv <= max_edge * rounding.distance) short_edges_.emplace_back(a, b);
    }
  if (short_edges_.empty()) return false;
  parents_.resize(vertices.size());
  std::iota(parents_.begin(), parents_.end(), 0u);
  positions_.clear();
  PatchPoints points(*rounding.patch, rounding.origin);
  const auto position = [&](std::uint32_t vertex) {
    const auto [at, is_new] = positions_.try_emplace(vertex);
    if (is_new) at->second = rounded_position(rounding, points.at(vertices[vertex]));
    return at->second;
  };
  bool any = false;
  for (const auto& [a, b] : short_edges_) {
    if (position(a) != position(b)) continue;
    join(a, b, vertices);
    any = any || kept(a) == kept(b);
  }
  return any;
}

void VertexMerger::join(std::uint32_t a, std::uint32_t b, std::span<const ParameterPoint> vertices) {
  a = kept(a), b = kept(b);
  if (a == b) return;
  const int sides_a = sides_of(vertices[a]), sides_b = sides_of(vertices[b]);
  if (sides_a > 0 && sides_b > 0 && (sides_a + sides_b > 3 || !share_a_side(vertices[a], vertices[b]))) return;
  if (sides_b > sides_a || (sides_b == sides_a && b < a)) std::swap(a, b);
  parents_[b] = a;
}

std::uint32_t count_lone_edges(std::span<const VertexMerger::Triangle> triangles) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * triangles.size());
  for (const VertexMerger::Triangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = triangle[k], b = triangle[(k + 1) % 3];
      edges.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
  std::ranges::sort(edges);
  std::uint32_t lone = 0;
  for (std::size_t from = 0, to = 0; from < edges.size(); from = to) {
    while (to < edges.size() && edges[to] == edges[from]) ++to;
    lone += to - from == 1;
  }
  return lone;
}

}}  // namespace tessera::abi_0_1
