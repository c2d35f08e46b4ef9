#pragma once
// Packs one patch into its lanes of a block.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/patch_set.h"

namespace tessera { inline namespace abi_0_1 {

/// The number of components of a coefficient: x, y, z, and w for rational patches.
constexpr int coefficient_components(bool rational) { return rational ? 4 : 3; }

/// The number of values in one block of these degrees.
constexpr std::size_t block_values(int degree_u, int degree_v, bool rational) {
  return static_cast<std::size_t>((degree_u + 1) * (degree_v + 1) * coefficient_components(rational) * PatchSet::lanes);
}

/// The number of values from one patch to the next where patches lie one by one: whole cache lines in either precision.
constexpr std::size_t point_values(int degree_u, int degree_v, bool rational) {
  const std::size_t line = 16, values = block_values(degree_u, degree_v, rational) / PatchSet::lanes;
  return (values + line - 1) / line * line;
}

/// The limit for the Bernstein coefficients of a patch, relative to the origin and over the largest weight, that keeps
/// second derivatives finite.
///
/// Second derivatives of degree d are at most 4 d^2 times the coefficients, and the quotient rule divides twice by a
/// weight.
/// `weight_ratio`: the smallest weight over the largest. For power coefficients, of which a second derivative sums up
/// (d + 1)^2 d^2, the limit is that of ratio 1.
inline double largest_coefficient(bool in_float, double weight_ratio) {
  const double most = in_float ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  return 0x1p-16 * most * weight_ratio * weight_ratio;
}

/// The coefficients of `patch` relative to `origin` o, `[i][j][component]`, in the Bernstein basis or in powers of u
/// and v: V - o, or w (V - o) and w. Weights are divided by a power of two that brings the largest near 1. So they fit
/// float whatever their size, and borders that patches share keep their bits.
class RelativeNet {
 public:
  RelativeNet(const BezierPatch& patch, const Vec3& origin);

  double lightest() const { return scale_ * low_; }      ///< the smallest divided weight
  double heaviest() const { return scale_ * high_; }     ///< the largest divided weight
  double weight_ratio() const { return low_ / high_; }   ///< at most 1
  double weight_spread() const { return high_ / low_; }  ///< at least 1

  /// Returns the largest |x|, |y| or |z| of the Bernstein coefficients. `hull`: patch.hull_box(). For a polynomial
  /// patch its corners give the result, because rounding a difference keeps order.
  double largest(const Box3& hull) const;
  /// Returns the size that errors of tangents are proportional to, over the weight (sample_kernel.inl.h): largest() for
  /// a polynomial patch, the largest |V - o| times the largest weight for a rational one.
  double tangent_size(const Box3& hull) const { return heaviest() * farthest(hull); }
  /// Writes the Bernstein coefficients into the lane that begins at `lane`, rounding to T once.
  template <class T>
  void write(T* lane) const {
    for_each([&](double value) {
      *lane = static_cast<T>(value);
      lane += PatchSet::lanes;
    });
  }

  /// Writes the Bernstein coefficients `[i][component][j]`, and zeros up to `size` values.
  template <class T>
  void write_rows(T* rows, std::size_t size) const {
    const std::size_t components = static_cast<std::size_t>(coefficient_components(patch_.is_rational()));
    const std::size_t columns = static_cast<std::size_t>(patch_.degree_v()) + 1;
    std::size_t row = 0, j = 0, c = 0;  // where the next value goes
    for_each([&](double value) {
      rows[row + c * columns + j] = static_cast<T>(value);
      if (++c < components) return;
      c = 0;
      if (++j < columns) return;
      j = 0;
      row += components * columns;
    });
    std::fill(rows + row, rows + size, T(0));
  }

  using Power = std::array<double, (max_degree + 1) * (max_degree + 1) * 4>;
  /// Returns the power coefficients, stored in `memory`.
  std::span<const double> power(Power& memory) const;

 private:
  /// Calls put(value) for each Bernstein coefficient. Equal control points give equal bits: adding +0 turns -0 into +0.
  template <class Put>
  void for_each(Put put) const {
    const auto points = patch_.points();
    const auto weights = patch_.weights();
    if (weights.empty()) {
      const Vec3 shift = Vec3{} - origin_;  // neither it nor a sum with it is -0
      for (const Vec3& point : points) {
        put(point.x + shift.x);
        put(point.y + shift.y);
        put(point.z + shift.z);
      }
    } else {
      for (std::size_t k = 0; k < points.size(); ++k) {
        const double w = scale_ * weights[k];
        const Vec3 q = w * (points[k] - origin_ + Vec3{}) + Vec3{};
        for (const double value : {q.x, q.y, q.z, w}) put(value);
      }
    }
  }

  /// Returns the largest |x|, |y| or |z| of V - o.
  double farthest(const Box3& hull) const {
    return std::max(max_abs(hull.lower - origin_), max_abs(hull.upper - origin_));
  }

  const BezierPatch& patch_;
  const Vec3 origin_;
  double low_ = 1, high_ = 1, scale_ = 1;  // the least and the largest weight, and the factor of all
};

/// Where r_u x r_v can't be distinguished from zero in a block's arithmetic.
struct DegenerateNormalThreshold {
  double squared_length = 0;  ///< at or below this |r_u x r_v|^2 the tangents' rounding errors count
  double noise = 0;  ///< the largest error of a tangent's component, times the weight; negative: no normal anywhere
};

/// Whether all rows or all columns of the net are equal (for rational patches: both), so that r_u or r_v is zero
/// everywhere. `collapsed`: patch.collapsed_sides(); equal rows have two collapsed ends.
bool is_curve(const BezierPatch& patch, SideMask collapsed);

/// The threshold of a patch that is a curve.
inline constexpr DegenerateNormalThreshold no_normal{.squared_length = std::numeric_limits<double>::infinity(),
                                                     .noise = -1};

/// The largest error of a tangent where RelativeNet::tangent_size() is 1; `degree` = max(m, n).
///
/// The factor 6: a tangent is a sum of n differences times n, and random nets of all degrees reach 4 n units, tangents
/// that vanish 1.6 n; half as much again is the margin. (The worst case is (m + n + 6) n, see
/// kernel/sample/sample_kernel.inl.h. A lane between the two costs time at most: its normal is computed exactly.)
template <class T>
constexpr double tangent_noise(int degree) {
  return 6 * degree * double{std::numeric_limits<T>::epsilon()};
}
/// The largest |r_u| or |r_v| where the hull's box has the diameter 1.
constexpr double longest_tangent(int degree, double weight_spread = 1) { return degree * weight_spread; }

/// The least squared length that a kernel reads. Of smaller ones the smallest products would be subnormal and lose
/// digits: 2^-80 is 2^46 times the smallest normal float, 2^-600 is 2^422 times the smallest normal double.
template <class T>
inline constexpr double min_threshold = sizeof(T) == 4 ? 0x1p-80 : 0x1p-600;

/// The threshold of a patch that is no curve, in blocks of T.
///
/// `degree` = max(m, n); `size`: RelativeNet::tangent_size(); `diameter`: that of the hull's box. The error of a
/// tangent is tangent_noise() times `size`, over the weight for rational patches. The lengths |r_u|, |r_v| are at most
/// max(m, n) (largest weight / smallest) diameter (Floater 1992, Derivatives of rational Bezier curves, eq. 10). If
/// each component of two tangents is off by e, r_u x r_v is off by at most sqrt(3) e (|r_u| + |r_v|).
template <class T>
DegenerateNormalThreshold normal_threshold(int degree, double size, double diameter, double lightest,
                                           double weight_spread) {
  const double noise = tangent_noise<T>(degree) * size;
  const double longest = longest_tangent(degree, weight_spread) * diameter;
  const double length = 4 * (noise / lightest) * longest;  // 2 sqrt(3) noise |r_u|, rounded up
  return {.squared_length = length * length, .noise = noise};
}

/// The threshold as a kernel reads it: squared length, noise.
template <class T>
std::array<T, 2> threshold_in(const DegenerateNormalThreshold& threshold) {
  const double largest = std::numeric_limits<T>::max();
  return {static_cast<T>(std::clamp(threshold.squared_length, min_threshold<T>, largest)),
          static_cast<T>(std::min(threshold.noise, largest))};
}

}}  // namespace tessera::abi_0_1
