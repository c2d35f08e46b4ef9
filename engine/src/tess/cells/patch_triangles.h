#pragma once
// Writes the triangles of one patch on a uniform grid, without those that collapse.

#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The properties of a patch that decide which triangles it has.
struct PatchShape {
  std::uint8_t degree_u = 0, degree_v = 0;
  SideMask collapsed;
  bool is_curve = false;  ///< a curve or a point: no triangle has an area

  static PatchShape of(const BezierPatch& patch) { return of(patch, patch.collapsed_sides()); }
  /// `collapsed`: patch.collapsed_sides().
  static PatchShape of(const BezierPatch& patch, SideMask collapsed);
  /// The shape that the patch would have with as many other control points.
  static PatchShape of(const BezierPatch& patch, std::span<const Vec3> points);
  friend bool operator==(const PatchShape& a, const PatchShape& b) {
    return a.degree_u == b.degree_u && a.degree_v == b.degree_v && a.collapsed.bits == b.collapsed.bits &&
           a.is_curve == b.is_curve;
  }
};

struct Rates {
  int u = 1, v = 1;
  friend bool operator==(const Rates&, const Rates&) = default;
  std::size_t vertices() const { return static_cast<std::size_t>(u + 1) * static_cast<std::size_t>(v + 1); }
};

/// Returns the number of triangles of a patch.
std::size_t triangle_count(const PatchShape& shape, Rates rates);
/// Returns the number of whole cells, of two triangles each, which may be quads.
std::size_t quad_count(const PatchShape& shape, Rates rates);

/// Writes the corners of all triangles, three indices per triangle, counter-clockwise seen from where r_u x r_v points.
/// Vertex [iu][iv] is `first` + iu * (rates.v + 1) + iv. Returns the end of what it wrote.
std::uint32_t* write_triangles(const PatchShape& shape, Rates rates, std::uint32_t first, std::uint32_t* indices);
/// Writes whole cells as quads, four indices each, and the triangles of other cells, as write_triangles().
void write_quads(const PatchShape& shape, Rates rates, std::uint32_t first, std::uint32_t* indices,
                 std::uint32_t* quads);

}}  // namespace tessera::abi_0_1
