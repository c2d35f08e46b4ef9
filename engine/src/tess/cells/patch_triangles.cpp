#include "tess/cells/patch_triangles.h"

#include "surface/net/collapsed_sides.h"
#include "tess/cells/write_triangle.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Whether the patch is a curve or a point. If the points do not depend on one parameter but the weights do, weights
/// mix three or more points to an area, and two points to a segment.
bool has_no_area(const BezierPatch& patch, std::span<const Vec3> points) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const auto point = [&](int i, int j) { return points[static_cast<std::size_t>(i * (n + 1) + j)]; };
  bool points_u = true, points_v = true, weights_u = true, weights_v = true;  // constant along u, v
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      points_u = points_u && point(i, j) == point(0, j);
      points_v = points_v && point(i, j) == point(i, 0);
      weights_u = weights_u && patch.weight(i, j) == patch.weight(0, j);
      weights_v = weights_v && patch.weight(i, j) == patch.weight(i, 0);
    }
  return (points_u && points_v) || (points_u && (weights_u || n == 1)) || (points_v && (weights_v || m == 1));
}

// A cell with corners 00, 10, 11, 01 (first digit along u) is split from 00 to 11 into these two triangles.
enum CellTriangle : unsigned { lower = 1, upper = 2 };  // 00 10 11 and 00 11 01

/// Returns the triangles left of a cell some of whose edges have collapsed to points. Two collapsed sides that meet at
/// 01 or at 10 make 00 and 11 one point as well.
unsigned remaining(SideMask cell) {
  const bool u0 = cell.has(Side::u0), u1 = cell.has(Side::u1), v0 = cell.has(Side::v0), v1 = cell.has(Side::v1);
  const bool keeps_lower = !v0 && !u1 && !(u0 && v1);
  const bool keeps_upper = !u0 && !v1 && !(v0 && u1);
  return (keeps_lower ? lower : 0u) | (keeps_upper ? upper : 0u);
}

/// Returns the collapsed sides of the patch that a cell lies at.
SideMask edges_of_cell(SideMask patch, Rates rates, int iu, int iv) {
  SideMask at;
  if (iu == 0) at.add(Side::u0);
  if (iu == rates.u - 1) at.add(Side::u1);
  if (iv == 0) at.add(Side::v0);
  if (iv == rates.v - 1) at.add(Side::v1);
  return {static_cast<std::uint8_t>(at.bits & patch.bits)};
}

/// Sums up what is left of a patch's cells: `all` for each, but count(remaining()) for those at collapsed sides.
template <class Count>
std::size_t remaining_count(const PatchShape& shape, Rates rates, std::size_t all, const Count& count) {
  if (shape.is_curve) return 0;
  std::size_t sum = all * static_cast<std::size_t>(rates.u) * static_cast<std::size_t>(rates.v);
  if (!shape.collapsed.any()) return sum;
  const auto take_off = [&](int iu, int iv) {
    sum -= all - static_cast<std::size_t>(count(remaining(edges_of_cell(shape.collapsed, rates, iu, iv))));
  };
  for (int iu = 0; iu < rates.u; ++iu) {  // the cells of the border, each once
    take_off(iu, 0);
    if (rates.v > 1) take_off(iu, rates.v - 1);
  }
  for (int iv = 1; iv < rates.v - 1; ++iv) {
    take_off(0, iv);
    if (rates.u > 1) take_off(rates.u - 1, iv);
  }
  return sum;
}

/// Writes both triangles of each of `count` cells in a row; the corners 00 are vertices first, first + 1, ...
std::uint32_t* write_whole_cells(std::uint32_t first, std::uint32_t row, int count, std::uint32_t* to) {
  for (std::uint32_t p00 = first; p00 != first + static_cast<std::uint32_t>(count); ++p00) {
    to = write(to, p00, p00 + row, p00 + row + 1);
    to = write(to, p00, p00 + row + 1, p00 + 1);
  }
  return to;
}

PatchShape shape_of(const BezierPatch& patch, std::span<const Vec3> points, SideMask collapsed) {
  PatchShape shape;
  shape.degree_u = static_cast<std::uint8_t>(patch.degree_u());
  shape.degree_v = static_cast<std::uint8_t>(patch.degree_v());
  shape.collapsed = collapsed;
  shape.is_curve = shape.collapsed.any() && has_no_area(patch, points);
  return shape;
}

}  // namespace

PatchShape PatchShape::of(const BezierPatch& patch, SideMask collapsed) {
  return shape_of(patch, patch.points(), collapsed);
}

PatchShape PatchShape::of(const BezierPatch& patch, std::span<const Vec3> points) {
  return shape_of(patch, points, collapsed_sides(patch.degree_u(), patch.degree_v(), points));
}

std::size_t triangle_count(const PatchShape& shape, Rates rates) {
  return remaining_count(shape, rates, 2, [](unsigned left) { return ((left & lower) != 0) + ((left & upper) != 0); });
}

std::size_t quad_count(const PatchShape& shape, Rates rates) {
  return remaining_count(shape, rates, 1, [](unsigned left) { return left == (lower | upper) ? 1 : 0; });
}

std::uint32_t* write_triangles(const PatchShape& shape, Rates rates, std::uint32_t first, std::uint32_t* indices) {
  if (shape.is_curve) return indices;
  const std::uint32_t row = static_cast<std::uint32_t>(rates.v) + 1;
  for (int iu = 0; iu < rates.u; ++iu, first += row) {
    if (!shape.collapsed.any()) {
      indices = write_whole_cells(first, row, rates.v, indices);
      continue;
    }
    for (int iv = 0; iv < rates.v; ++iv) {
      const std::uint32_t p00 = first + static_cast<std::uint32_t>(iv), p10 = p00 + row;
      const unsigned left = remaining(edges_of_cell(shape.collapsed, rates, iu, iv));
      if (left & lower) indices = write(indices, p00, p10, p10 + 1);
      if (left & upper) indices = write(indices, p00, p10 + 1, p00 + 1);
    }
  }
  return indices;
}

void write_quads(const PatchShape& shape, Rates rates, std::uint32_t first, std::uint32_t* indices,
                 std::uint32_t* quads) {
  if (shape.is_curve) return;
  const std::uint32_t row = static_cast<std::uint32_t>(rates.v) + 1;
  for (int iu = 0; iu < rates.u; ++iu, first += row)
    for (int iv = 0; iv < rates.v; ++iv) {
      const std::uint32_t p00 = first + static_cast<std::uint32_t>(iv), p10 = p00 + row;
      const unsigned left = remaining(edges_of_cell(shape.collapsed, rates, iu, iv));
      if (left == (lower | upper)) {
        for (const std::uint32_t corner : {p00, p10, p10 + 1, p00 + 1}) *quads++ = corner;
      } else {
        if (left & lower) indices = write(indices, p00, p10, p10 + 1);
        if (left & upper) indices = write(indices, p00, p10 + 1, p00 + 1);
      }
    }
}

}}  // namespace tessera::abi_0_1
