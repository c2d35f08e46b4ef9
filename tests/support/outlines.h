#pragma once
// Trimming loops whose insides are closed formulas, in long double. They share no code with the library's trims.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/nurbs_surface.h"
#include "tessera/trim_loop.h"

namespace tessera::test {

using Real = long double;

/// A point of a loop, and the unit normal of the loop there.
struct OutlinePlace {
  Real u = 0, v = 0, normal_u = 1, normal_v = 0;
};

/// A loop, and a formula for its inside.
struct Outline {
  TrimLoop loop;
  /// At most the distance from the loop; above 0 inside of it, below 0 outside. Along any way it changes by at most the
  /// way's length.
  std::function<Real(Real u, Real v)> depth;
  std::function<OutlinePlace(Random&)> draw;  ///< of a random point of the loop
  Real change_by_u = 1;                       ///< of the depth, at most, per change of u
};

inline Curve plane_line(const ParameterPoint& a, const ParameterPoint& b) {
  return value_of(Curve::bezier(std::vector<Vec3>{{a.u, a.v, 0}, {b.u, b.v, 0}}));
}

/// A circle, as one rational curve of four arcs that starts at the angle `turn`.
inline Outline round_outline(double x, double y, double radius, bool hole, double turn = 0) {
  const Curve circle = value_of(make_nurbs_circle({}, radius));
  const Affine place = Affine::translated({x, y, 0}) * Affine::rotated({0, 0, 1}, turn);
  std::vector<Vec3> points;
  for (const Vec3& p : circle.points()) points.push_back(turn == 0 ? p + Vec3{x, y, 0} : place.point(p));
  return {{{value_of(Curve::nurbs(2, points, circle.weights(), circle.knots()))}, hole},
          [=](Real u, Real v) { return radius - std::hypot(u - x, v - y); },
          [=](Random& random) -> OutlinePlace {
            const Real angle = uniform(random, 0, 2 * std::numbers::pi), c = std::cos(angle), s = std::sin(angle);
            return {x + radius * c, y + radius * s, c, s};
          }};
}

/// The distance from a polygon, above 0 inside.
inline Real polygon_depth(const std::vector<ParameterPoint>& corners, Real u, Real v) {
  bool inside = false;
  Real nearest = std::numeric_limits<Real>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const ParameterPoint &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const Real du = Real(b.u) - a.u, dv = Real(b.v) - a.v, pu = u - a.u, pv = v - a.v;
    const Real s = std::clamp<Real>((pu * du + pv * dv) / (du * du + dv * dv), 0, 1);
    nearest = std::min(nearest, std::hypot(pu - s * du, pv - s * dv));
    const bool crosses = (Real(a.v) > v) != (Real(b.v) > v);
    if (crosses) inside ^= (dv > 0) == (du * pv - dv * pu > 0);
  }
  return inside ? nearest : -nearest;
}

/// A polygon of one straight curve per side. A quarter of its random points lie next to corners.
inline Outline straight_outline(const std::vector<ParameterPoint>& corners, bool hole) {
  TrimLoop loop{{}, hole};
  for (std::size_t k = 0; k < corners.size(); ++k)
    loop.curves.push_back(plane_line(corners[k], corners[(k + 1) % corners.size()]));
  return {loop, [=](Real u, Real v) { return polygon_depth(corners, u, v); },
          [=](Random& random) -> OutlinePlace {
            const std::size_t k = random() % corners.size();
            const ParameterPoint &a = corners[k], &b = corners[(k + 1) % corners.size()];
            const Real near = std::pow(Real(10), Real(uniform(random, -13, 0)));
            const Real s = random() % 4 == 0 ? near : Real(uniform(random, 0, 1));
            const Real du = Real(b.u) - a.u, dv = Real(b.v) - a.v, size = std::hypot(du, dv);
            return {a.u + s * du, a.v + s * dv, dv / size, -du / size};
          }};
}

/// A cubic v = f(u) over a range, with even control points of heights f.
struct Graph {
  double from = 0, to = 1;
  std::array<double, 4> f{};

  Curve curve(double lift = 0) const {
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < 4; ++k) points.push_back({u(k), f[k] + lift, 0});
    return value_of(Curve::bezier(points));
  }
  Curve reversed(double lift) const {
    std::vector<Vec3> points;
    for (std::size_t k = 4; k-- > 0;) points.push_back({u(k), f[k] + lift, 0});
    return value_of(Curve::bezier(points));
  }
  Real at(Real u) const {
    const Real t = (u - from) / (Real(to) - from), s = 1 - t;
    return s * s * s * f[0] + 3 * s * s * t * f[1] + 3 * s * t * t * f[2] + t * t * t * f[3];
  }
  /// The length of (f', 1) at its longest for parameters 0 to 1.
  Real steepness() const {
    Real steepest = 0;
    for (int k = 0; k < 256; ++k) steepest = std::max(steepest, 256 * std::abs(at((k + 1) / 256.0L) - at(k / 256.0L)));
    return std::hypot(1.1L * steepest, 1.0L);
  }
  OutlinePlace draw(Random& random, double lift) const {
    const Real u = uniform(random, from, to);
    return {u, at(u) + lift, 0, 1};
  }

 private:
  double u(std::size_t k) const { return k == 3 ? to : from + static_cast<double>(k) * (to - from) / 3; }
};

/// The strip of a height above a graph.
inline Outline strip_outline(const Graph& graph, double height, bool hole) {
  const auto corner = [&](double u, double v) { return ParameterPoint{u, v}; };
  const Curve low = graph.curve(), high = graph.reversed(height);
  const Curve up = plane_line(corner(graph.to, graph.f[3]), corner(graph.to, graph.f[3] + height));
  const Curve down = plane_line(corner(graph.from, graph.f[0] + height), corner(graph.from, graph.f[0]));
  const Real steepness = graph.steepness();
  return {{{low, up, high, down}, hole},
          [=](Real u, Real v) {
            const Real above = (v - graph.at(u)) / steepness, below = (graph.at(u) + height - v) / steepness;
            return std::min({above, below, u - graph.from, graph.to - u});
          },
          [=](Random& random) { return graph.draw(random, random() % 2 == 0 ? 0 : height); }};
}

/// The part of a rectangle on one side of a graph over all of its width, with sides along the rectangle's.
inline Outline side_outline(const Domain& domain, std::array<double, 4> f, bool above) {
  const Graph graph{domain.u0, domain.u1, f};
  const double end = above ? domain.v1 : domain.v0;
  const Curve right = plane_line({domain.u1, f[3]}, {domain.u1, end}),
              back = plane_line({domain.u1, end}, {domain.u0, end}),
              left = plane_line({domain.u0, end}, {domain.u0, f[0]});
  const bool straight = f[0] == f[1] && f[1] == f[2] && f[2] == f[3];
  const Curve cut = straight ? plane_line({domain.u0, f[0]}, {domain.u1, f[3]}) : graph.curve();
  const Real steepness = graph.steepness();
  return {{{cut, right, back, left}, false},
          [=](Real u, Real v) { return (above ? v - graph.at(u) : graph.at(u) - v) / steepness; },
          [=](Random& random) { return graph.draw(random, 0); },
          straight ? 0.0L : 1.0L};
}

/// The outline with u and v exchanged.
inline Outline mirrored(const Outline& outline) {
  Outline out = outline;
  for (Curve& curve : out.loop.curves) {
    std::vector<Vec3> points;
    for (const Vec3& p : curve.points()) points.push_back({p.y, p.x, 0});
    curve = curve.is_rational()
                ? value_of(Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots(), curve.domain()))
                : value_of(Curve::b_spline(curve.degree(), points, curve.knots(), curve.domain()));
  }
  out.depth = [depth = outline.depth](Real u, Real v) { return depth(v, u); };
  out.draw = [draw = outline.draw](Random& random) -> OutlinePlace {
    const OutlinePlace place = draw(random);
    return {place.v, place.u, place.normal_v, place.normal_u};
  };
  return out;
}

}  // namespace tessera::test
