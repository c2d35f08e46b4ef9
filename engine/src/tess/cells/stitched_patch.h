#pragma once
// Divides a patch whose borders have their own rates: an inner grid, a ring of border points, and strips between them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tess/cells/patch_side.h"
#include "tess/cells/segments.h"

namespace tessera { inline namespace abi_0_1 {

/// How a patch is divided. Vertices: first the inner points [iu - 1][iv - 1] where the segments of `inner` begin; then
/// the ring, border points where segments begin, counter-clockwise from (0,0), each corner once.
///
/// Along a parameter, no triangle's parameter box is wider than the segments asked for there. This holds for inner
/// cells, and for strips because the border has no longer segments.
///
/// A triangle crosses the middle of a parameter only if a segment of the patch or of its borders does. If only a
/// segment of a border does, then only triangles at this border do. They are no wider than its segments, or those of
/// the opposite border if one of these crosses the middle too.
struct Division {
  PatchSegments inner;               ///< both 1: no inner points
  std::array<Segments, 4> border{};  ///< by Side, along the parameter
  SideMask collapsed;                ///< borders that are points: no triangle stands on them
  bool empty = false;                ///< a curve or a point: no vertices, no triangles
  bool across_u = false;             ///< without inner points: triangles go from border u0 to u1, else from v0 to v1

  friend bool operator==(const Division& a, const Division& b) {
    return a.inner == b.inner && a.border == b.border && a.collapsed.bits == b.collapsed.bits && a.empty == b.empty &&
           a.across_u == b.across_u;
  }

  /// Divides a patch. `asked`: the segments that the patch needs; none of the segments of `borders` may be longer.
  static Division of(const PatchShape& shape, PatchSegments asked, const std::array<Segments, 4>& borders) {
    Division division;
    division.border = borders;
    division.set(shape, asked);
    return division;
  }
  /// Does what of() does in place, after the borders' segments were set: a copy of a new record would wait for its
  /// stores.
  void set(const PatchShape& shape, PatchSegments asked) {
    inner = {asked.u.rate() > 1 ? asked.u : 2, asked.v.rate() > 1 ? asked.v : 2};
    collapsed = shape.collapsed;
    empty = shape.is_curve;
    across_u = false;
    if (std::min(asked.u.rate(), asked.v.rate()) > 1) return;
    for (const bool way : {true, false}) {
      if (!joins_borders(shape, asked, border, way)) continue;
      inner = {1, 1};
      across_u = way;
      return;
    }
  }

  /// Whether all borders are points.
  bool has_one_corner() const {
    return std::ranges::all_of(all_sides, [this](Side side) { return collapsed.has(side); });
  }
  /// Adds inner points where a patch has no triangles, because opposite borders are points: so many that there are
  /// some.
  void add_inner_points(PatchSegments asked) {
    const int least = has_one_corner() ? 4 : 2;  // even, so that no cell crosses the middle
    inner = {asked.u.rate() >= least ? asked.u : least, asked.v.rate() >= least ? asked.v : least};
    across_u = false;
  }

  std::size_t inner_count() const {
    return static_cast<std::size_t>(inner.u.rate() - 1) * static_cast<std::size_t>(inner.v.rate() - 1);
  }
  std::size_t ring_count() const {
    return static_cast<std::size_t>(border[0].rate() + border[1].rate() + border[2].rate() + border[3].rate());
  }
  std::size_t vertex_count() const { return empty ? 0 : inner_count() + ring_count(); }
  std::size_t triangle_count() const {
    if (empty || collapsed.any() || !has_inner_points()) return special_triangle_count();
    return ring_count() + 2 * (inner_count() - 1);
  }
  /// Returns the number of cells between inner points. Their triangles, two each, come last.
  std::size_t cell_count() const {
    if (empty || !has_inner_points()) return 0;
    return static_cast<std::size_t>(inner.u.rate() - 2) * static_cast<std::size_t>(inner.v.rate() - 2);
  }

  bool has_inner_points() const { return inner.u.rate() > 1; }
  /// Returns the segments of the inner points beside a border.
  Segments inner_along(Side side) const { return along_side(side, inner); }
  /// A border's segments, and those of the inner points beside it, in the direction of the ring.
  Segments along_ring(Side side) const { return as_ring_runs(border[static_cast<std::size_t>(side)], side); }
  Segments inner_along_ring(Side side) const { return as_ring_runs(inner_along(side), side); }
  /// The parameters of a vertex.
  struct Parameters {
    double u, v;
  };
  Parameters parameters(std::size_t vertex) const;
  /// Writes the corners of all triangles, counter-clockwise seen from where r_u x r_v points. Vertices are counted from
  /// `first`. Triangles of cells between inner points come last, and only if `cells`. Returns the end of what it wrote.
  std::uint32_t* write_triangles(std::uint32_t first, std::uint32_t* indices, bool cells = true) const;

 private:
  static Segments as_ring_runs(Segments along, Side side) {
    return !along.is_uniform() && is_backward(side) ? along.reversed() : along;
  }
  /// Whether the borders u0 and u1 (`across_u`), or v0 and v1, are joined without inner points between them.
  static bool joins_borders(const PatchShape& shape, PatchSegments asked, const std::array<Segments, 4>& borders,
                            bool across_u);
  std::size_t special_triangle_count() const;
};

/// Returns the corners of the triangles between a border and at least 2 `inner` segments beside it, both in the
/// direction of the ring, as Division::write_triangles() writes them. Border point k has the code border_code + k; the
/// point where inner segment k begins has the code k - 1. `collapsed`: no triangle stands on the border.
std::vector<std::uint32_t> strip_codes(Segments border, Segments inner, bool collapsed, std::uint32_t border_code);

}}  // namespace tessera::abi_0_1
