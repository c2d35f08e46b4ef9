#pragma once
// Closed shapes whose faces fail to meet along their edges.

#include <array>
#include <cmath>
#include <vector>

#include "support/quadrics.h"
#include "support/random_patches.h"
#include "tess_trim/closed_shape.h"

namespace tessera::test {

/// How the faces of a cube fail to meet, as lengths.
struct Fray {
  double size = 1e-3;         ///< of tilts and of the loops' teeth, at most
  bool open_corners = false;  ///< whether also the curves of one loop end apart
  double cut_off = 0;         ///< how far from the corners curves end; straight lines join them
  double pace = 0;            ///< how far along an edge its faces are apart at equal parameters, at most
  double room = 0.1;          ///< how far the planes reach beyond the cube's sides; 0: curves leave their domains
};

/// A unit cube. Each face is a larger, tilted plane, and its loop has teeth where other faces have other ones.
class FrayedCube {
 public:
  FrayedCube(const Fray& fray, std::uint64_t seed) : fray_(fray), random_(seed) {
    for (int k = 0; k < 8; ++k) shape_.vertices.push_back({corner(k)});
    Shell shell{{}, 0};
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        shell.faces.push_back(static_cast<std::uint32_t>(shape_.faces.size()));
        add_face(axis, side);
      }
    shape_.shells = {shell};
    shape_.solid_count = 1;
  }
  const Shape& shape() const { return shape_; }

 private:
  static Vec3 corner(int k) { return {double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)}; }
  static Vec3 unit(int axis) { return {double(axis == 0), double(axis == 1), double(axis == 2)}; }
  double off() { return uniform(random_, -fray_.size / 4, fray_.size / 4); }
  Vec3 plane_off() { return {off(), off(), 0}; }

  std::uint32_t edge(std::uint32_t start, std::uint32_t end) {
    for (std::uint32_t k = 0; k < shape_.edges.size(); ++k) {
      const BrepEdge& at = shape_.edges[k];
      if ((at.start == start && at.end == end) || (at.start == end && at.end == start)) return k;
    }
    shape_.edges.push_back({.start = start, .end = end});
    return static_cast<std::uint32_t>(shape_.edges.size() - 1);
  }

  void add_face(int axis, int side) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::vector<Vec3> points;
    const double low = -fray_.room, high = 1 + fray_.room;
    for (const double u : {low, high})
      for (const double v : {low, high}) points.push_back((side + off()) * unit(axis) + u * unit(b) + v * unit(c));
    const std::vector<double> knots{low, low, high, high};
    TrimLoop loop;
    const std::array<Vec3, 4> around{Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    std::array<Vec3, 4> moved;
    for (std::size_t k = 0; k < 4; ++k) moved[k] = around[k] + plane_off();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      const auto vertex = [&](const Vec3& at) {
        return static_cast<std::uint32_t>(side << axis | static_cast<int>(at.x) << b | static_cast<int>(at.y) << c);
      };
      const std::uint32_t start = vertex(around[k]), id = edge(start, vertex(around[next]));
      loop.curves.push_back(teeth(moved[k], moved[next]));
      loop.coedges.push_back({id, shape_.edges[id].start != start});
    }
    const BSplineSurface plane = value_of(BSplineSurface::polynomial(1, knots, 1, knots, points));
    shape_.faces.push_back({{.name = {}, .surface = plane, .trims = std::vector<TrimLoop>{loop}}, {}, {}});
  }

  Curve teeth(const Vec3& start, const Vec3& end) {
    constexpr int count = 7;
    const Vec3 from = start + fray_.cut_off * (end - start), to = end - fray_.cut_off * (end - start);
    std::vector<Vec3> points{from};
    std::vector<double> knots{0, 0};
    const double pace = fray_.pace > 0 ? uniform(random_, -2 * fray_.pace, 2 * fray_.pace) : 0;
    for (int k = 1; k < count; ++k) {
      const double x = double(k) / count, at = x + pace * x * (1 - x);
      points.push_back((1 - at) * from + at * to + plane_off());
      knots.push_back(x);
    }
    points.push_back(to);
    if (fray_.open_corners) points.front() += plane_off(), points.back() += plane_off();
    knots.push_back(1), knots.push_back(1);
    return value_of(Curve::b_spline(1, points, knots));
  }

  Fray fray_;
  Random random_;
  Shape shape_;
};

/// A plate with a round hole whose wall is narrower than the holes of the plate's faces by `gap`; see drilled_plate().
inline Shape gaping_plate(double gap) {
  std::vector<ModelSurface> faces = drilled_plate();
  faces.back() = hole_wall(1.7, 1.4, 0.6 - gap);
  return value_of(joined_shape(faces, 2 * gap + 1e-6));
}

inline ModelSurface quadric_face(const QuadricPiece& part) { return {.name = std::string("quadric"), .surface = part}; }
/// A disc across the z axis, its normal along it or against it.
inline ModelSurface disc(double z, double radius, bool up) {
  const double a = 1.2 * radius;
  const Vec3 along{2 * a, 0, 0}, across{0, 2 * a, 0};
  return rectangle_face({-a, -a, z}, up ? along : across, up ? across : along, {circle_loop(a, a, radius, false, 0.3)});
}
/// A round bar of radius and length 1 with a seam; its ends are narrower by `gap`.
inline Shape round_bar(double gap) {
  constexpr double pi = std::numbers::pi;
  const ModelSurface wall = quadric_face(piece(quadric({.a = 1, .b = 1, .k = -1}), {0, 2 * pi, 0, 1}));
  return value_of(joined_shape(std::vector{wall, disc(0, 1 - gap, false), disc(1, 1 - gap, true)}, 2 * gap + 1e-6));
}
/// Half a ball with a seam and a pole, on a disc that is narrower by `gap`.
inline Shape half_ball(double gap) {
  constexpr double pi = std::numbers::pi;
  const ModelSurface dome = quadric_face(piece(quadric({.a = 1, .b = 1, .c = 1, .k = -1}), {0, 2 * pi, 0, pi / 2}));
  return value_of(joined_shape(std::vector{dome, disc(0, 1 - gap, false)}, 2 * gap + 1e-6));
}

}  // namespace tessera::test
