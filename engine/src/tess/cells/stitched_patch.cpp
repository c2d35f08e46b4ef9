#include "tess/cells/stitched_patch.h"

#include "tess/cells/write_triangle.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A row of points: where segments k = first .. last begin, with vertices `vertex(k)`.
template <class Vertex>
struct Line {
  Segments segments;
  int first, last;
  bool is_point;  ///< all points are at one place: no triangle has an edge on the row
  Vertex vertex;
};
template <class Vertex>
Line(Segments, int, int, bool, Vertex) -> Line<Vertex>;

/// The row of a border's points.
template <class Vertex>
Line<Vertex> whole_line(Segments segments, bool is_point, Vertex vertex) {
  return {segments, 0, segments.rate(), is_point, vertex};
}
/// The row of the inner points beside a border.
template <class Vertex>
Line<Vertex> inner_line(Segments segments, Vertex vertex) {
  return {segments, 1, segments.rate() - 1, false, vertex};
}

bool is_not_behind(Segments::Fraction a, Segments::Fraction b) {
  return std::int64_t{a.numerator} * b.denominator <= std::int64_t{b.numerator} * a.denominator;
}

/// Writes the triangles between two rows that run the same way, `right` to the right of `left`. The row whose next
/// point comes first advances. So a triangle is no wider than the wider step of both rows, and where both rows have a
/// point at one parameter, no triangle crosses it.
template <class Right, class Left>
std::uint32_t* write_strip(const Line<Right>& right, const Line<Left>& left, std::uint32_t* to) {
  int i = right.first, j = left.first;
  while (i < right.last || j < left.last) {
    const bool right_goes =
        j == left.last || (i < right.last && is_not_behind(right.segments.at(i + 1), left.segments.at(j + 1)));
    if (right_goes) {
      if (!right.is_point) to = write(to, right.vertex(i), right.vertex(i + 1), left.vertex(j));
      ++i;
    } else {
      if (!left.is_point) to = write(to, right.vertex(i), left.vertex(j + 1), left.vertex(j));
      ++j;
    }
  }
  return to;
}

/// Writes the triangles between two borders that run the same way, as write_strip(), and those at their ends. `first`
/// runs from the begin of `left` to that of `right`, `last` from the end of `right` to that of `left`. If an end has
/// more than one segment, these make a fan with the next point of one of the two borders: no triangle there is higher
/// than that border's step.
template <class Vertex>
std::uint32_t* write_joined(const Line<Vertex>& first, Line<Vertex> right, const Line<Vertex>& last, Line<Vertex> left,
                            std::uint32_t* to) {
  if (first.last > 1) {
    for (int k = 0; k < first.last; ++k) to = write(to, first.vertex(k), first.vertex(k + 1), left.vertex(1));
    left.first = 1;
  }
  if (last.last > 1) {
    --right.last;
    for (int k = 0; k < last.last; ++k) to = write(to, last.vertex(k), last.vertex(k + 1), right.vertex(right.last));
  }
  return write_strip(right, left, to);
}

/// The most segments of a border between joined ones. With more, the patch gets a point in its middle instead, because
/// fans from a corner would be needles.
constexpr int max_at_ends = 3;

}  // namespace

bool Division::joins_borders(const PatchShape& shape, PatchSegments asked, const std::array<Segments, 4>& borders,
                             bool across_u) {
  const Side first = across_u ? Side::v0 : Side::u0, last = across_u ? Side::v1 : Side::u1;
  if ((across_u ? asked.u : asked.v).rate() != 1 || shape.collapsed.has(first) || shape.collapsed.has(last))
    return false;
  const int most =
      std::max(borders[static_cast<std::size_t>(first)].rate(), borders[static_cast<std::size_t>(last)].rate());
  return most == 1 || (most <= max_at_ends && !shape.collapsed.any());
}

std::size_t Division::special_triangle_count() const {
  if (empty) return 0;
  std::size_t count = 0;
  for (const Side side : all_sides)
    if (!collapsed.has(side)) count += border[static_cast<std::size_t>(side)].rate();
  if (!has_inner_points()) return count - 2;  // a polygon of `count` sides has count - 2 triangles
  return count + 2 * (inner_count() - 1);
}

Division::Parameters Division::parameters(std::size_t vertex) const {
  if (vertex < inner_count()) {
    const auto row = static_cast<std::size_t>(inner.v.rate() - 1);
    const auto i = static_cast<int>(vertex / row + 1), j = static_cast<int>(vertex % row + 1);
    return {inner.u.at(i).value(), inner.v.at(j).value()};
  }
  auto on_ring = static_cast<int>(vertex - inner_count());
  std::size_t side = 0;
  for (; side < 3 && on_ring >= border[side].rate(); ++side) on_ring -= border[side].rate();
  const Segments::Fraction at = along_ring(all_sides[side]).at(on_ring);
  const Parameters places[] = {{at.value(), 0}, {1, at.value()}, {at.rest(), 1}, {0, at.rest()}};
  return places[side];
}

std::vector<std::uint32_t> strip_codes(Segments border, Segments inner, bool collapsed, std::uint32_t border_code) {
  std::vector<std::uint32_t> corners(
      static_cast<std::size_t>(3 * ((collapsed ? 0 : border.rate()) + inner.rate() - 2)));
  const auto number = [](int k) { return static_cast<std::uint32_t>(k); };
  write_strip(whole_line(border, collapsed, [=](int k) { return border_code + number(k); }),
              inner_line(inner, [=](int k) { return number(k - 1); }), corners.data());
  return corners;
}

std::uint32_t* Division::write_triangles(std::uint32_t first, std::uint32_t* to, bool cells) const {
  if (empty) return to;
  const std::uint32_t ring = first + static_cast<std::uint32_t>(inner_count());
  const auto ring_size = static_cast<std::uint32_t>(ring_count());
  std::array<std::uint32_t, 4> start{};  // the first ring point of each side
  for (std::size_t side = 1; side < 4; ++side) start[side] = start[side - 1] + border[side - 1].rate();
  // A side in the direction of the ring, the patch on its left; or `backward`.
  const auto line = [&](Side side, bool backward) {
    const Segments along = along_ring(side);
    const std::uint32_t begin = start[static_cast<std::size_t>(side)];
    return whole_line(backward ? along.reversed() : along, collapsed.has(side), [=](int k) {
      const std::uint32_t at = begin + static_cast<std::uint32_t>(backward ? along.rate() - k : k);
      return ring + (at == ring_size ? 0 : at);
    });
  };
  if (!has_inner_points()) {
    return across_u ? write_joined(line(Side::v0, false), line(Side::u1, false), line(Side::v1, false),
                                   line(Side::u0, true), to)
                    : write_joined(line(Side::u0, false), line(Side::v0, false), line(Side::u1, false),
                                   line(Side::v1, true), to);
  }
  const auto row = static_cast<std::uint32_t>(inner.v.rate() - 1);
  const auto inner_vertex = [=](int iu, int iv) {
    return first + static_cast<std::uint32_t>(iu - 1) * row + static_cast<std::uint32_t>(iv - 1);
  };
  const int m = inner.u.rate(), n = inner.v.rate();
  const auto write_side = [&](Side side, auto vertex) {
    to = write_strip(line(side, false), inner_line(inner_along_ring(side), vertex), to);
  };
  write_side(Side::v0, [=](int k) { return inner_vertex(k, 1); });
  write_side(Side::u1, [=](int k) { return inner_vertex(m - 1, k); });
  write_side(Side::v1, [=](int k) { return inner_vertex(m - k, n - 1); });
  write_side(Side::u0, [=](int k) { return inner_vertex(1, n - k); });
  for (int iu = 1; cells && iu < m - 1; ++iu)
    for (int iv = 1; iv < n - 1; ++iv) {
      const std::uint32_t p00 = inner_vertex(iu, iv), p10 = p00 + row;
      to = write(to, p00, p10, p10 + 1);
      to = write(to, p00, p10 + 1, p00 + 1);
    }
  return to;
}

}}  // namespace tessera::abi_0_1
