#pragma once
// Triangulates polygons with holes in the parameter plane.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plane/funnel.h"
#include "plane/sweep_line.h"
#include "plane/sweep_points.h"

namespace tessera { inline namespace abi_0_1 {

/// A straight segment between two of a list of points.
struct PlaneSegment {
  std::uint32_t start = 0, end = 0;
  friend bool operator==(const PlaneSegment&, const PlaneSegment&) = default;
};

/// The triangles of a region between straight segments, by a sweep over its points. A point is inside if a path from
/// far away to it crosses an odd number of border segments. So the order and the direction of segments do not count.
///
/// The triangles are counter-clockwise, with an area above zero; all signs are exact. Each border segment is an edge of
/// one triangle, which lies inside; other edges belong to two triangles. Every point of the region is a corner. These
/// cases are defined:
///
/// - Equal points count as the first of them. Segments between equal points drop out.
/// - A point on a segment divides it, so borders may touch.
/// - Parts that an even number of border segments share drop out: slits bound nothing.
/// - Where two segments cross elsewhere, or a border is open, run() fails.
///
/// Time: O(n log n). Repeated calls of one size allocate nothing. An object serves one thread at a time.
class PolygonTriangles {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// Triangulates what `borders` bound. `cuts` are edges of triangles as well, where they lie inside; they bound
  /// nothing. Points: finite, less than 2^31; those of no segment become corners where they lie inside. Returns false,
  /// and has no triangles, if segments cross or a border is open.
  bool run(std::span<const ParameterPoint> points, std::span<const PlaneSegment> borders,
           std::span<const PlaneSegment> cuts = {});
  /// Triangulates what closed rings bound. Ring k holds the points from ends[k - 1], or 0, up to ends[k].
  bool run_rings(std::span<const ParameterPoint> points, std::span<const std::uint32_t> ends);

  /// The triangles of the last run, by indices of its points.
  std::span<const Triangle> triangles() { return funnels_.triangles(); }
  /// Whether a point of the last run lies inside a border segment, or two of these lie on each other.
  bool has_divided_borders() const { return has_divided_borders_; }
  /// The point that stands for an equal one.
  std::uint32_t first_equal(std::uint32_t point) const { return points_.index_of(points_.rank_of(point)); }

 private:
  enum Kind : std::uint8_t { border = 1, cut = 2 };  // bits: a cut may lie on a border
  struct Edge {
    std::uint32_t start, end;  ///< ranks
    std::uint32_t next_start;  ///< the next edge that starts where this one does
    std::uint32_t next_end;    ///< the next edge that ends where this one does
    std::uint32_t place;       ///< on the sweep line
    std::uint8_t kinds;
  };
  /// The edges that end in a point, as places on the line from below to above; the place below them.
  struct Ending {
    std::uint32_t below, lowest = no_id, highest = no_id;
    bool any() const { return lowest != no_id; }
  };

  void begin(std::span<const ParameterPoint> points, std::size_t segments);
  void add_edge(std::uint32_t start, std::uint32_t end, std::uint8_t kinds);
  bool sweep();
  bool visit(std::uint32_t rank);
  bool visit_any(std::uint32_t rank);
  bool find_ending(std::uint32_t rank, Ending& ending);
  void divide(std::uint32_t place, std::uint32_t rank);
  void sort_starting(std::uint32_t rank);
  void overlap(std::size_t k, std::uint32_t edge);
  void forget_end(std::uint32_t edge);
  Gap advance_gaps(std::uint32_t rank, const Ending& ending);
  void replace(std::uint32_t rank, const Ending& ending, const Gap& above);
  void start(std::uint32_t place, std::uint32_t edge, const Gap& gap);
  std::uint32_t borders_starting() const;

  SweepPoints points_;
  std::vector<Edge> edges_;
  bool has_divided_borders_ = false;
  std::vector<std::uint32_t> starting_, ending_;  ///< by rank, the first edge of a list
  std::vector<std::uint32_t> fan_;                ///< the edges that start in a point, from below to above
  SweepLine line_;
  Funnels funnels_;
};

}}  // namespace tessera::abi_0_1
