#pragma once
// Random sets whose patches meet, and edits of all kinds: those that keep borders together, and those that do not.

#include <map>
#include <tuple>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess/followed_mesh.h"

namespace tessera::test {

/// The faces of a cube, `k` x `k` patches of a degree each, blown up and moved by `noise`. They share control points.
inline std::vector<BezierPatch> random_cube(Random& random, int k, int degree, double noise, bool rational_patches) {
  const int size = k * degree;
  struct Node {
    Vec3 point;
    double weight;
  };
  std::map<std::array<int, 3>, Node> nodes;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = nodes.try_emplace(at);
    if (is_new) {
      const auto place = [&](std::size_t c) { return 2.0 * at[c] / size - 1; };
      found->second.point = normalized(Vec3{place(0), place(1), place(2)}) + noise * uniform_vector(random, -1, 1);
      found->second.weight = uniform(random, 0.6, 1.6);
    }
    return found->second;
  };
  std::vector<BezierPatch> patches;
  for (std::size_t face = 0; face < 6; ++face)
    for (int a = 0; a < k; ++a)
      for (int b = 0; b < k; ++b) {
        std::vector<Vec3> points;
        std::vector<double> weights;
        for (int i = 0; i <= degree; ++i)
          for (int j = 0; j <= degree; ++j) {
            const std::size_t axis = face / 2, other = face % 2 == 0 ? 1 : 2;
            std::array<int, 3> at{};
            at[axis] = face % 2 == 0 ? 0 : size;
            at[(axis + 3 - other) % 3] = a * degree + i, at[(axis + other) % 3] = b * degree + j;
            points.push_back(node(at).point);
            weights.push_back(rational_patches ? node(at).weight : 1);
          }
        patches.push_back(rational(degree, degree, points, weights));
      }
  return patches;
}

/// A strip of patches that share borders: flat where `height` is 0.
inline std::vector<BezierPatch> random_strip(Random& random, int count, int degree, double height) {
  const auto row = [&](double x) {
    std::vector<Vec3> points;
    for (int j = 0; j <= degree; ++j) points.push_back({x, double(j) / degree, height * uniform(random, -1, 1)});
    return points;
  };
  std::vector<BezierPatch> patches;
  std::vector<Vec3> first = row(0);
  for (int k = 0; k < count; ++k) {
    std::vector<Vec3> points = first;
    for (int i = 1; i <= degree; ++i) {
      first = row(k + double(i) / degree);
      points.insert(points.end(), first.begin(), first.end());
    }
    patches.push_back(polynomial(degree, degree, points));
  }
  return patches;
}

inline std::vector<BezierPatch> random_set(Random& random) {
  const int degree = 1 + static_cast<int>(random() % 3), kind = static_cast<int>(random() % 6);
  std::vector<BezierPatch> patches = kind < 3    ? random_cube(random, 1, degree, 0.2, kind == 2)
                                     : kind == 3 ? random_cube(random, 2, degree, 0.1, false)
                                     : kind == 4 ? wavy_field(2, 3)
                                                 : random_strip(random, 3, degree, uniform(random, 0, 0.3));
  for (BezierPatch& patch : patches) patch = reoriented(patch, static_cast<int>(random() % 8));
  return patches;
}

/// Makes edits of a set.
class RandomEdits {
 public:
  RandomEdits(const PatchSet& set, Random& random) : set_(set), random_(random) {}

  /// Edits that keep the same borders joined: common points move together, others alone.
  Edits together() {
    switch (random_() % 4) {
      case 0:
        return common_point_moved();
      case 1:
        return inner_points_moved();
      case 2:
        return all_moved(uniform(random_, 0.3, 2));
      default:
        return nothing();
    }
  }
  /// Edits that part borders, make new neighbours, turn patches around, or make borders short.
  Edits apart() {
    Edits edits = one_patch();
    const std::size_t patch = edits.patch[0];
    const int m = set_.patch(patch).degree_u(), n = set_.patch(patch).degree_v();
    const auto at = [&](int i, int j) -> Vec3& { return edits.points[static_cast<std::size_t>(i * (n + 1) + j)]; };
    switch (random_() % 7) {
      case 0:
        pick(edits.points) += any_move();
        break;
      case 1:
        for (const Vec3 by = any_move(); Vec3 & p : edits.points) p += by;
        break;
      case 2:
        std::ranges::reverse(edits.points);
        break;
      case 3:
        for (int i = 0; i <= m / 2; ++i)
          for (int j = 0; j <= n; ++j) std::swap(at(i, j), at(m - i, j));
        break;
      case 4:
        squeeze(edits.points, m, n, random_() % 2 == 0 ? 0 : size());
        break;
      case 5:
        make_thin(edits.points, m, n);
        break;
      default:
        take_border(edits.points, patch, m, n);
        break;
    }
    return edits;
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  Vec3& pick(std::vector<Vec3>& points) { return points[below(points.size())]; }
  /// A length from 1e-6 to about 1.
  double size() { return std::pow(10.0, uniform(random_, -6, 0)); }
  Vec3 any_move() { return size() * uniform_vector(random_, -1, 1); }
  Edits of(std::size_t patch) const {
    const auto points = set_.patch(patch).points();
    return {{static_cast<std::uint32_t>(patch)}, {points.begin(), points.end()}};
  }
  Edits one_patch() { return of(below(set_.patch_count())); }
  Edits nothing() { return one_patch(); }

  Edits common_point_moved() {
    std::vector<Vec3> points = one_patch().points;
    const Vec3 point = pick(points), by = any_move();
    Edits edits;
    for (std::size_t k = 0; k < set_.patch_count(); ++k) {
      const auto own = set_.patch(k).points();
      if (std::ranges::find(own, point) == own.end()) continue;
      edits.patch.push_back(static_cast<std::uint32_t>(k));
      for (const Vec3& p : own) edits.points.push_back(p == point ? p + by : p);
    }
    return edits;
  }
  Edits inner_points_moved() {
    Edits edits = one_patch();
    const int m = set_.patch(edits.patch[0]).degree_u(), n = set_.patch(edits.patch[0]).degree_v();
    for (int i = 1; i < m; ++i)
      for (int j = 1; j < n; ++j) edits.points[static_cast<std::size_t>(i * (n + 1) + j)] += any_move();
    return edits;
  }
  Edits all_moved(double scale) {
    return moved(set_, 1, [scale](const Vec3& p) { return Vec3{p.x, p.y, scale * p.z}; });
  }
  /// Makes border u = 0 or v = 0 a point, or shorter by a factor.
  void squeeze(std::vector<Vec3>& points, int m, int n, double factor) {
    const bool along_v = random_() % 2 == 0;
    for (int k = 0; k <= (along_v ? n : m); ++k) {
      Vec3& p = points[static_cast<std::size_t>(along_v ? k : k * (n + 1))];
      p = points[0] + factor * (p - points[0]);
    }
  }
  void make_thin(std::vector<Vec3>& points, int m, int n) {
    const double factor = size();
    for (int i = 0; i <= m; ++i)
      for (int j = 1; j <= n; ++j) {
        const Vec3 first = points[static_cast<std::size_t>(i * (n + 1))];
        Vec3& p = points[static_cast<std::size_t>(i * (n + 1) + j)];
        p = first + factor * (p - first);
      }
  }
  /// Makes border u = 0 that of another patch, in either direction.
  void take_border(std::vector<Vec3>& points, std::size_t patch, int m, int n) {
    const BezierPatch& other = set_.patch((patch + 1 + below(set_.patch_count())) % set_.patch_count());
    if (other.degree_v() != n || other.is_rational() || m < 1) return;
    const bool backwards = random_() % 2 == 0;
    for (int j = 0; j <= n; ++j)
      points[static_cast<std::size_t>(j)] = other.point(other.degree_u(), backwards ? n - j : j);
  }

  const PatchSet& set_;
  Random& random_;
};

}  // namespace tessera::test
