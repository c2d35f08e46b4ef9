#pragma once
// One patch into its lanes of a block.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/patch_set.h"

namespace tessera::inline abi_0_1 {

/// Components of a coefficient: x, y, z, and w for rational patches.
constexpr int coefficient_components(bool rational) { return rational ? 4 : 3; }

/// Values in one block of these degrees.
constexpr std::size_t block_values(int degree_u, int degree_v, bool rational) {
  return static_cast<std::size_t>((degree_u + 1) * (degree_v + 1) * coefficient_components(rational) * PatchSet::lanes);
}

/// Values from one patch to the next where patches lie one by one: whole cache lines in either precision.
constexpr std::size_t point_values(int degree_u, int degree_v, bool rational) {
  const std::size_t line = 16, values = block_values(degree_u, degree_v, rational) / PatchSet::lanes;
  return (values + line - 1) / line * line;
}

/// What the Bernstein coefficients of a patch, relative to the origin and over the largest weight, may reach, so that second
/// derivatives are numbers: those of degree d are at most 4 d^2 times the coefficients, and the quotient rule divides twice
/// by a weight. `weight_ratio`: of the smallest weight to the largest. Coefficients of powers, of which a second derivative
/// sums up (d + 1)^2 d^2, may reach what it gives for ratio 1.
inline double largest_coefficient(bool in_float, double weight_ratio) {
  const double most = in_float ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  return 0x1p-16 * most * weight_ratio * weight_ratio;
}

/// The coefficients of `patch` relative to `origin`, `[i][j][component]`: (V - o, or w (V - o) and w) in the Bernstein
/// basis, or the same in powers of u and v. Weights are divided by a power of two that brings the largest near 1: they
/// fit float whatever their size, and borders shared by patches keep their bits.
class RelativeNet {
 public:
  RelativeNet(const BezierPatch& patch, const Vec3& origin);

  double lightest() const { return scale_ * low_; }  ///< weight, once divided
  double heaviest() const { return scale_ * high_; }
  double weight_ratio() const { return low_ / high_; }   ///< at most 1
  double weight_spread() const { return high_ / low_; }  ///< at least 1

  /// Largest x, y or z of the Bernstein coefficients. `hull`: patch.hull_box(), whose corners hold that of a polynomial
  /// patch, for rounding a difference keeps order.
  double largest(const Box3& hull) const;
  /// The size that errors of tangents are proportional to, over the weight (sample_kernel.inl.h): largest() of a polynomial patch, the
  /// largest |V - o| times the largest weight of a rational one.
  double tangent_size(const Box3& hull) const { return heaviest() * farthest(hull); }
  /// Writes the Bernstein coefficients into the lane that begins here, rounding to T once.
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
  /// The power coefficients, in `memory`.
  std::span<const double> power(Power& memory) const;

 private:
  /// put(value) for each Bernstein coefficient. Equal control points give equal bits: adding +0 turns -0 into +0.
  template <class Put>
  void for_each(Put put) const {
    const auto points = patch_.points();
    const auto weights = patch_.weights();
    if (weights.empty()) {
      const Vec3 shift = Vec3{} - origin_;  // never -0, nor is a sum with it
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

  /// The largest |x|, |y| or |z| of V - o.
  double farthest(const Box3& hull) const {
    return std::max(max_abs(hull.lower - origin_), max_abs(hull.upper - origin_));
  }

  const BezierPatch& patch_;
  const Vec3 origin_;
  double low_ = 1, high_ = 1, scale_ = 1;  // of the weights
};

/// From when on r_u x r_v can't be told from zero in a block's arithmetic.
struct DegenerateNormalThreshold {
  double squared_length = 0;  ///< at or below this |r_u x r_v|^2 the tangents' rounding errors count
  double noise = 0;  ///< largest error of a tangent's component, times the weight; negative: no normal anywhere
};

/// Whether all rows or all columns of the net are the same (for rational patches: both): then r_u or r_v is zero
/// everywhere. `collapsed`: patch.collapsed_edges(); the ends of equal rows are two.
bool is_curve(const BezierPatch& patch, EdgeMask collapsed);

/// Of a curve.
inline constexpr DegenerateNormalThreshold no_normal{.squared_length = std::numeric_limits<double>::infinity(),
                                                     .noise = -1};

/// The error of a tangent where RelativeNet::tangent_size() is 1, `degree` = max(m, n).
template <class T>
constexpr double tangent_noise(int degree) {
  return 6 * degree * double{std::numeric_limits<T>::epsilon()};
}
/// |r_u|, |r_v| at the most where the hull's box has the diameter 1.
constexpr double longest_tangent(int degree, double weight_spread = 1) { return degree * weight_spread; }

/// Squared lengths below, 2^-80 or 2^-600, are out of the range of a float's or a double's squares.
template <class T>
inline constexpr double min_doubt = sizeof(T) == 4 ? 0x1p-80 : 0x1p-600;

/// The doubt of a patch that is no curve, in blocks of T, `degree` = max(m, n). The error of a tangent counts as
/// 6 max(m, n) units of `size`, RelativeNet::tangent_size(), over the weight for rational patches: random nets of all
/// degrees reach 4, tangents that vanish 1.6. And |r_u|, |r_v| <= max(m, n) (largest weight / smallest) diameter
/// (Floater 1992, Derivatives of rational Bezier curves, eq. 10). `diameter`: of the hull's box.
template <class T>
DegenerateNormalThreshold normal_doubt(int degree, double size, double diameter, double lightest,
                                       double weight_spread) {
  const double noise = tangent_noise<T>(degree) * size;
  const double longest = longest_tangent(degree, weight_spread) * diameter;
  const double length = 4 * (noise / lightest) * longest;  // 2 sqrt(3) noise |r_u|
  return {.squared_length = length * length, .noise = noise};
}

/// The same as a kernel reads it: squared length, noise.
template <class T>
std::array<T, 2> doubt_in(const DegenerateNormalThreshold& doubt) {
  const double largest = std::numeric_limits<T>::max();
  return {static_cast<T>(std::clamp(doubt.squared_length, min_doubt<T>, largest)),
          static_cast<T>(std::min(doubt.noise, largest))};
}

}  // namespace tessera::inline abi_0_1
