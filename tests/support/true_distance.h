#pragma once
// The true distance between a patch and a triangle of its mesh, by branch and bound. Shares no code with the bounds
// that tessellations are made with.

#include <algorithm>
#include <array>
#include <queue>
#include <span>
#include <vector>

#include "support/triangle_distance.h"
#include "tessera/bezier_patch.h"
#include "tessera/mesh.h"

namespace tessera::test {

/// Corners of a triangle: their places in the patch's parameters, and in space (they may be rounded, or off the patch).
struct MeshTriangle {
  std::array<std::array<double, 2>, 3> parameters;
  std::array<Vec3, 3> corners;
};

/// A triangle of a mesh, by the parameters of its vertices.
inline MeshTriangle triangle_of(const Mesh& mesh, std::size_t t) {
  MeshTriangle triangle;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t k = mesh.indices[3 * t + c];
    triangle.parameters[c] = {mesh.parameters[2 * k], mesh.parameters[2 * k + 1]};
    triangle.corners[c] =
        mesh.origin + Vec3{mesh.positions[3 * k], mesh.positions[3 * k + 1], mesh.positions[3 * k + 2]};
  }
  return triangle;
}

/// The triangles among [begin, end) of a mesh that share an edge with triangle t, and t itself. They belong to one
/// patch.
inline std::vector<MeshTriangle> triangles_around(const Mesh& mesh, std::size_t t, std::size_t begin, std::size_t end) {
  std::vector<MeshTriangle> around;
  for (std::size_t other = begin; other < end; ++other) {
    int shared = 0;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) shared += mesh.indices[3 * t + a] == mesh.indices[3 * other + b];
    if (shared >= 2) around.push_back(triangle_of(mesh, other));
  }
  return around;
}

/// An interval that contains the largest distance.
struct DistanceRange {
  double low = 0, high = 0;
};

namespace true_distance {

/// The net of a piece of a patch, in homogeneous form, over the box [u0,u1] x [v0,v1] of the patch's parameters.
struct Piece {
  double u0, u1, v0, v1;
  std::vector<std::array<double, 4>> net;
  double bound = 0;
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

inline double lerp(double a, double b, double t) { return (1 - t) * a + t * b; }

/// The part from `t` on, or up to `t`, of each line of a net.
inline void cut(Piece& piece, int lines, int line_step, int count, int step, double t, bool keep_low) {
  for (int line = 0; line < lines; ++line) {
    const auto at = [&](int i) -> std::array<double, 4>& {
      return piece.net[static_cast<std::size_t>(line * line_step + i * step)];
    };
    for (int round = 1; round < count; ++round) {
      for (int k = 0; k + round < count; ++k) {
        const int to = keep_low ? count - 1 - k : k;
        const int from = keep_low ? to - 1 : to + 1;
        for (std::size_t c = 0; c < 4; ++c)
          at(to)[c] = keep_low ? lerp(at(from)[c], at(to)[c], t) : lerp(at(to)[c], at(from)[c], t);
      }
    }
  }
}

class Search {
 public:
  Search(const BezierPatch& patch, const MeshTriangle& triangle, std::span<const MeshTriangle> nearby)
      : m_(patch.degree_u()), n_(patch.degree_v()), triangle_(triangle), nearby_(nearby) {
    Piece whole{0, 1, 0, 1, {}, 0};
    for (int i = 0; i <= m_; ++i)
      for (int j = 0; j <= n_; ++j) {
        const double w = patch.weight(i, j);
        const Vec3& p = patch.point(i, j);
        whole.net.push_back({w * p.x, w * p.y, w * p.z, w});
      }
    const auto [u0, u1] = range(0);
    const auto [v0, v1] = range(1);
    keep(whole, u0, u1, v0, v1);
    add(std::move(whole));
  }

  DistanceRange run(double precision, int max_steps) {
    for (int step = 0; step < max_steps && !pieces_.empty(); ++step) {
      if (pieces_.top().bound <= low_ * (1 + precision)) break;
      const Piece top = pieces_.top();
      pieces_.pop();
      const double u = (top.u0 + top.u1) / 2, v = (top.v0 + top.v1) / 2;
      for (const bool low_u : {false, true})
        for (const bool low_v : {false, true}) {
          Piece part = top;
          keep(part, low_u ? top.u0 : u, low_u ? u : top.u1, low_v ? top.v0 : v, low_v ? v : top.v1);
          add(std::move(part));
        }
    }
    return {low_, pieces_.empty() ? low_ : std::max(low_, pieces_.top().bound)};
  }

 private:
  std::pair<double, double> range(std::size_t c) const {
    const auto& p = triangle_.parameters;
    return {std::min({p[0][c], p[1][c], p[2][c]}), std::max({p[0][c], p[1][c], p[2][c]})};
  }

  void keep(Piece& piece, double u0, double u1, double v0, double v1) const {
    const int row = n_ + 1;
    if (u1 < piece.u1) cut(piece, row, 1, m_ + 1, row, (u1 - piece.u0) / (piece.u1 - piece.u0), true), piece.u1 = u1;
    if (u0 > piece.u0) cut(piece, row, 1, m_ + 1, row, (u0 - piece.u0) / (piece.u1 - piece.u0), false), piece.u0 = u0;
    if (v1 < piece.v1) cut(piece, m_ + 1, row, row, 1, (v1 - piece.v0) / (piece.v1 - piece.v0), true), piece.v1 = v1;
    if (v0 > piece.v0) cut(piece, m_ + 1, row, row, 1, (v0 - piece.v0) / (piece.v1 - piece.v0), false), piece.v0 = v0;
  }

  static double distance(const Vec3& p, const MeshTriangle& triangle) {
    return distance_to_triangle(p, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
  }
  double distance(const Vec3& p) const {
    double least = 1e300;
    for (const MeshTriangle& triangle : nearby_) least = std::min(least, distance(p, triangle));
    return least;
  }

  /// Twice the signed area of the parameter triangle with its corner k replaced.
  double side(std::size_t k, double u, double v) const {
    const auto& a = triangle_.parameters[(k + 1) % 3];
    const auto& b = triangle_.parameters[(k + 2) % 3];
    return (b[0] - a[0]) * (v - a[1]) - (u - a[0]) * (b[1] - a[1]);
  }
  bool outside(const Piece& piece) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double in = side(k, triangle_.parameters[k][0], triangle_.parameters[k][1]);
      const double sign = in < 0 ? -1 : 1;
      double most = -1e300;
      for (const double u : {piece.u0, piece.u1})
        for (const double v : {piece.v0, piece.v1}) most = std::max(most, sign * side(k, u, v));
      if (most < 0) return true;
    }
    return false;
  }
  bool inside(double u, double v) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double in = side(k, triangle_.parameters[k][0], triangle_.parameters[k][1]);
      if ((in < 0 ? -1 : 1) * side(k, u, v) < 0) return false;
    }
    return true;
  }

  /// The distance from a triangle is convex: over the hull of the control points it is largest at one of them. The
  /// distance from the nearest of several triangles is at most that from the best one.
  void add(Piece piece) {
    if (outside(piece)) return;
    piece.bound = 1e300;
    for (const MeshTriangle& triangle : nearby_) {
      double most = 0;
      for (const auto& a : piece.net)
        most = std::max(most, distance({a[0] / a[3], a[1] / a[3], a[2] / a[3]}, triangle));
      piece.bound = std::min(piece.bound, most);
    }
    const std::size_t row = static_cast<std::size_t>(n_) + 1, last = piece.net.size() - 1;
    const std::array<std::pair<std::size_t, std::array<double, 2>>, 4> ends{{{0, {piece.u0, piece.v0}},
                                                                             {row - 1, {piece.u0, piece.v1}},
                                                                             {last + 1 - row, {piece.u1, piece.v0}},
                                                                             {last, {piece.u1, piece.v1}}}};
    for (const auto& [k, place] : ends)
      if (const auto& a = piece.net[k]; inside(place[0], place[1]))
        low_ = std::max(low_, distance({a[0] / a[3], a[1] / a[3], a[2] / a[3]}));
    pieces_.push(std::move(piece));
  }

  int m_, n_;
  const MeshTriangle& triangle_;
  std::span<const MeshTriangle> nearby_;
  double low_ = 0;
  std::priority_queue<Piece> pieces_;
};

}  // namespace true_distance

/// The largest distance from the triangle, over points of the patch whose parameters lie in the parameter triangle, to
/// a relative precision, or as precise as `max_steps` subdivisions make it.
inline DistanceRange largest_distance(const BezierPatch& patch, const MeshTriangle& triangle, double precision = 0.01,
                                      int max_steps = 2000) {
  return true_distance::Search(patch, triangle, {&triangle, 1}).run(precision, max_steps);
}

/// The largest distance from triangle t and those of the patch's triangles [begin, end) that share an edge with it,
/// over the same points. Points of the patch may lie nearest to a neighbour of the triangle over their parameters.
inline DistanceRange largest_distance(const BezierPatch& patch, const Mesh& mesh, std::size_t t, std::size_t begin,
                                      std::size_t end, double precision = 0.01, int max_steps = 2000) {
  const std::vector<MeshTriangle> around = triangles_around(mesh, t, begin, end);
  return true_distance::Search(patch, triangle_of(mesh, t), around).run(precision, max_steps);
}

}  // namespace tessera::test
