#pragma once
// The vertices and triangles of one patch whose four borders have rates of their own: an inner grid, a ring of border
// points, and strips between them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tess/patch_triangles.h"
#include "tess/shared_edges.h"

namespace tessera {

/// How a patch is divided. Vertices: the inner points [iu - 1][iv - 1] at (iu / inner.u, iv / inner.v), then the ring:
/// border points at k / rate, counter-clockwise from (0,0), each corner once.
///
/// Every triangle's parameter box is at most 1 / n wide along a parameter, n being the rate asked for there: an inner
/// cell's, and a strip's too, whose border rate is at least n. None straddles the middle of a parameter along which the
/// rates of the patch and of its borders are even. Where a border's is odd beside an even one of the patch, only triangles
/// at it do, no wider than its segments, or those of the opposite border if that is odd too.
struct Division {
  Rates inner;                  ///< both 1: no inner points
  std::array<int, 4> border{};  ///< by Side
  EdgeMask collapsed;           ///< these borders are points: no triangle stands on them
  bool empty = false;           ///< a curve or a point: neither vertices nor triangles
  bool across_u = false;        ///< without inner points: triangles go from border u0 to u1, else from v0 to v1

  friend bool operator==(const Division& a, const Division& b) {
    return a.inner == b.inner && a.border == b.border && a.collapsed.bits == b.collapsed.bits && a.empty == b.empty &&
           a.across_u == b.across_u;
  }

  /// `rates` were asked for the patch; each of `borders` is at least the rate along it.
  static Division of(const PatchShape& shape, Rates rates, const std::array<int, 4>& borders) {
    Division division;
    division.set(shape, rates, borders);
    return division;
  }
  /// The same in place: copies of a record that was just made wait for its stores.
  void set(const PatchShape& shape, Rates rates, const std::array<int, 4>& borders) {
    inner = {std::max(rates.u, 2), std::max(rates.v, 2)};
    border = borders;
    collapsed = shape.collapsed;
    empty = shape.is_curve;
    across_u = false;
    if (std::min(rates.u, rates.v) > 1) return;
    for (const bool way : {true, false}) {
      if (!joins_borders(shape, rates, border, way)) continue;
      inner = {1, 1};
      across_u = way;
      return;
    }
  }

  std::size_t inner_count() const {
    return static_cast<std::size_t>(inner.u - 1) * static_cast<std::size_t>(inner.v - 1);
  }
  std::size_t ring_count() const {
    return static_cast<std::size_t>(border[0]) + static_cast<std::size_t>(border[1]) +
           static_cast<std::size_t>(border[2]) + static_cast<std::size_t>(border[3]);
  }
  std::size_t vertex_count() const { return empty ? 0 : inner_count() + ring_count(); }
  std::size_t triangle_count() const {
    if (empty || collapsed.any() || !has_inner_points()) return special_triangle_count();
    return ring_count() + 2 * (inner_count() - 1);
  }
  /// Cells between inner points, of two triangles each, which come last.
  std::size_t cell_count() const {
    if (empty || !has_inner_points()) return 0;
    return static_cast<std::size_t>(inner.u - 2) * static_cast<std::size_t>(inner.v - 2);
  }

  bool has_inner_points() const { return inner.u > 1; }
  /// The place of a vertex.
  struct Parameters {
    double u, v;
  };
  Parameters parameters(std::size_t vertex) const;
  /// visit(u, v) for each vertex, in order.
  template <class Visit>
  void for_parameters(Visit visit) const;
  /// Writes the corners of all triangles, counter-clockwise seen from where r_u x r_v points; vertices are counted from
  /// `first`; those of the cells between inner points come last, if at all. Returns the end of what it wrote.
  std::uint32_t* write_triangles(std::uint32_t first, std::uint32_t* indices, bool cells = true) const;

 private:
  /// Whether the borders u0 and u1, or v0 and v1, are joined without inner points between them.
  static bool joins_borders(const PatchShape& shape, Rates rates, const std::array<int, 4>& borders, bool across_u);
  std::size_t special_triangle_count() const;
};

/// The corners of the triangles between a border at `rate` and inner points at `inner` >= 2 beside it, as
/// Division::write_triangles writes them: border point k is border_code + k, inner point k / inner is k - 1.
std::vector<std::uint32_t> strip_codes(int rate, int inner, std::uint32_t border_code);

template <class Visit>
void Division::for_parameters(Visit visit) const {
  for (int iu = 1; iu < inner.u; ++iu)
    for (int iv = 1; iv < inner.v; ++iv) visit(double(iu) / inner.u, double(iv) / inner.v);
  for (int k = 0; k < border[0]; ++k) visit(double(k) / border[0], 0.0);
  for (int k = 0; k < border[1]; ++k) visit(1.0, double(k) / border[1]);
  for (int k = border[2]; k > 0; --k) visit(double(k) / border[2], 1.0);
  for (int k = border[3]; k > 0; --k) visit(0.0, double(k) / border[3]);
}

}  // namespace tessera
