#pragma once
// Halves the triangles of a cut patch that are too large for its tolerance.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "base/function_ref.h"
#include "plane/band_mesh.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Divides large triangles by the middle of their longest edge, together with the neighbour there (Rivara 1984,
/// Algorithms for refining triangular grids). An object serves one thread at a time.
class BandRefiner {
 public:
  using Triangle = BandMesh::Triangle;

  /// The demands on triangles. Vertices are named by their numbers.
  struct Demands {
    FunctionRef<bool(const Triangle&)> is_large;
    /// The measure of an edge, 0 if it must not be halved. See run() for what makes halving end.
    FunctionRef<double(std::uint32_t a, std::uint32_t b)> length;
    /// The parameters between two vertices, the ends of an edge whose triangles have the other corners c and d.
    FunctionRef<ParameterPoint(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)> middle;
    std::uint64_t max_triangles;
    const std::atomic<bool>* cancel;  ///< looked at before each division, unless null
  };

  /// Divides triangles [first, end) until none is too large, or no edge can be halved that would make it smaller: edges
  /// with a single triangle stay whole. New vertices are appended. Returns false, and stops, where there would be more
  /// than max_triangles. If cancelled, it stops as well.
  ///
  /// It ends if `length` is a function of an edge's width and height in the parameters, that
  /// - grows with both, and is continuous where it is not 0;
  /// - is at least some fixed size for the longest edge of a large triangle, unless it is 0;
  /// - is at most 3/4 as large for a half of an edge, unless it is 0; where it is 0 for an edge, it is 0 for shorter
  ///   ones in the same direction.
  bool run(std::vector<ParameterPoint>& vertices, std::vector<Triangle>& triangles, std::size_t first,
           const Demands& demands);

 private:
  /// How often a triangle and those that it comes from may be divided at an edge that is not their longest.
  static constexpr std::uint8_t max_odd_divisions = 3;

  struct LongestEdge {
    BandMesh::Edge edge;
    double length;
  };
  LongestEdge longest_edge(std::uint32_t triangle, const Demands& demands) const;
  /// Returns an edge whose division makes a large triangle smaller, or brings that nearer; none if there is none.
  BandMesh::Edge find_edge(std::uint32_t triangle, const Demands& demands) const;
  void divide(BandMesh::Edge edge, std::vector<ParameterPoint>& vertices, const Demands& demands);

  BandMesh mesh_;
  std::vector<std::uint32_t> large_;
  std::vector<std::uint8_t> odd_divisions_;  ///< by triangle from the first on
};

}}  // namespace tessera::abi_0_1
