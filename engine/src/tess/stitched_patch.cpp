#include "tess/stitched_patch.h"

#include <algorithm>

namespace tessera {
namespace {

std::uint32_t* write(std::uint32_t* to, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  to[0] = a;
  to[1] = b;
  to[2] = c;
  return to + 3;
}

/// Points at k / rate for k = first .. last, whose vertices are `vertex(k)`.
template <class Vertex>
struct Line {
  int rate, first, last;
  bool is_point;  ///< all at one place: no triangle has an edge on it
  Vertex vertex;
};
template <class Vertex>
Line(int, int, int, bool, Vertex) -> Line<Vertex>;

/// The triangles between two lines that run the same way, `right` of which lies to the right. The line whose next point
/// comes first goes on: so a triangle is no wider than the wider of both lines' steps, and where both lines have a point
/// at one parameter no triangle straddles it.
template <class Right, class Left>
std::uint32_t* write_strip(const Line<Right>& right, const Line<Left>& left, std::uint32_t* to) {
  int i = right.first, j = left.first;
  while (i < right.last || j < left.last) {
    const bool right_goes =
        j == left.last || (i < right.last && std::int64_t{i + 1} * left.rate <= std::int64_t{j + 1} * right.rate);
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

/// Two lines of border points, where there are no inner ones, can be joined unless the borders between them are points.
bool joins(const PatchShape& shape, Rates rates, const std::array<int, 4>& borders, Side a, Side b) {
  const int along = runs_along_u(a) ? rates.u : rates.v;
  return along == 1 && borders[static_cast<std::size_t>(a)] == 1 && borders[static_cast<std::size_t>(b)] == 1 &&
         !shape.collapsed.has(edge_of(a)) && !shape.collapsed.has(edge_of(b));
}

}  // namespace

bool Division::joins_borders(const PatchShape& shape, Rates rates, const std::array<int, 4>& borders) {
  return joins(shape, rates, borders, Side::v0, Side::v1) || joins(shape, rates, borders, Side::u0, Side::u1);
}

std::size_t Division::special_triangle_count() const {
  if (empty) return 0;
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  std::size_t count = 0;
  for (const Side side : all_sides)
    if (!collapsed.has(edge_of(side))) count += size(border[static_cast<std::size_t>(side)]);
  if (!has_inner_points()) return count - 2;  // one of each pair of sides is joined by an edge, not by triangles
  return count + 2 * (inner_count() - 1);
}

Division::Parameters Division::parameters(std::size_t vertex) const {
  if (vertex < inner_count()) {
    const auto row = static_cast<std::size_t>(inner.v - 1);
    return {double(vertex / row + 1) / inner.u, double(vertex % row + 1) / inner.v};
  }
  vertex -= inner_count();
  std::size_t side = 0;
  for (; side < 3 && vertex >= static_cast<std::size_t>(border[side]); ++side)
    vertex -= static_cast<std::size_t>(border[side]);
  const double rate = border[side], along = double(vertex) / rate, back = (rate - double(vertex)) / rate;
  const Parameters at[] = {{along, 0}, {1, along}, {back, 1}, {0, back}};
  return at[side];
}

std::vector<std::uint32_t> strip_codes(int rate, int inner, std::uint32_t border_code) {
  std::vector<std::uint32_t> corners(static_cast<std::size_t>(3 * (rate + inner - 2)));
  const auto number = [](int k) { return static_cast<std::uint32_t>(k); };
  write_strip(Line{rate, 0, rate, false, [=](int k) { return border_code + number(k); }},
              Line{inner, 1, inner - 1, false, [=](int k) { return number(k - 1); }}, corners.data());
  return corners;
}

std::uint32_t* Division::write_triangles(std::uint32_t first, std::uint32_t* to, bool cells) const {
  if (empty) return to;
  const std::uint32_t ring = first + static_cast<std::uint32_t>(inner_count());
  const auto ring_size = static_cast<std::uint32_t>(ring_count());
  std::array<std::uint32_t, 4> start{};  // of each side along the ring
  for (std::size_t side = 1; side < 4; ++side)
    start[side] = start[side - 1] + static_cast<std::uint32_t>(border[side - 1]);
  /// A side as the ring runs, the patch on its left; or the other way.
  const auto line = [&](Side side, bool backward) {
    const int rate = border[static_cast<std::size_t>(side)];
    const std::uint32_t begin = start[static_cast<std::size_t>(side)];
    return Line{rate, 0, rate, collapsed.has(edge_of(side)), [=](int k) {
                  const std::uint32_t at = begin + static_cast<std::uint32_t>(backward ? rate - k : k);
                  return ring + (at == ring_size ? 0 : at);
                }};
  };
  if (!has_inner_points()) {
    const bool across = border[0] == 1 && border[2] == 1 && !collapsed.has(Edge::v0) && !collapsed.has(Edge::v1);
    return across ? write_strip(line(Side::u1, false), line(Side::u0, true), to)
                  : write_strip(line(Side::v0, false), line(Side::v1, true), to);
  }
  const auto row = static_cast<std::uint32_t>(inner.v - 1);
  const auto inner_vertex = [=](int iu, int iv) {
    return first + static_cast<std::uint32_t>(iu - 1) * row + static_cast<std::uint32_t>(iv - 1);
  };
  const int m = inner.u, n = inner.v;
  to = write_strip(line(Side::v0, false), Line{m, 1, m - 1, false, [=](int k) { return inner_vertex(k, 1); }}, to);
  to = write_strip(line(Side::u1, false), Line{n, 1, n - 1, false, [=](int k) { return inner_vertex(m - 1, k); }}, to);
  to = write_strip(line(Side::v1, false), Line{m, 1, m - 1, false, [=](int k) { return inner_vertex(m - k, n - 1); }},
                   to);
  to = write_strip(line(Side::u0, false), Line{n, 1, n - 1, false, [=](int k) { return inner_vertex(1, n - k); }}, to);
  for (int iu = 1; cells && iu < m - 1; ++iu)
    for (int iv = 1; iv < n - 1; ++iv) {
      const std::uint32_t p00 = inner_vertex(iu, iv), p10 = p00 + row;
      to = write(to, p00, p10, p10 + 1);
      to = write(to, p00, p10 + 1, p00 + 1);
    }
  return to;
}

}  // namespace tessera
