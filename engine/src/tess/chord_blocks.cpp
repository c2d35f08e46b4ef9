#include "tess/chord_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/kernel_table.h"
#include "tess/rounded_up.h"

namespace tessera {
namespace {

/// Kernels are given sizes below this: above, the unit would not fit.
constexpr float largest_size = 0x1p126f;

/// x >= 0 to a float that is not above.
float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return double(nearest) > x ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) - 1) : nearest;
}

}  // namespace

ChordBlocks::ChordBlocks(const PatchSet::Impl& set)
    : pieces_(set.lane_counts.size() * block_pieces), unit_(set.lane_counts.size() * lanes, 1.0f), size_(unit_.size(), -1.0f) {}

void ChordBlocks::bound(const PatchSet::Impl& set, std::size_t block, std::uint32_t wanted) {
  const BlockGroup& group = set.group_of_block(block);
  float* const pieces = pieces_.data() + block * block_pieces;
  if (!group.rational) {
    kernel::default_kernels().bound_chords(
        {.net = set.single.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
         .degree_u = group.degree_u,
         .degree_v = group.degree_v,
         .pieces = pieces,
         .unit = unit_.data() + block * lanes,
         .size = size_.data() + block * lanes});
  }
  for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    float &size = size_[block * lanes + lane], &unit = unit_[block * lanes + lane];
    if (!group.rational && size < largest_size) continue;
    if (group.rational && !(wanted >> lane & 1u)) continue;
    size = -1;
    const ChordBound chord(set.patches[set.lane_patches[block * lanes + lane]]);
    // In the unit of the largest, so that float holds squares of the others.
    double most = 0;
    for (const SecondDerivatives& d : chord.pieces()) most = std::max({most, d.uu, d.uv, d.vv});
    unit = std::isfinite(most) && most > 0 ? std::ldexp(1.0f, std::clamp(std::ilogb(most), -120, 120)) : 1.0f;
    for (std::size_t k = 0; k < piece_count; ++k) {
      const SecondDerivatives& d = chord.pieces()[k];
      const double bounds[] = {d.uu, d.uv, d.vv};
      for (std::size_t kind = 0; kind < 3; ++kind)
        pieces[(k * 3 + kind) * lanes + lane] = rounded_up(bounds[kind] / double(unit));
    }
  }
}

ChordBound ChordBlocks::chord(std::size_t block, std::size_t lane) const {
  ChordBound::Pieces pieces;
  const double unit = unit_[block * lanes + lane];
  for (std::size_t k = 0; k < piece_count; ++k) {
    const float* d = pieces_.data() + block * block_pieces + k * 3 * lanes + lane;
    pieces[k] = {unit * double(d[0]), unit * double(d[lanes]), unit * double(d[2 * lanes])};
  }
  return ChordBound(pieces);
}

ChordBlocks::Choice ChordBlocks::cheapest(std::size_t block, std::size_t count, const Lanes<double>& distance, int most) const {
  alignas(cache_line) Lanes<float> wanted, chord;
  Lanes<std::int32_t> rate_u, rate_v;
  for (std::size_t lane = 0; lane < lanes; ++lane)
    wanted[lane] = rounded_down(std::clamp(distance[lane] / double(unit_[block * lanes + lane]), 0.0, 0x1p60));
  kernel::default_kernels().find_rates({.pieces = pieces_.data() + block * block_pieces,
                                        .distance = wanted.data(),
                                        .most_rate = most,
                                        .rate_u = rate_u.data(),
                                        .rate_v = rate_v.data(),
                                        .chord = chord.data()});
  Choice choice;
  for (std::size_t lane = 0; lane < count; ++lane) {
    choice.rates[lane] = {rate_u[lane], rate_v[lane]};
    choice.distance[lane] = double(unit_[block * lanes + lane]) * double(chord[lane]);
    if (rate_u[lane] > 0 || !(distance[lane] > 0)) continue;
    const ChordBound exact = this->chord(block, lane);
    const auto found = exact.cheapest(distance[lane], most);
    choice.rates[lane] = found ? *found : Rates{0, 0};
    if (found) choice.distance[lane] = exact.distance(*found);
  }
  return choice;
}

}  // namespace tessera
