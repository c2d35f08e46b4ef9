// How far welding moves vertices.

#include <algorithm>

#include "tess/edges/numbered_borders.h"
#include "tess/edges/side_curve.h"
#include "tess/edges/weld.h"

namespace tessera { inline namespace abi_0_1 {

void measure_displacements(const PatchSet::Impl& set, const VertexCopies& copies, std::span<const double> roundings,
                           FunctionRef<bool(std::size_t patch)> wanted, std::span<double> displacements,
                           bool same_bits_stay) {
  const auto moved = [&](std::uint32_t to, std::uint32_t from, double distance) {
    double& most = displacements[patch_of(to)];
    most = std::max(most, distance + roundings[patch_of(from)]);
  };
  const auto corner = [&](std::uint32_t at) { return corner_of(set.patches[patch_of(at)], at); };
  const auto packed = [&](std::uint32_t border) { return PackedBorder(set, patch_of(border), side_of(border)); };
  for (const VertexCopies::Border& copy : copies.borders) {
    if (!wanted(patch_of(copy.to))) continue;
    const auto is_same = [&] { return equal(packed(copy.to), packed(copy.from), copy.reversed); };
    if (same_bits_stay && is_same()) continue;
    const double distance = distance_bound(curve_of(set, copy.to), curve_of(set, copy.from), copy.reversed);
    if (distance > 0 || !is_same()) moved(copy.to, copy.from, distance);
  }
  for (const VertexCopies::Corner& copy : copies.corners) {
    if (!wanted(patch_of(copy.to))) continue;
    if (same_bits_stay && packed_corner(set, copy.to) == packed_corner(set, copy.from)) continue;
    const double distance = length(corner(copy.to) - corner(copy.from));
    if (distance > 0) moved(copy.to, copy.from, distance);
  }
  for (const VertexCopies::Corner& pole : copies.poles) {
    if (!wanted(patch_of(pole.to))) continue;
    if (same_bits_stay && packed_corner(set, pole.to) == packed_corner(set, pole.from)) continue;
    const SideCurve border = curve_of(set, pole.to);
    for (int k = 0; k <= border.degree(); ++k)
      if (const double distance = length(border.point(k) - corner(pole.from)); distance > 0)
        moved(pole.to, pole.from, distance);
  }
}

}}  // namespace tessera::abi_0_1
