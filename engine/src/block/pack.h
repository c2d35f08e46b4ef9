#pragma once
// One patch into its lane of a block.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/patch_set.h"

namespace tessera {

/// Components of a coefficient: x, y, z, and w for rational patches.
constexpr int coefficient_components(bool rational) { return rational ? 4 : 3; }

/// Values in one block of these degrees.
constexpr std::size_t block_values(int degree_u, int degree_v, bool rational) {
  return static_cast<std::size_t>((degree_u + 1) * (degree_v + 1) * coefficient_components(rational) * PatchSet::lanes);
}

/// The coefficients of `patch` relative to `origin`, `[i][j][component]`: (V - o, or w (V - o) and w) in the Bernstein
/// basis, or the same in powers of u and v. Weights are divided by a power of two that brings the largest near 1: they
/// fit float whatever their size, and borders shared by patches keep their bits.
void relative_coefficients(const BezierPatch& patch, const Vec3& origin, Representation representation,
                           std::vector<double>& net);

/// Writes a net into one lane of a block, rounding to T once.
template <class T>
void write_lane(std::span<const double> net, T* block, std::uint32_t lane) {
  for (std::size_t k = 0; k < net.size(); ++k) block[k * PatchSet::lanes + lane] = static_cast<T>(net[k]);
}

/// From when on r_u x r_v can't be told from zero in a block's arithmetic.
struct NormalDoubt {
  double squared_length = 0;  ///< at or below this |r_u x r_v|^2 the tangents' rounding errors count
  double noise = 0;  ///< largest error of a tangent's component, times the weight; negative: no normal anywhere
};

/// With 6 max(m, n) units of the largest coefficient for the error of a tangent, over the weight for rational patches:
/// random nets of all degrees reach 4, tangents that vanish 1.6. And |r_u|, |r_v| <= max(m, n) (largest weight /
/// smallest) diameter (Floater 1992, Derivatives of rational Bezier curves, eq. 10). `net` as of relative_coefficients;
/// `unit` is 2^-23 or 2^-52.
NormalDoubt normal_doubt(const BezierPatch& patch, std::span<const double> net, double unit);

/// The same into one lane of a block's two rows. Squared lengths below `lowest`, 2^-80 or 2^-600, are out of the range
/// of a float's or a double's squares.
template <class T>
void write_doubt(const BezierPatch& patch, std::span<const double> net, T* rows, std::uint32_t lane) {
  const NormalDoubt doubt = normal_doubt(patch, net, std::numeric_limits<T>::epsilon());
  const double lowest = sizeof(T) == 4 ? 0x1p-80 : 0x1p-600, largest = std::numeric_limits<T>::max();
  rows[lane] = static_cast<T>(std::clamp(doubt.squared_length, lowest, largest));
  rows[PatchSet::lanes + lane] = static_cast<T>(std::min(doubt.noise, largest));
}

}  // namespace tessera
