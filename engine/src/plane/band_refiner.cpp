#include "plane/band_refiner.h"

namespace tessera { inline namespace abi_0_1 {

BandRefiner::LongestEdge BandRefiner::longest_edge(std::uint32_t triangle, const Demands& demands) const {
  LongestEdge longest{{triangle, 0}, -1};
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    const BandMesh::Edge edge{triangle, corner};
    const double length = demands.length(mesh_.start(edge), mesh_.finish(edge));
    if (length > longest.length) longest = {edge, length};
  }
  return longest;
}

// Goes from triangle to triangle across longest edges, which grow, up to one that is the longest of both its triangles.
BandMesh::Edge BandRefiner::find_edge(std::uint32_t triangle, const Demands& demands) const {
  const LongestEdge own = longest_edge(triangle, demands);
  for (LongestEdge longest = own; longest.length > 0;) {
    const BandMesh::Edge other = mesh_.across(longest.edge);
    if (!other.exists()) break;
    const LongestEdge next = longest_edge(other.triangle, demands);
    if (!(next.length > longest.length)) return longest.edge;
    longest = next;
  }
  const BandMesh::Edge other = own.length > 0 ? mesh_.across(own.edge) : BandMesh::Edge{};
  const bool may_be_divided = other.exists() && odd_divisions_[other.triangle - mesh_.begin()] < max_odd_divisions;
  return may_be_divided ? own.edge : BandMesh::Edge{};
}

void BandRefiner::divide(BandMesh::Edge edge, std::vector<ParameterPoint>& vertices, const Demands& demands) {
  const BandMesh::Edge other = mesh_.across(edge);
  const std::uint32_t a = mesh_.start(edge), b = mesh_.finish(edge), added = mesh_.end();
  const double length = demands.length(a, b);
  const auto odd_divisions = [&](std::uint32_t triangle) {
    const bool is_odd = longest_edge(triangle, demands).length > length;
    return static_cast<std::uint8_t>(odd_divisions_[triangle - mesh_.begin()] + is_odd);
  };
  for (const std::uint32_t triangle : {edge.triangle, other.triangle}) {
    odd_divisions_[triangle - mesh_.begin()] = odd_divisions(triangle);
    odd_divisions_.push_back(odd_divisions_[triangle - mesh_.begin()]);
  }
  const auto middle = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back(demands.middle(a, b, mesh_.apex(edge), mesh_.apex(other)));
  mesh_.divide(edge, middle);
  for (const std::uint32_t triangle : {edge.triangle, added, other.triangle, added + 1}) large_.push_back(triangle);
}

// Proof that it ends. If it did not, some triangle would have an endless row of descendants, each a half of the one
// before (König's lemma: each division makes two). They lie in each other, so they shrink to a segment, or a point. Of
// the edges that are divided, all but a few are the longest of these triangles, and at least as long as the longest
// edge of a large triangle: so they don't shrink to a point, and `length` grows along the segment. From some triangle
// on, each longest edge joins the surroundings of both ends of the segment. Its division leaves a half with one of
// these ends, and a half that reaches both only by its third corner, with a single edge between the ends. The division
// of that one leaves no triangle that reaches both ends: a contradiction.
//
// The walk over longest edges ends because they grow from one triangle to the next.
bool BandRefiner::run(std::vector<ParameterPoint>& vertices, std::vector<Triangle>& triangles, std::size_t first,
                      const Demands& demands) {
  large_.clear();
  for (std::size_t t = first; t < triangles.size(); ++t)
    if (demands.is_large(triangles[t])) large_.push_back(static_cast<std::uint32_t>(t));
  if (large_.empty()) return true;
  mesh_.link(triangles, first);
  odd_divisions_.assign(triangles.size() - first, 0);
  while (!large_.empty()) {
    const std::uint32_t triangle = large_.back();
    if (demands.is_large(triangles[triangle])) {
      if (demands.cancel && demands.cancel->load(std::memory_order_relaxed)) return true;
      if (const BandMesh::Edge edge = find_edge(triangle, demands); edge.exists()) {
        if (triangles.size() + 2 > demands.max_triangles) return false;
        divide(edge, vertices, demands);
        continue;
      }
    }
    large_.pop_back();
  }
  return true;
}

}}  // namespace tessera::abi_0_1
