// All patches of a block at once: the same bits as patch after patch, and several times faster for polynomial ones.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "block/pack.h"
#include "block/patch_set_impl.h"
#include "kernel/kernel_table.h"

namespace tessera {
namespace {

using Lanes = std::array<double, PatchSet::lanes>;

Box3 box_of_lane(const kernel::NetBoxes& boxes, std::size_t lane) {
  const auto corner = [lane](const auto& of) { return Vec3{of[0][lane], of[1][lane], of[2][lane]}; };
  return {corner(boxes.lower), corner(boxes.upper)};
}

/// What RelativeNet::largest finds.
Lanes largest_coefficients(const kernel::NetBoxes& boxes, const Vec3& origin) {
  const double from[] = {origin.x, origin.y, origin.z};
  Lanes largest{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t lane = 0; lane < largest.size(); ++lane) {
      const double low = std::abs(boxes.lower[c][lane] - from[c]), high = std::abs(boxes.upper[c][lane] - from[c]);
      const double larger = low > high ? low : high;
      largest[lane] = larger > largest[lane] ? larger : largest[lane];
    }
  return largest;
}

Lanes diagonals(const kernel::NetBoxes& boxes) {
  Lanes result;
  for (std::size_t lane = 0; lane < result.size(); ++lane)
    result[lane] = length({boxes.upper[0][lane] - boxes.lower[0][lane], boxes.upper[1][lane] - boxes.lower[1][lane],
                           boxes.upper[2][lane] - boxes.lower[2][lane]});
  return result;
}

/// A block of polynomial patches, over the Bernstein basis.
struct PolynomialBlock {
  const BlockGroup& group;
  std::size_t block;
  const double* const* nets;  ///< one a lane
  std::size_t numbers;        ///< in each
  Vec3 origin;
  Lanes largest, diagonal;

  template <class T>
  void write(void (*pack_nets)(const kernel::PackJob<T>&), UnsetVector<T>& coefficients, UnsetVector<T>& doubts) const {
    const Vec3 shift = Vec3{} - origin;  // as in RelativeNet
    pack_nets({nets,
               numbers,
               {shift.x, shift.y, shift.z},
               coefficients.data() + group.first_value + (block - group.first_block) * group.block_values});
    T* rows = doubts.data() + 2 * PatchSet::lanes * block;
    const int degree = std::max(group.degree_u, group.degree_v);
    for (std::size_t lane = 0; lane < largest.size(); ++lane) {
      const std::array<T, 2> doubt = doubt_in<T>(normal_doubt<T>(degree, largest[lane], diagonal[lane]));
      rows[lane] = doubt[0];
      rows[PatchSet::lanes + lane] = doubt[1];
    }
  }
};

}  // namespace

std::size_t PatchSet::Impl::pack_block(std::size_t block, const kernel::KernelTable& kernels) {
  const BlockGroup& group = group_of_block(block);
  const std::uint32_t* const indices = &lane_patches[block * lanes];
  std::array<const double*, lanes> nets;
  for (std::size_t lane = 0; lane < lanes; ++lane) nets[lane] = &patches[indices[lane]].points().front().x;
  const std::size_t numbers = 3 * patches[indices[0]].points().size();
  kernel::NetBoxes boxes;
  kernels.bound_nets(nets.data(), numbers, boxes);
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
    collapsed[indices[lane]] = patches[indices[lane]].collapsed_edges();
  if (!group.rational && (kinds.float_bernstein || kinds.double_bernstein)) {
    const double limit = largest_coefficient(kinds.float_bernstein, 1);
    const PolynomialBlock bernstein{
        group, block, nets.data(), numbers, origin, largest_coefficients(boxes, origin), diagonals(boxes)};
    for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
      if (!(bernstein.largest[lane] <= limit)) return lane;
    if (kinds.float_bernstein) bernstein.write(kernels.pack_f32, single.bernstein, single.bernstein_doubt);
    if (kinds.double_bernstein) bernstein.write(kernels.pack_f64, twice.bernstein, twice.bernstein_doubt);
  }
  const bool others = kinds.float_points || kinds.double_points || kinds.float_power || kinds.double_power;
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane) {
    const std::size_t index = indices[lane];
    const bool alone = group.rational || is_curve(patches[index], collapsed[index]);
    if (!alone && !others) continue;
    const Box3 hull = box_of_lane(boxes, lane);
    if ((alone && !pack_bernstein(index, group, hull)) || !pack_points(index, group, hull) ||
        !pack_power(index, group, hull))
      return lane;
  }
  return lanes;
}

}  // namespace tessera
