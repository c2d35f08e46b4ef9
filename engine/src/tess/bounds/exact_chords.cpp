// Finds bounds of a block's patches in double: by exact numerators, for scaled sweeps and for flat quadrilaterals.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "block/pack.h"
#include "kernel/table/kernel_table.h"
#include "tess/bounds/chord_blocks.h"
#include "tess/bounds/flat_quad.h"
#include "tess/bounds/rounded_up.h"

namespace tessera { inline namespace abi_0_1 {

struct ChordBlocks::Exact {
  /// The lanes whose bounds are found, which the kernel sees side by side.
  std::uint32_t wanted = 0;
  alignas(cache_line) Lanes<double> deviations;
  alignas(cache_line) std::array<double, piece_count * 3 * lanes> pieces;

  std::size_t place(std::size_t lane) const {
    return static_cast<std::size_t>(std::popcount(wanted & ((1u << lane) - 1)));
  }
  double bound(std::size_t piece, std::size_t kind, std::size_t lane) const {
    return pieces[(piece * 3 + kind) * lanes + place(lane)];
  }
  double deviation(std::size_t lane) const { return deviations[place(lane)]; }
  bool is_sweep(std::size_t lane) const { return deviation(lane) < std::numeric_limits<double>::infinity(); }
  bool is_finite(std::size_t lane) const {
    double sum = 0;
    for (std::size_t kind = 0; kind < 3; ++kind) sum += bound(0, kind, lane);
    return std::isfinite(sum);
  }
};

namespace {

using BlockNet = std::array<double, (max_degree + 1) * (max_degree + 1) * 4 * PatchSet::lanes>;

/// Packs the patch into its lane of a net, laid out as in ExactChordJob.
void pack(const BezierPatch& patch, double* lane) {
  const Vec3 centre = patch.hull_box().centre();
  if (patch.is_rational()) {
    RelativeNet(patch, centre).write(lane);
    return;
  }
  for (const Vec3& point : patch.points()) {  // without weights, see ExactChordJob::rational
    const Vec3 p = point - centre;
    lane[0] = p.x, lane[PatchSet::lanes] = p.y, lane[2 * PatchSet::lanes] = p.z;
    lane += 4 * PatchSet::lanes;
  }
}

/// Exact numerators replace a homogeneous bound only where they reduce the cells to this share: the homogeneous bound
/// can save as much by products of second derivatives.
constexpr double min_gain = 0.8;
/// Estimates the cells that a patch takes at a tolerance of 2^-10 of its size, times a factor of the patch's.
/// `bound(kind)` is that of uu, uv or vv.
template <class Bound>
double cells(double size, const Bound& bound) {
  const double one = std::sqrt(0x1p-7 * size);
  return (std::sqrt(bound(0)) + one) * (std::sqrt(bound(2)) + one) + bound(1);
}

/// Returns the lanes that have a hint, one bit each.
std::uint32_t lanes_with(kernel::ChordHint hint, const ChordBlocks::Lanes<float>& hints) {
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < hints.size(); ++lane)
    bits |= std::uint32_t{(static_cast<unsigned>(hints[lane]) & hint) != 0} << lane;
  return bits;
}

}  // namespace

void ChordBlocks::bound_alone(const BezierPatch& patch, std::size_t block, std::size_t lane) {
  const ChordBound chord(patch);
  double most = 0;
  for (const SecondDerivatives& d : chord.pieces()) most = std::max({most, d.uu, d.uv, d.vv});
  set_unit(block, lane, most);
  store(block, lane, [&](std::size_t k, std::size_t kind) {
    const SecondDerivatives& d = chord.pieces()[k];
    return kind == 0 ? d.uu : kind == 1 ? d.uv : d.vv;
  });
}

void ChordBlocks::set_unit(std::size_t block, std::size_t lane, double most) {
  unit_[block * lanes + lane] =
      std::isfinite(most) && most > 0 ? std::ldexp(1.0f, std::clamp(std::ilogb(most), -120, 120)) : 1.0f;
}

template <class Bound>
void ChordBlocks::store(std::size_t block, std::size_t lane, const Bound& bound) {
  const double unit = unit_[block * lanes + lane];
  for (std::size_t k = 0; k < piece_count; ++k)
    for (std::size_t kind = 0; kind < 3; ++kind)
      pieces_[block * block_pieces + (k * 3 + kind) * lanes + lane] = rounded_up(bound(k, kind) / unit);
}

double ChordBlocks::homogeneous_cells(const BezierPatch& patch, std::size_t block, std::size_t lane) const {
  return cells(patch.hull_box().diagonal(), [&](std::size_t kind) {
    double most = 0;
    for (std::size_t quarter = 5; quarter < 9; ++quarter) {
      const SecondDerivatives d = piece(block, lane, quarter);
      most = std::max(most, kind == 0 ? d.uu : kind == 1 ? d.uv : d.vv);
    }
    return most;
  });
}

void ChordBlocks::take_exact(const BezierPatch& patch, const Exact& exact, bool may_gain, std::size_t block,
                             std::size_t lane) {
  Source& source = source_[block * lanes + lane];
  const bool is_finite = exact.is_finite(lane), is_sweep = exact.is_sweep(lane) && is_finite,
             is_unknown = is_sweep && source == Source::alone;
  if (source == Source::alone && !is_sweep) bound_alone(patch, block, lane);
  if (!is_finite || !(is_sweep || may_gain)) return;
  const double wanted =
      cells(patch.hull_box().diagonal(), [&](std::size_t kind) { return exact.bound(0, kind, lane); });
  if (!is_unknown && !(wanted < (is_sweep ? 1 : min_gain) * homogeneous_cells(patch, block, lane))) return;
  if (source == Source::alone) {
    double most = 0;
    for (std::size_t kind = 0; kind < 3; ++kind) most = std::max(most, exact.bound(0, kind, lane));
    set_unit(block, lane, most);
  }
  source = Source::exact;
  if (is_sweep) slack_[block * lanes + lane] = rounded_up(2 * exact.deviation(lane));
  store(block, lane, [&](std::size_t k, std::size_t kind) { return exact.bound(k, kind, lane); });
}

void ChordBlocks::find_exact(const PatchSet::Impl& set, std::size_t block, bool any_patch, Exact& exact) {
  const BlockGroup& group = set.group_of_block(block);
  BlockNet net;
  const auto pack_lane = [&](std::size_t lane, std::size_t place) {
    pack(set.patches[set.lane_patches[block * lanes + lane]], net.data() + place);
  };
  std::size_t count = 0;
  for (std::uint32_t bits = exact.wanted; bits != 0; bits &= bits - 1)
    pack_lane(static_cast<std::size_t>(std::countr_zero(bits)), count++);
  constexpr std::size_t widest = 8;  // the most lanes of a vector of doubles
  const auto first = static_cast<std::size_t>(std::countr_zero(exact.wanted));
  for (std::size_t place = count; place % widest != 0; ++place) pack_lane(first, place);
  kernel::default_kernels().bound_exact_chords({.net = net.data(),
                                                .degree_u = group.degree_u,
                                                .degree_v = group.degree_v,
                                                .rational = group.rational,
                                                .lanes = static_cast<int>(count),
                                                .any_patch = any_patch,
                                                .deviation = exact.deviations.data(),
                                                .pieces = group.rational ? exact.pieces.data() : nullptr});
}

void ChordBlocks::take_sweep(const Exact& exact, std::size_t block, std::size_t lane) {
  const std::size_t at = block * lanes + lane;
  if (!exact.is_sweep(lane) || source_[at] != Source::packed) return;
  source_[at] = Source::sweep;
  slack_[at] = rounded_up(2 * exact.deviation(lane));
  for (std::size_t k = 0; k < piece_count; ++k) pieces_[block * block_pieces + (k * 3 + 1) * lanes + lane] = 0;
}

void ChordBlocks::take_flat(const BezierPatch& patch, std::size_t block, std::size_t lane) {
  const std::optional<double> deviation = flat_quad_deviation(patch);
  if (!deviation) return;
  source_[block * lanes + lane] = Source::exact;
  slack_[block * lanes + lane] = rounded_up(2 * *deviation);
  store(block, lane, [](std::size_t, std::size_t) { return 0.0; });
}

void ChordBlocks::bound_exactly(const PatchSet::Impl& set, std::size_t block, const Lanes<float>& hints,
                                std::uint32_t wanted) {
  const bool rational = set.group_of_block(block).rational;
  const std::size_t count = set.lane_counts[block];
  const std::uint32_t present = wanted & ((1u << count) - 1);
  const auto hinted = [&](kernel::ChordHint hint) { return lanes_with(hint, hints) & present; };
  const auto for_lanes = [&](std::uint32_t bits, const auto& visit) {
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      visit(lane, set.patches[set.lane_patches[block * lanes + lane]]);
    }
  };
  // Numerators take a microsecond or more per lane: worth it for patches that may gain. Each patch decides for itself,
  // so that its bounds do not depend on the others of its block. Lanes with Source::alone have every hint, so
  // take_exact() bounds the rational ones among them.
  const std::uint32_t gaining = rational ? hinted(kernel::may_gain) : 0;
  Exact exact;
  exact.wanted = hinted(kernel::may_be_sweep) | gaining;
  if (exact.wanted != 0) find_exact(set, block, gaining != 0, exact);
  for_lanes(exact.wanted, [&](std::size_t lane, const BezierPatch& patch) {
    rational ? take_exact(patch, exact, bool(gaining >> lane & 1u), block, lane) : take_sweep(exact, block, lane);
  });
  for_lanes(rational ? 0 : present, [&](std::size_t lane, const BezierPatch& patch) {
    if (source(block, lane) == Source::alone) bound_alone(patch, block, lane);
  });
  for_lanes(hinted(kernel::may_be_flat),
            [&](std::size_t lane, const BezierPatch& patch) { take_flat(patch, block, lane); });
}

}}  // namespace tessera::abi_0_1
