#include "ray/leaf/leaf_nets.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "parallel/parallel_for.h"
#include "ray/leaf/leaf_cuts.h"
#include "ray/leaf/local_leaf.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t patches_per_task = 64;
/// The most halvings of a direction that write_net() makes; the two passes of restrict_net() round as much as these.
constexpr int halvings_of_restriction = 3;

/// Returns the box of the control points.
Box3 box_of(const Leaf& leaf, const double* net) {
  const std::size_t size = static_cast<std::size_t>(leaf.size());
  Box3 box;
  for (std::size_t k = 0; k < size; ++k) {
    const double w = leaf.rational ? net[3 * size + k] : 1;
    box.extend(Vec3{net[k] / w, net[size + k] / w, net[2 * size + k] / w});
  }
  return box;
}

/// Returns the limit of linear steps. The second derivatives of a rational patch, and with them the error of a linear
/// step, grow with the square of the ratio of its weights.
float linear_step_of(const BezierPatch& patch) {
  if (!patch.is_rational()) return static_cast<float>(linear_step);
  const auto [lightest, heaviest] = std::minmax_element(patch.weights().begin(), patch.weights().end());
  return static_cast<float>(linear_step * (*lightest / *heaviest));
}

}  // namespace

/// Sets the places of a patch's pieces, the first of which is leaf `first`.
void LeafNets::set_leaves(const BezierPatch& patch, std::uint32_t index, const Cuts& cuts, std::size_t first) {
  Leaf leaf;
  leaf.patch = index;
  leaf.degree_u = static_cast<std::uint8_t>(patch.degree_u());
  leaf.degree_v = static_cast<std::uint8_t>(patch.degree_v());
  leaf.rational = patch.is_rational();
  leaf.halvings_u = static_cast<std::uint8_t>(cuts.u), leaf.halvings_v = static_cast<std::uint8_t>(cuts.v);
  leaf.du = std::ldexp(1.0, -cuts.u), leaf.dv = std::ldexp(1.0, -cuts.v);
  for (std::size_t piece = 0; piece < cuts.pieces(); ++piece) {
    leaf.u0 = static_cast<double>(piece >> cuts.v) * leaf.du;
    leaf.v0 = static_cast<double>(piece & ((std::size_t{1} << cuts.v) - 1)) * leaf.dv;
    leaves_[first + piece] = leaf;
  }
}

/// Chooses the cuts, and makes room for the pieces.
Status LeafNets::plan(const SetView& set, const SceneFrame& frame, const Flatness& flatness,
                      const Execution& execution) {
  frame_ = frame;
  std::vector<Cuts> cuts(set.patch_count());
  const Status status = parallel_for(cuts.size(), patches_per_task, execution, [&](std::size_t begin, std::size_t end) {
    LeafCutter cutter(frame_);
    for (std::size_t k = begin; k < end; ++k) {
      cutter.start(set.patch(k));
      cuts[k] = cutter.flatten(flatness.halvings, flatness.max_bend);
    }
  });
  if (!status.ok()) return status;
  std::size_t leaves = 0;
  bool rational = false;
  largest_ = 0;
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const BezierPatch& patch = set.patch(k);
    leaves += cuts[k].pieces();
    rational |= patch.is_rational();
    largest_ = std::max(largest_, patch.points().size() * (patch.is_rational() ? 4 : 3));
  }
  leaves_.resize(leaves);
  leaves = 0;
  for (std::size_t k = 0; k < cuts.size(); leaves += cuts[k++].pieces())
    set_leaves(set.patch(k), static_cast<std::uint32_t>(k), cuts[k], leaves);
  local_bytes_ = kernel::ray_leaf_bytes(rational);
  return {};
}

/// Returns the first piece of a patch.
std::size_t LeafNets::first_leaf(std::uint32_t patch) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(leaves_, patch, {}, &Leaf::patch) - leaves_.begin());
}

void LeafNets::cut(const BezierPatch& patch, std::uint32_t index, LeafCutter& cutter) {
  const std::size_t first = first_leaf(index);
  const NetShape<0, 0> shape{patch.degree_u(), patch.degree_v()};
  const Cuts cuts{leaves_[first].halvings_u, leaves_[first].halvings_v};
  cutter.start(patch);
  cutter.cut(cuts);
  const float linear = linear_step_of(patch);
  for (std::size_t piece = 0; piece < cuts.pieces(); ++piece) {
    const std::size_t place = first + piece;
    Leaf& leaf = leaves_[place];
    leaf.points = patch.points().data();
    leaf.linear = linear;
    const double* const net = leaf.is_shrunk
                                  ? cutter.part_of(piece, {leaf.u0, leaf.u0 + leaf.du, leaf.v0, leaf.v0 + leaf.dv})
                                  : cutter.net(piece);
    boxes_[place] = box_of(leaf, net);
    make_local_leaf(shape, leaf.rational, net, *new (local_.data() + place * local_bytes_) kernel::RayLeaf);
  }
}

int Leaf::halvings() const {
  if (is_shrunk) return max_halvings;
  return std::min<int>(halvings_u, halvings_of_restriction) + std::min<int>(halvings_v, halvings_of_restriction);
}

void LeafNets::write_net(const SetView& set, const Leaf& leaf, double* net, double* other) const {
  const NetShape<0, 0> shape{leaf.degree_u, leaf.degree_v};
  write_patch(set.patch(leaf.patch), frame_, net);
  if (leaf.is_shrunk) {
    restrict_net(shape, leaf.components(), net, true, leaf.u0, leaf.u0 + leaf.du);
    restrict_net(shape, leaf.components(), net, false, leaf.v0, leaf.v0 + leaf.dv);
    return;
  }
  const auto take = [&](bool along_u, int halvings, double start, double width) {
    if (halvings > halvings_of_restriction) {
      restrict_net(shape, leaf.components(), net, along_u, start, start + width);
      return;
    }
    const auto piece = static_cast<unsigned>(start / width);
    for (int k = halvings; k-- > 0;) {
      const bool upper = piece >> k & 1;
      halve(shape, leaf.components(), net, along_u, upper ? other : net, upper ? net : other);
    }
  };
  take(true, leaf.halvings_u, leaf.u0, leaf.du);
  take(false, leaf.halvings_v, leaf.v0, leaf.dv);
}

Status LeafNets::make(const SetView& set, const Execution& execution) {
  boxes_.resize(leaves_.size());
  local_.resize(leaves_.size() * local_bytes_);
  return parallel_for(set.patch_count(), patches_per_task, execution, [&](std::size_t begin, std::size_t end) {
    LeafCutter cutter(frame_);
    for (std::size_t k = begin; k < end; ++k) cut(set.patch(k), static_cast<std::uint32_t>(k), cutter);
  });
}

Status LeafNets::update(const SetView& set, std::span<const std::uint32_t> patches, const Execution& execution) {
  return parallel_for(patches.size(), patches_per_task, execution, [&](std::size_t begin, std::size_t end) {
    LeafCutter cutter(frame_);
    for (const std::uint32_t patch : patches.subspan(begin, end - begin)) cut(set.patch(patch), patch, cutter);
  });
}

}}  // namespace tessera::abi_0_1
