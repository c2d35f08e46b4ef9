#pragma once
// One patch into its lane of a block.

#include <cstddef>
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
/// basis, or the same in powers of u and v. Weights are divided by a power of two that brings the largest near 1: they fit
/// float whatever their size, and borders shared by patches keep their bits.
void relative_coefficients(const BezierPatch& patch, const Vec3& origin, Representation representation,
                           std::vector<double>& net);

/// Writes a net into one lane of a block, rounding to T once.
template <class T>
void write_lane(std::span<const double> net, T* block, std::uint32_t lane) {
  for (std::size_t k = 0; k < net.size(); ++k) block[k * PatchSet::lanes + lane] = static_cast<T>(net[k]);
}

}  // namespace tessera
