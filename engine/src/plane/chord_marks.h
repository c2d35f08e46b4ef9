#pragma once
// The cells, grid lines and grid vertices that the chords of trimming loops meet.

#include <cstdint>
#include <span>
#include <vector>

#include "plane/grid_lines.h"
#include "plane/polygon_triangles.h"

namespace tessera { inline namespace abi_0_1 {

/// Lists of numbers, one list a key, that grow by one number at a time.
class NumberLists {
 public:
  void clear(std::size_t keys) {
    heads_.assign(keys, no_id);
    links_.clear();
  }
  void add(std::size_t key, std::uint32_t number) {
    links_.push_back({number, heads_[key]});
    heads_[key] = static_cast<std::uint32_t>(links_.size() - 1);
  }
  /// Calls visit(number) for each number of a list, the latest first, until one returns true. Returns whether one did.
  template <class Visit>
  bool any(std::size_t key, Visit visit) const {
    for (std::uint32_t link = heads_[key]; link != no_id; link = links_[link].next)
      if (visit(links_[link].number)) return true;
    return false;
  }

 private:
  struct Link {
    std::uint32_t number, next;
  };
  std::vector<std::uint32_t> heads_;
  std::vector<Link> links_;
};

/// The places where a patch's chords meet its grid. All but on_line() is decided in double, with margins far above
/// its rounding: a cell may count as met that a chord only comes close to.
class ChordMarks {
 public:
  /// A cell is met by chords that come nearer than this share of its size.
  static constexpr double margin = 0.1;
  /// A grid vertex is near a chord within this share of the smaller cells around it.
  static constexpr double near_share = 0.35;

  /// Marks what the chords meet. `points` and `grid` must outlive the marks. Points outside of the grid are not
  /// allowed.
  void set(const GridLines& grid, std::span<const ParameterPoint> points, std::span<const PlaneSegment> chords);

  const GridLines& grid() const { return grid_; }
  const ParameterPoint& point(std::uint32_t index) const { return points_[index]; }
  GridPlace cell_of(std::uint32_t point) const { return cells_of_points_[point]; }
  /// The first point that is a grid vertex exactly; no_id if none is.
  std::uint32_t point_at(std::uint32_t vertex) const { return points_at_[vertex]; }
  /// The chords that are not sides of cells.
  std::span<const PlaneSegment> chords() const { return chords_; }
  bool is_met(std::uint32_t cell) const { return met_[cell] != 0; }
  /// Whether a cell that is not met lies inside.
  bool is_cell_inside(std::uint32_t cell) const { return cells_inside_[cell] != 0; }
  /// Whether a vertex lies inside, seen along the line through it that runs along v, or u. Both are right unless a
  /// chord comes within rounding; then each fits the crossings on its line.
  bool is_inside_along_v(std::uint32_t vertex) const { return inside_along_v_[vertex] != 0; }
  bool is_inside_along_u(std::uint32_t vertex) const { return inside_along_u_[vertex] != 0; }
  /// Whether what follows a vertex along v, or u, lies inside. It differs from the vertex where a chord that is the
  /// side of a cell crosses the line there: crossings count for the vertices beyond them.
  bool is_inside_after_v(std::uint32_t vertex) const { return is_inside_along_v(vertex) != on_line_u(vertex); }
  bool is_inside_after_u(std::uint32_t vertex) const { return is_inside_along_u(vertex) != on_line_v(vertex); }
  /// The end of a chord near a vertex; no_id if no chord is near.
  std::uint32_t near_point(std::uint32_t vertex) const { return near_points_[vertex]; }
  /// Whether an odd number of chords are the side of a cell that runs along u, or v, from a vertex on.
  bool on_line_u(std::uint32_t vertex) const { return on_line_u_[vertex] != 0; }
  bool on_line_v(std::uint32_t vertex) const { return on_line_v_[vertex] != 0; }

  /// The chords that meet a cell, and those that cross the side along u, or v, from a vertex on; as places in chords().
  const NumberLists& of_cells() const { return of_cells_; }
  const NumberLists& across_u() const { return across_u_; }
  const NumberLists& across_v() const { return across_v_; }
  /// Calls visit(i, j) for the cells that a segment comes closer to than `share` of their size.
  template <class Visit>
  void for_cells(const ParameterPoint& p, GridPlace of_p, const ParameterPoint& q, GridPlace of_q, double share,
                 Visit visit) const;

 private:
  void clear(std::size_t points);
  void find_points();
  bool mark_side(const PlaneSegment& chord);
  void mark_near(const PlaneSegment& chord);
  void cross_u(const PlaneSegment& chord, bool is_side);
  void cross_v(const PlaneSegment& chord, bool is_side);
  std::uint32_t vertex_at(std::uint32_t point) const { return vertices_of_points_[point]; }

  GridLines grid_;
  std::span<const ParameterPoint> points_;
  std::vector<GridPlace> cells_of_points_;
  std::vector<std::uint32_t> vertices_of_points_;
  std::vector<PlaneSegment> chords_;
  std::vector<std::uint8_t> met_, cells_inside_, inside_along_v_, inside_along_u_, on_line_u_, on_line_v_;
  std::vector<std::uint32_t> points_at_, near_points_;
  std::vector<double> near_squares_;       ///< by vertex, the squared distance of the nearest chord, in shares
  std::vector<double> scale_u_, scale_v_;  ///< by line, one over the smaller cell beside it
  NumberLists of_cells_, across_u_, across_v_;
};

template <class Visit>
void ChordMarks::for_cells(const ParameterPoint& p, GridPlace of_p, const ParameterPoint& q, GridPlace of_q,
                           double share, Visit visit) const {
  const auto range = [&](double a, double b, std::uint32_t k, std::uint32_t n, std::uint32_t end, auto line) {
    std::uint32_t first = std::min(k, n), last = std::max(k, n);
    while (first > 0 && std::min(a, b) <= line(first) + share * (line(first) - line(first - 1))) --first;
    while (last + 1 < end && std::max(a, b) >= line(last + 1) - share * (line(last + 2) - line(last + 1))) ++last;
    return std::pair(first, last);
  };
  const auto [i0, i1] = range(p.u, q.u, of_p.i, of_q.i, grid_.columns(), [&](std::uint32_t i) { return grid_.u(i); });
  const auto [j0, j1] = range(p.v, q.v, of_p.j, of_q.j, grid_.rows(), [&](std::uint32_t j) { return grid_.v(j); });
  const double du = q.u - p.u, dv = q.v - p.v, mu = (p.u + q.u) / 2, mv = (p.v + q.v) / 2;
  for (std::uint32_t i = i0; i <= i1; ++i) {
    const double u = (grid_.u(i) + grid_.u(i + 1)) / 2, hu = (grid_.u(i + 1) - grid_.u(i)) * (0.5 + share);
    if (std::abs(u - mu) > hu + std::abs(du) / 2) continue;
    for (std::uint32_t j = j0; j <= j1; ++j) {
      const double v = (grid_.v(j) + grid_.v(j + 1)) / 2, hv = (grid_.v(j + 1) - grid_.v(j)) * (0.5 + share);
      if (std::abs(v - mv) > hv + std::abs(dv) / 2) continue;
      if (std::abs(du * (v - mv) - dv * (u - mu)) <= std::abs(du) * hv + std::abs(dv) * hu) visit(i, j);
    }
  }
}

}}  // namespace tessera::abi_0_1
