#pragma once
// Borders and corners of a set's patches by one number, 4 * patch + side, as VertexCopies has them.

#include <array>
#include <cstddef>
#include <cstdint>

#include "block/patch_set_impl.h"
#include "tess/cells/patch_side.h"
#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {

inline Side side_of(std::uint32_t border) { return all_sides[border % 4]; }
inline std::size_t patch_of(std::uint32_t border) { return border / 4; }

/// Returns the corners at the ends of a border, in the direction of the parameter along it.
inline std::array<std::uint32_t, 2> ends_of(std::uint32_t border) {
  constexpr std::uint32_t ends[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  const std::uint32_t patch = border - border % 4;
  return {patch + ends[border % 4][0], patch + ends[border % 4][1]};
}
/// Returns a corner's control point.
inline Vec3 corner_of(const BezierPatch& patch, std::uint32_t corner) {
  const bool end_u = corner % 4 == 1 || corner % 4 == 2, end_v = corner % 4 >= 2;
  return patch.point(end_u ? patch.degree_u() : 0, end_v ? patch.degree_v() : 0);
}

inline SideCurve curve_of(const PatchSet::Impl& set, std::uint32_t border) {
  return {set.patches[patch_of(border)], side_of(border)};
}
/// Returns a corner's vertex as it is packed in float.
inline std::array<float, 3> packed_corner(const PatchSet::Impl& set, std::uint32_t corner) {
  const Vec3 p = corner_of(set.patches[patch_of(corner)], corner) - set.origin + Vec3{};
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

}}  // namespace tessera::abi_0_1
