#include "tess/edges/short_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tess/edges/shared_edges.h"
#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using Lanes = std::array<float, PatchSet::lanes>;

}  // namespace

// Loops over lanes are plain enough to be vectorized.
float shortest_side(const PatchSet::Impl& set, std::size_t block) {
  const BlockGroup& group = set.group_of_block(block);
  const float* const net =
      set.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values;
  const std::ptrdiff_t end_u = BorderPlaces(group, Side::u1).first, end_v = BorderPlaces(group, Side::v1).first;
  const std::array<std::ptrdiff_t, 4> places = {0, end_u, end_u + end_v, end_v};
  std::array<std::array<Lanes, 3>, 4> corners;
  for (std::size_t corner = 0; corner < 4; ++corner)
    for (std::size_t c = 0; c < 3; ++c) {
      const float *const from = net + places[corner], *const values = from + c * PatchSet::lanes;
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane) corners[corner][c][lane] = values[lane];
      if (!group.rational) continue;
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
        corners[corner][c][lane] /= from[3 * PatchSet::lanes + lane];
    }
  Lanes shortest;
  shortest.fill(std::numeric_limits<float>::infinity());
  for (std::size_t side = 0; side < 4; ++side) {
    Lanes length{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane) {
        const float way = std::abs(corners[side][c][lane] - corners[(side + 1) % 4][c][lane]);
        length[lane] = way > length[lane] ? way : length[lane];
      }
    for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
      shortest[lane] = length[lane] < shortest[lane] ? length[lane] : shortest[lane];
  }
  return *std::min_element(shortest.begin(), shortest.end());
}

bool is_thin(const BezierPatch& patch, Side side, double reach) {
  const bool along_u = runs_along_u(side);
  for (int i = 0; i <= patch.degree_u(); ++i)
    for (int j = 0; j <= patch.degree_v(); ++j)
      if (!(length(patch.point(i, j) - patch.point(along_u ? i : 0, along_u ? 0 : j)) <= reach)) return false;
  return true;
}

bool is_needle(const BezierPatch& patch, Side side, double reach) {
  const SideCurve along(patch, side);
  const Vec3 way = along.last() - along.first();
  const double squared = dot(way, way);
  return std::ranges::all_of(patch.points(), [&](const Vec3& p) {
    const double share = squared > 0 ? std::clamp(dot(p - along.first(), way) / squared, 0.0, 1.0) : 0;
    return length(p - (along.first() + share * way)) <= reach;
  });
}

}}  // namespace tessera::abi_0_1
