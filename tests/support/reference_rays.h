#pragma once
// A ray caster in plain double that shares nothing with the library: every patch, subdivision of the projected net,
// then Newton's method. Slow.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

struct ReferenceHit {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t patch = 0;
  double u = 0, v = 0;
  bool hit() const { return std::isfinite(t); }
};

/// A net of homogeneous (across, across, along, weight) in the ray's frame over a rectangle of parameters.
class ProjectedNet {
 public:
  using Point = std::array<double, 4>;

  ProjectedNet(const BezierPatch& patch, const Vec3& origin, const Vec3& e1, const Vec3& e2, const Vec3& unit)
      : m_(patch.degree_u()), n_(patch.degree_v()) {
    for (int i = 0; i <= m_; ++i) {
      for (int j = 0; j <= n_; ++j) {
        const Vec3 p = patch.point(i, j) - origin;
        const double w = patch.weight(i, j);
        points_.push_back({w * dot(e1, p), w * dot(e2, p), w * dot(unit, p), w});
      }
    }
  }

  /// Whether the hull may contain a root.
  bool may_meet() const {
    for (std::size_t c = 0; c < 2; ++c) {
      const auto [low, high] = std::minmax_element(points_.begin(), points_.end(),
                                                   [c](const Point& a, const Point& b) { return a[c] < b[c]; });
      if ((*low)[c] > 0 || (*high)[c] < 0) return false;
    }
    return true;
  }

  /// The halves along u (true) or v.
  std::array<ProjectedNet, 2> split(bool along_u) const {
    std::array<ProjectedNet, 2> halves{*this, *this};
    const int lines = along_u ? n_ : m_, degree = along_u ? m_ : n_;
    for (int line = 0; line <= lines; ++line) {
      const auto at = [&](int k) { return along_u ? index(k, line) : index(line, k); };
      std::vector<Point> row;
      for (int k = 0; k <= degree; ++k) row.push_back(points_[at(k)]);
      for (int level = 0; level <= degree; ++level) {
        halves[0].points_[at(level)] = row.front();
        halves[1].points_[at(degree - level)] = row.back();
        for (std::size_t k = 0; k + 1 < row.size(); ++k) {
          for (std::size_t c = 0; c < 4; ++c) row[k][c] = 0.5 * (row[k][c] + row[k + 1][c]);
        }
        row.pop_back();
      }
    }
    const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
    (along_u ? halves[0].u1 : halves[0].v1) = along_u ? u : v;
    (along_u ? halves[1].u0 : halves[1].v0) = along_u ? u : v;
    return halves;
  }

  /// The point by the definition: sum of Bernstein polynomials, s and t local.
  Point at(double s, double t) const {
    Point sum{};
    for (int i = 0; i <= m_; ++i) {
      for (int j = 0; j <= n_; ++j) {
        const double b = bernstein(m_, i, s) * bernstein(n_, j, t);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += b * points_[index(i, j)][c];
      }
    }
    return sum;
  }

  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (n_ + 1) + j); }
  static double bernstein(int n, int i, double t) {
    double value = 1;
    for (int k = 1; k <= i; ++k) value *= t * (n - i + k) / k;
    for (int k = 0; k < n - i; ++k) value *= 1 - t;
    return value;
  }

  int m_, n_;
  std::vector<Point> points_;
};

/// Newton's method with difference quotients, on a net so small that it is nearly bilinear. Roots up to a hundredth
/// outside count: the neighbouring net finds them too.
inline bool solve(const ProjectedNet& net, double& s, double& t) {
  s = t = 0.5;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 30; ++step) {
    constexpr double h = 1e-5;
    const auto f = net.at(s, t), fs1 = net.at(s + h, t), fs0 = net.at(s - h, t), ft1 = net.at(s, t + h),
               ft0 = net.at(s, t - h);
    const double a = (fs1[0] - fs0[0]) / (2 * h), b = (ft1[0] - ft0[0]) / (2 * h);
    const double c = (fs1[1] - fs0[1]) / (2 * h), d = (ft1[1] - ft0[1]) / (2 * h);
    const double determinant = a * d - b * c;
    const double ds = (f[0] * d - f[1] * b) / determinant, dt = (a * f[1] - c * f[0]) / determinant;
    if (!std::isfinite(ds) || !std::isfinite(dt)) return false;
    s -= ds, t -= dt;
    const double size = std::max(std::abs(ds), std::abs(dt));
    if (size < 1e-9 && size >= last) break;
    if (!(std::abs(s - 0.5) < 2 && std::abs(t - 0.5) < 2)) return false;
    last = size;
  }
  return last < 1e-6 && std::abs(s - 0.5) <= 0.51 && std::abs(t - 0.5) <= 0.51;
}

inline void reference_roots(const ProjectedNet& net, int depth, std::uint32_t patch, double scale, const Ray& ray,
                            ReferenceHit& best) {
  if (!net.may_meet()) return;
  constexpr int shallow = 12, deepest = 44;  // halvings: 6 and 22 in each direction
  if (depth >= shallow) {
    double s = 0.5, t = 0.5;
    const bool found = solve(net, s, t);
    if (found || depth == deepest) {
      const auto p = net.at(s, t);
      const double at = p[2] / p[3] / scale;
      const double u = net.u0 + s * (net.u1 - net.u0), v = net.v0 + t * (net.v1 - net.v0);
      const bool in_patch = std::abs(u - 0.5) <= 0.5 + 1e-12 && std::abs(v - 0.5) <= 0.5 + 1e-12;
      if (in_patch && at >= ray.tnear && at <= ray.tfar && at < best.t) best = {at, patch, u, v};
      if (found) return;
    }
    if (depth == deepest) return;
  }
  for (const ProjectedNet& half : net.split(depth % 2 == 0)) reference_roots(half, depth + 1, patch, scale, ray, best);
}

/// The closest point of the patches on the ray.
inline ReferenceHit reference_closest(std::span<const BezierPatch> patches, const Ray& ray) {
  const Vec3 unit = normalized(ray.direction);
  const Vec3 e1 = normalized(cross(unit, std::abs(unit.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), e2 = cross(unit, e1);
  ReferenceHit best;
  for (std::uint32_t k = 0; k < patches.size(); ++k) {
    reference_roots(ProjectedNet(patches[k], ray.origin, e1, e2, unit), 0, k, length(ray.direction), ray, best);
  }
  return best;
}

}  // namespace tessera::test
