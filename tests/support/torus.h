#pragma once
// A torus as a closed uniform bicubic B-spline surface: its control points and its patches.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/bezier_patch.h"

namespace tessera::test {

/// side x side control points, the indices of which wrap around; as many patches.
class Torus {
 public:
  explicit Torus(std::size_t side) : side_(side) {
    const auto angle = [&](std::size_t k) {
      return 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(side);
    };
    for (std::size_t i = 0; i < side; ++i) {
      for (std::size_t j = 0; j < side; ++j) {
        const double a = angle(i), b = angle(j), radius = 1 + 0.4 * std::cos(b);
        points_.push_back({radius * std::cos(a), radius * std::sin(a), 0.4 * std::sin(b)});
      }
    }
  }

  std::size_t side() const { return side_; }
  const Vec3& point(std::size_t i, std::size_t j) const { return points_[(i % side_) * side_ + j % side_]; }
  const std::vector<Vec3>& points() const { return points_; }

  /// Polynomial, or rational with weights between 1 and 2 that neighbours share.
  std::vector<BezierPatch> patches(bool rational) const {
    std::vector<BezierPatch> out;
    for (std::size_t i = 0; i < side_; ++i) {
      for (std::size_t j = 0; j < side_; ++j) out.push_back(patch(i, j, rational));
    }
    return out;
  }

 private:
  /// Farin, Curves and Surfaces for CAGD, 5th ed., sec. 8.2: the pieces of a uniform cubic.
  BezierPatch patch(std::size_t i, std::size_t j, bool rational) const {
    constexpr double share[4][4] = {
        {1 / 6., 4 / 6., 1 / 6., 0}, {0, 4 / 6., 2 / 6., 0}, {0, 2 / 6., 4 / 6., 0}, {0, 1 / 6., 4 / 6., 1 / 6.}};
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (const auto& along_u : share) {
      for (const auto& along_v : share) {
        Vec3 sum;
        for (std::size_t k = 0; k < 4; ++k) {
          for (std::size_t l = 0; l < 4; ++l) sum += (along_u[k] * along_v[l]) * point(i + k, j + l);
        }
        points.push_back(sum);
        weights.push_back(1.5 + 0.5 * std::sin(9 * sum.x) * std::cos(7 * sum.y + sum.z));
      }
    }
    return value_of(rational ? BezierPatch::rational(3, 3, points, weights) : BezierPatch::polynomial(3, 3, points));
  }

  std::size_t side_;
  std::vector<Vec3> points_;
};

}  // namespace tessera::test
