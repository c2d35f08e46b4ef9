#pragma once
// The triangles of a cut patch's band, with the neighbour across each edge.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Links triangles that share an edge, and divides them. An object serves one thread at a time.
class BandMesh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  /// The edge of a triangle from its corner `corner` to the next one.
  struct Edge {
    std::uint32_t triangle = no_id, corner = 0;
    bool exists() const { return triangle != no_id; }
  };

  /// Links the triangles from `first` on, which are counter-clockwise. An edge has a neighbour if exactly one other
  /// triangle runs along it, in the other direction. `triangles` must outlive the links.
  void link(std::vector<Triangle>& triangles, std::size_t first);
  std::uint32_t begin() const { return first_; }
  std::uint32_t end() const { return static_cast<std::uint32_t>(triangles_->size()); }
  const Triangle& triangle(std::uint32_t t) const { return (*triangles_)[t]; }
  std::uint32_t start(Edge edge) const { return triangle(edge.triangle)[edge.corner]; }
  std::uint32_t finish(Edge edge) const { return triangle(edge.triangle)[next(edge.corner)]; }
  std::uint32_t apex(Edge edge) const { return triangle(edge.triangle)[before(edge.corner)]; }
  /// Returns the edge as the neighbour has it.
  Edge across(Edge edge) const { return links_[edge.triangle - first_][edge.corner]; }

  /// Divides both triangles of an edge that has a neighbour, at the vertex `middle` on it. The two new triangles are
  /// appended: first that of `edge`'s triangle, then that of the neighbour.
  void divide(Edge edge, std::uint32_t middle);

  /// Replaces an edge that has a neighbour by the other diagonal of its two triangles, from c to d. With a and b the
  /// edge's ends, its triangle becomes (a, d, c), the neighbour (b, c, d). Returns false, and does nothing, if the two
  /// share another edge as well.
  bool flip(Edge edge);
  /// The triangles that flip() makes of the edge's triangle and of the neighbour.
  std::pair<Triangle, Triangle> flipped(Edge edge) const;

  static std::uint32_t next(std::uint32_t corner) { return corner == 2 ? 0 : corner + 1; }
  static std::uint32_t before(std::uint32_t corner) { return corner == 0 ? 2 : corner - 1; }

 private:
  void join(Edge a, Edge b);

  std::vector<Triangle>* triangles_ = nullptr;
  std::uint32_t first_ = 0;
  std::vector<std::array<Edge, 3>> links_;
  std::vector<std::pair<std::uint64_t, Edge>> by_ends_;  ///< a table of link(): edges by their ends, the smaller first
};

}}  // namespace tessera::abi_0_1
