#include "query/border_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "basis/chebyshev_lobatto.h"
#include "measure/gauss_rule.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t arc_size = BorderArc::count;
using Points = std::array<Vec3, arc_size>;  ///< control points of an arc

/// Bernstein polynomials of an arc's degree and their derivatives at the nodes of a Gauss rule.
struct NodeTable {
  explicit NodeTable(int nodes) : rule(gauss_rule(nodes)) {
    for (int k = 0; k < nodes; ++k) basis.emplace_back(BorderArc::degree, rule.nodes[static_cast<std::size_t>(k)]);
  }
  const GaussRule& rule;
  std::vector<NetBasis<BorderArc::degree>> basis;
};

/// The matrix from an arc's values at Lobatto parameters to its control points, and these parameters.
struct ArcTable {
  ArcTable() {
    const Matrix matrix = lobatto_to_bernstein(BorderArc::degree);
    const std::vector<double> at = lobatto_parameters(BorderArc::degree);
    for (std::size_t i = 0; i < arc_size; ++i) {
      parameters[i] = at[i];
      for (std::size_t k = 0; k < arc_size; ++k)
        to_points[i][k] = static_cast<double>(matrix(static_cast<int>(i), static_cast<int>(k)));
    }
  }
  std::array<double, arc_size> parameters{};
  std::array<std::array<double, arc_size>, arc_size> to_points{};
};

Vec3 point_at(const Points& points, double t) {
  const NetBasis<BorderArc::degree> basis(BorderArc::degree, t);
  Vec3 sum;
  for (std::size_t k = 0; k < arc_size; ++k) sum += basis.value[k] * points[k];
  return sum;
}

/// Returns how far control points are at most from where those of the chord at constant speed would be.
double bend_of(const Points& points) {
  double most = 0;
  for (std::size_t k = 1; k + 1 < arc_size; ++k) {
    const double share = static_cast<double>(k) / BorderArc::degree;
    const Vec3 off = points[k] - ((1 - share) * points.front() + share * points.back());
    most = std::max(most, dot(off, off));
  }
  return std::sqrt(most);
}

void halve(const Points& points, Points& lower, Points& upper) {
  Points left = points;
  for (std::size_t last = arc_size; last-- > 0;) {
    lower[arc_size - 1 - last] = left[0];
    upper[last] = left[last];
    for (std::size_t k = 0; k < last; ++k) left[k] = 0.5 * left[k] + 0.5 * left[k + 1];
  }
}

/// Makes the arc of a curve over [from, to], and tells whether it is good.
bool make_arc(FunctionRef<Vec3(double)> curve, double from, double to, double tolerance, BorderArc& arc) {
  static const ArcTable table;
  const auto at = [&](double t) { return curve((1 - t) * from + t * to); };
  std::array<Vec3, arc_size> values;
  for (std::size_t k = 0; k < arc_size; ++k) values[k] = at(table.parameters[k]);
  for (std::size_t i = 0; i < arc_size; ++i) {
    arc.points[i] = {};
    for (std::size_t k = 0; k < arc_size; ++k) arc.points[i] += table.to_points[i][k] * values[k];
  }
  arc.points.front() = values.front(), arc.points.back() = values.back();
  constexpr double largest_bend = 0.15;
  arc.bend = bend_of(arc.points);
  if (!(arc.bend <= std::max(largest_bend * length(values.back() - values.front()), tolerance))) return false;
  for (const double t : {0.02, 0.29, 0.5, 0.71, 0.98})
    if (!(length(at(t) - point_at(arc.points, t)) <= tolerance)) return false;
  return true;
}

/// Returns the squared distance of a point, relative to the origin, from the half-line along d.
double square_from_line(const Vec3& p, const Vec3& d) {
  const double along = std::max(dot(p, d), 0.0);
  const Vec3 off = p - along * d;
  return dot(off, off);
}

/// Returns the squared distances of the chord from a to b from the half-line along d, and from its origin.
std::array<double, 2> squares_from_chord(const Vec3& a, const Vec3& b, const Vec3& d) {
  const Vec3 e = b - a, across_a = a - dot(a, d) * d, across_e = e - dot(e, d) * d;
  const auto share = [](double above, double below) { return below > 0 ? std::clamp(above / below, 0.0, 1.0) : 0.0; };
  const double to_origin = share(-dot(a, e), dot(e, e));
  const double level = dot(e, d) != 0 ? std::clamp(-dot(a, d) / dot(e, d), 0.0, 1.0) : 0;
  // The distance from a convex set is convex along the chord: it is least where a part of it is, or at an end.
  double least = std::min(square_from_line(a, d), square_from_line(b, d));
  for (const double t : {share(-dot(across_a, across_e), dot(across_e, across_e)), to_origin, level})
    least = std::min(least, square_from_line(a + t * e, d));
  const Vec3 foot = a + to_origin * e;
  return {least, dot(foot, foot)};
}

/// |r| - d.r without cancellation. `across`: d x r.
double less_along(const Vec3& across, double radius, double along) {
  return along > 0 ? dot(across, across) / (radius + along) : radius - along;
}

/// The integral of A.dl along the chord from a to b: the solid angle of the triangle of a, b and -d (van Oosterom and
/// Strackee 1983, The solid angle of a plane triangle), written so that nothing cancels near d.
double chord_share(const Vec3& a, const Vec3& b, const Vec3& d) {
  const Vec3 across_a = cross(d, a), across_b = cross(d, b);
  const double at_a = less_along(across_a, length(a), dot(a, d)), at_b = less_along(across_b, length(b), dot(b, d));
  const double above = dot(d, cross(across_a, cross(d, b - a)));
  const double angle = -2 * std::atan2(above, at_a * at_b + dot(across_a, across_b));
  return std::isfinite(angle) ? angle : 0;
}

/// Points of an arc and the derivatives there times the weights of a Gauss rule.
template <std::size_t size>
void sample(const Points& points, std::array<Vec3, size>& nodes, std::array<Vec3, size>& steps) {
  static const NodeTable table(size);
  for (std::size_t n = 0; n < size; ++n) {
    nodes[n] = steps[n] = {};
    for (std::size_t k = 0; k < arc_size; ++k) {
      nodes[n] += table.basis[n].value[k] * points[k];
      steps[n] += table.basis[n].derivative[k] * points[k];
    }
    steps[n] = table.rule.weights[n] * steps[n];
  }
}

/// The integral of A.dl along an arc by a Gauss rule.
template <std::size_t size>
double gauss_share(const std::array<Vec3, size>& nodes, const std::array<Vec3, size>& steps, const HalfLine& line) {
  double sum = 0;
  for (std::size_t n = 0; n < size; ++n) {
    const Vec3 r = nodes[n] - line.origin, across = cross(line.direction, r);
    const double radius = length(r), along = dot(line.direction, r);
    sum -= dot(across, steps[n]) / (radius * less_along(across, radius, along));
  }
  return sum;
}

template <std::size_t size>
double sampled_share(const Points& points, const HalfLine& line) {
  std::array<Vec3, size> nodes, steps;
  sample(points, nodes, steps);
  return gauss_share(nodes, steps, line);
}

/// Where a part of an arc lies, relative to the half-line's origin, and how far it reaches from its centre.
struct PartPlace {
  PartPlace(const Points& points, double off, const Vec3& origin)
      : from(points.front() - origin),
        to(points.back() - origin),
        centre(0.5 * from + 0.5 * to),
        bend(off),
        reach(0.5 * length(to - from) + off) {}
  /// Whether the half-line is `ratio` reaches away. The integrand is then analytic in the ellipse about the part whose
  /// half axes add up to rho = ratio + sqrt(ratio^2 - 1) half parts, and a rule of n nodes has an error of rho^-2n of
  /// its size: 1e-9 for 5 nodes at ratio 4, 7e-10 for 8 nodes at ratio 2 (see gauss_choice()).
  bool is_beyond(double ratio, const HalfLine& line, double square) const {
    return square >= ratio * ratio * reach * reach && reach > 2 * line.near;
  }
  Vec3 from, to, centre;
  double bend, reach;
};

/// Adds the integral along a part of an arc, or tells that it must be halved. `square`: the squared distance of its
/// centre from the half-line.
bool add_part(const Points& points, const PartPlace& at, const HalfLine& line, double square, bool is_last,
              AngleShare& share) {
  const auto [from_line, from_origin] = squares_from_chord(at.from, at.to, line.direction);
  // The surface between the part and its chord does not meet the half-line, and covers no more than this.
  constexpr double small = 1e-9;
  const bool is_straight = 16 * at.bend * at.bend <= from_line && 4 * at.bend * at.reach <= small * from_origin;
  if (!is_straight && at.is_beyond(4, line, square)) {
    share.value += sampled_share<5>(points, line);
    return true;
  }
  if (!is_straight && at.is_beyond(2, line, square)) {
    share.value += sampled_share<8>(points, line);
    return true;
  }
  if (!is_straight && !is_last) return false;
  share.value += chord_share(at.from, at.to, line.direction);
  share.is_sure = share.is_sure && is_straight && from_line > line.near * line.near;
  return true;
}

/// Adds the integral along an arc that is near, half by half.
void add_halves(const Points& points, const HalfLine& line, int depth, int& parts, AngleShare& share) {
  constexpr int max_depth = 48, max_parts = 4096;
  std::array<Points, 2> halves;
  halve(points, halves[0], halves[1]);
  for (const Points& half : halves) {
    const PartPlace at(half, bend_of(half), line.origin);
    const bool is_last = depth == max_depth || ++parts > max_parts;
    if (!add_part(half, at, line, square_from_line(at.centre, line.direction), is_last, share))
      add_halves(half, line, depth + 1, parts, share);
  }
}

}  // namespace

void append_arcs(FunctionRef<Vec3(double)> curve, double tolerance, std::uint32_t patch, std::int8_t sign,
                 std::vector<BorderArc>& arcs) {
  constexpr int max_depth = 20;
  constexpr std::size_t max_arcs = 4096;
  constexpr double least_share = 0x1p-8;  // shorter arcs are points, such as poles
  struct Stretch {
    double from, to;
    int depth;
  };
  const std::size_t first = arcs.size();
  std::array<Stretch, max_depth + 2> stack;
  std::size_t left = 0;
  stack[left++] = {0, 1, 0};
  while (left > 0) {
    const Stretch part = stack[--left];
    BorderArc arc{.points = {}, .nodes = {}, .steps = {}, .patch = patch, .sign = sign};
    const bool is_last = part.depth == max_depth || arcs.size() - first >= max_arcs;
    if (!make_arc(curve, part.from, part.to, tolerance, arc) && !is_last) {
      const double middle = 0.5 * (part.from + part.to);
      stack[left++] = {middle, part.to, part.depth + 1};
      stack[left++] = {part.from, middle, part.depth + 1};
    } else if (length(arc.to() - arc.from()) + arc.bend > least_share * tolerance) {
      sample(arc.points, arc.nodes, arc.steps);
      arcs.push_back(arc);
    }
  }
}

void add_share(const BorderArc& arc, const HalfLine& line, AngleShare& share) {
  AngleShare own;
  const PartPlace at(arc.points, arc.bend, line.origin);
  const double square = square_from_line(at.centre, line.direction);
  if (at.is_beyond(4, line, square)) {
    own.value = gauss_share(arc.nodes, arc.steps, line);
  } else if (!add_part(arc.points, at, line, square, false, own)) {
    int parts = 0;
    add_halves(arc.points, line, 1, parts, own);
  }
  share.value += arc.sign * own.value / (4 * std::numbers::pi);
  share.is_sure = share.is_sure && own.is_sure;
}

}}  // namespace tessera::abi_0_1
