#pragma once
// The places of vertices along edges: stations with a common vertex are one place.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/union_find.h"
#include "tess/closing/station_vertices.h"

namespace tessera { inline namespace abi_0_1 {

/// Numbers of all vertices that may lie on edges, patch by patch: those of rings and of cut patches. Inserted vertices
/// follow.
class BoundaryNumbers {
 public:
  BoundaryNumbers(std::span<const Division> divisions, std::span<const CutPatch> cuts, std::size_t inserted);
  std::uint32_t of(const PatchVertex& vertex) const {
    return vertex.vertex & PatchVertex::inserted ? first_.back() + (vertex.vertex ^ PatchVertex::inserted)
                                                 : zeros_[vertex.patch] + vertex.vertex;
  }
  std::uint32_t count() const { return first_.back() + inserted_; }
  /// The number of a patch's first vertex; that of the first inserted one for the number of patches.
  std::uint32_t first(std::size_t patch) const { return first_[patch]; }
  /// The vertex of a patch that has a number.
  std::uint32_t vertex(std::size_t patch, std::uint32_t number) const { return number - zeros_[patch]; }

 private:
  std::vector<std::uint32_t> first_;  ///< by patch, and of the inserted ones
  std::vector<std::uint32_t> zeros_;  ///< by patch: the number that its vertex 0 would have, modulo 2^32
  std::uint32_t inserted_ = 0;        ///< their number
};

/// Finds the stations that are one place, and numbers the places.
class StationPlaces {
 public:
  /// `is_open`: by edge, whether the faces along it stay apart. All must outlive this object.
  StationPlaces(const PatchSet::Impl& set, const EdgeRuns& runs, const StationVertices& met,
                const BoundaryNumbers& numbers, std::span<const std::uint8_t> is_open);

  std::size_t count() const { return count_; }
  /// The place of a station of an edge that is not open; no_id where no faces meet: its vertices may be welded.
  std::uint32_t of(std::uint32_t station) const { return places_[station]; }
  /// Whether a station has a vertex that another one has too, or twice, or is where the shape states a vertex. All
  /// other stations are places of their own, and their vertices different ones.
  bool is_joined(std::uint32_t station) const { return is_joined_[station]; }
  /// The place of a vertex that the shape states.
  std::uint32_t of_shape_vertex(std::uint32_t vertex) const {
    const std::uint32_t station = shape_vertices_[vertex];
    return station == no_id ? no_id : places_[station];
  }
  /// Vertices of no such station that are one with others, and their places.
  std::span<const PatchVertex> others() const { return others_; }
  std::uint32_t of_other(std::size_t k) const { return places_[stations_ + k]; }
  /// Whether both ends of a segment that closes a gap are one place.
  bool is_point(const StationBlock::Gap& gap) const;

 private:
  void unite_stations();
  void unite_same();
  /// Makes a point of each line that closes a gap, if both of its ends are one place: its other vertices are there too.
  void join_gaps();
  void number_places();
  void meet(std::uint32_t& node, std::uint32_t station);
  void unite(std::uint32_t a, std::uint32_t b);
  /// The node of a vertex: its station, or a place behind the stations.
  std::uint32_t node_of(const PatchVertex& vertex);
  std::span<const StationBlock::Gap> gaps() const { return met_.blocks.back().gaps; }
  bool is_closed(const StationBlock::Edge& edge) const { return !is_open_[edge.edge]; }

  const EdgeRuns& runs_;
  const StationVertices& met_;
  const BoundaryNumbers& numbers_;
  std::span<const std::uint8_t> is_open_;
  std::uint32_t stations_;
  std::vector<std::uint32_t> nodes_;           ///< by number of a vertex
  std::vector<std::uint32_t> shape_vertices_;  ///< by vertex of the shapes: a station
  std::vector<PatchVertex> others_;
  UnionFind sets_;  ///< of nodes
  std::vector<std::uint8_t> is_joined_;
  std::vector<std::uint32_t> places_;  ///< by node
  std::size_t count_ = 0;
};

}}  // namespace tessera::abi_0_1
