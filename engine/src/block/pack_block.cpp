// Packs all patches of a block at once: the same bits as patch after patch, several times faster for polynomial ones.

#include <algorithm>
#include <array>

#include "block/pack.h"
#include "block/patch_set_impl.h"
#include "kernel/table/kernel_table.h"
#include "surface/net/patch_pieces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Box3 box_of_lane(const kernel::NetBoxes& boxes, std::size_t lane) {
  const auto corner = [lane](const auto& of) { return Vec3{of[0][lane], of[1][lane], of[2][lane]}; };
  return {corner(boxes.lower), corner(boxes.upper)};
}

}  // namespace

/// The kernel's job that packs one kind of a block's Bernstein coefficients: it writes what RelativeNet and
/// normal_threshold() give patch by patch. `copies`: where the nets are copied to unchanged, or null.
template <class T>
kernel::PackJob<T> PatchSet::Impl::pack_job(const BlockGroup& group, std::size_t block, const double* const* nets,
                                            double* const* copies, Coefficients<T>& to) const {
  const int degree = std::max(group.degree_u, group.degree_v);
  return {.nets = nets,
          .degree_u = group.degree_u,
          .degree_v = group.degree_v,
          .origin = {origin.x, origin.y, origin.z},
          .out = to.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
          .copies = copies,
          .thresholds = to.bernstein_threshold.data() + 2 * lanes * block,
          .noise = tangent_noise<T>(degree),
          .longest = longest_tangent(degree),
          .min_threshold = min_threshold<T>};
}

std::size_t PatchSet::Impl::pack_polynomials(std::size_t block, const kernel::KernelTable& kernels,
                                             const Vec3* const* edits, kernel::NetBoxes& boxes) {
  const BlockGroup& group = group_of_block(block);
  const std::uint32_t* const indices = &lane_patches[block * lanes];
  std::array<const double*, lanes> nets;
  std::array<double*, lanes> owned;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const BezierPatch& patch = patches[indices[lane]];
    nets[lane] = edits ? &edits[lane]->x : &patch.points().front().x;
    owned[lane] = edits ? &PatchPieces::sole_points(patch)->x : nullptr;
  }
  double* const* copies = edits ? owned.data() : nullptr;
  kernel::PackedNets found;
  if (kinds.float_bernstein) {
    kernels.pack_f32(pack_job(group, block, nets.data(), copies, f32), found);
    copies = nullptr;
  }
  if (kinds.double_bernstein) kernels.pack_f64(pack_job(group, block, nets.data(), copies, f64), found);
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
    collapsed[indices[lane]] = found.edges_may_be_points ? patches[indices[lane]].collapsed_sides() : SideMask{};
  boxes = found.boxes;
  const double limit = largest_coefficient(kinds.float_bernstein, 1);
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
    if (!(found.largest[lane] <= limit)) return lane;
  return lanes;
}

void PatchSet::Impl::bound_block(std::size_t block, const kernel::KernelTable& kernels, kernel::NetBoxes& boxes) {
  const std::uint32_t* const indices = &lane_patches[block * lanes];
  std::array<const double*, lanes> nets;
  for (std::size_t lane = 0; lane < lanes; ++lane) nets[lane] = &patches[indices[lane]].points().front().x;
  kernels.bound_nets(nets.data(), 3 * patches[indices[0]].points().size(), boxes);
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
    collapsed[indices[lane]] = patches[indices[lane]].collapsed_sides();
}

std::size_t PatchSet::Impl::pack_block(std::size_t block, const kernel::KernelTable& kernels,
                                       const Vec3* const* edits) {
  const BlockGroup& group = group_of_block(block);
  const std::uint32_t* const indices = &lane_patches[block * lanes];
  kernel::NetBoxes boxes;
  if (!group.rational && (kinds.float_bernstein || kinds.double_bernstein)) {
    const std::size_t fitting = pack_polynomials(block, kernels, edits, boxes);
    if (fitting < lanes) return fitting;
  } else {
    if (edits)
      for (std::size_t lane = 0; lane < lane_counts[block]; ++lane)
        PatchPieces::overwrite(patches[indices[lane]], edits[lane]);
    bound_block(block, kernels, boxes);
  }
  const bool others = kinds.float_points || kinds.double_points || kinds.float_power || kinds.double_power;
  for (std::size_t lane = 0; lane < lane_counts[block]; ++lane) {
    const std::size_t index = indices[lane];
    const bool alone = group.rational || (collapsed[index].any() && is_curve(patches[index], collapsed[index]));
    if (!alone && !others) continue;
    const Box3 hull = box_of_lane(boxes, lane);
    if ((alone && !pack_bernstein(index, group, hull)) || !pack_points(index, group, hull) ||
        !pack_power(index, group, hull))
      return lane;
  }
  return lanes;
}

}}  // namespace tessera::abi_0_1
