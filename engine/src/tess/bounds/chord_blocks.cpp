#include "tess/bounds/chord_blocks.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "kernel/table/kernel_table.h"
#include "tess/bounds/rounded_up.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(kernel::max_product_degree == max_product_degree);

/// Bounds of kernels are used for sizes below this: above, the unit would not fit.
constexpr float largest_size = 0x1p126f;

/// Rounds x >= 0 to a float that is not above.
float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return double(nearest) > x ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) - 1) : nearest;
}

constexpr float short_side = kernel::may_be_point;

/// Whether all lanes have bounds of the kernel, and no hints.
bool are_plain(const ChordBlocks::Lanes<float>& hints, std::span<const float, PatchSet::lanes> sizes) {
  int others = 0;
  for (std::size_t lane = 0; lane < hints.size(); ++lane)
    others += int{hints[lane] != 0} | int{!(sizes[lane] >= 0)} | int{!(sizes[lane] < largest_size)};
  return others == 0;
}

bool is_bounded_in_blocks(const BlockGroup& group) {
  return !group.rational || std::max(group.degree_u, group.degree_v) <= kernel::max_rational_degree;
}

/// Products are used for patches of at least so many cells per pair of control points, or of many cells, if they save
/// at least so many cells per pair.
constexpr double min_cells_per_pair = 0.5, many_cells = 150, min_saving = 0.03;

double cells(Rates rates) { return double(rates.u) * rates.v; }

/// Returns the number of pairs of control points of different second derivatives; 0 where products are not used.
double pairs_of_products(const BlockGroup& group) {
  if (std::max(group.degree_u, group.degree_v) > max_product_degree) return 0;
  const double m = group.degree_u, n = group.degree_v, uu = (m - 1) * (n + 1), uv = m * n, vv = (m + 1) * (n - 1);
  return uu * vv + uu * uv + uv * vv;
}

}  // namespace

ChordBlocks::ChordBlocks(const PatchSet::Impl& set, bool by_doubles, double reach)
    : by_doubles_(by_doubles),
      reach_(reach > 0 ? rounded_up(reach) : -std::numeric_limits<float>::infinity()),
      kernels_(&kernel::default_kernels()),
      pieces_(set.lane_counts.size() * block_pieces),
      unit_(set.lane_counts.size() * lanes, 1.0f),
      size_(unit_.size(), -1.0f),
      slack_(unit_.size(), 0.0f),
      source_(unit_.size(), Source::packed),
      short_sides_(set.lane_counts.size()) {
  for (const BlockGroup& group : set.groups)  // bound() leaves some lanes of these groups unset
    if (by_doubles || !is_bounded_in_blocks(group))
      std::fill_n(pieces_.data() + group.first_block * block_pieces, group.block_count * block_pieces, 0.0f);
}

void ChordBlocks::bound(const PatchSet::Impl& set, std::size_t block, std::uint32_t wanted) {
  const BlockGroup& group = set.group_of_block(block);
  float* const pieces = pieces_.data() + block * block_pieces;
  const bool in_block = !by_doubles_ && is_bounded_in_blocks(group);
  const kernel::KernelTable& kernels = *kernels_;
  alignas(cache_line) Lanes<float> hints;
  hints.fill(kernel::may_be_sweep | kernel::may_be_flat | kernel::may_gain);
  if (in_block)
    (group.rational ? kernels.bound_rational_chords : kernels.bound_chords)(
        {.net = set.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
         .degree_u = group.degree_u,
         .degree_v = group.degree_v,
         .pieces = pieces,
         .unit = unit_.data() + block * lanes,
         .size = size_.data() + block * lanes,
         .hints = hints.data(),
         .reach = reach_});
  if (in_block && are_plain(hints, std::span(size_).subspan(block * lanes).first<lanes>())) {
    std::fill_n(source_.data() + block * lanes, lanes, Source::packed);
    std::fill_n(slack_.data() + block * lanes, lanes, 0.0f);
    short_sides_[block] = 0;
    return;
  }
  bool is_hinted = false;
  std::uint32_t short_sides = in_block ? 0 : ~0u;
  for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    if (!in_block && !(wanted >> lane & 1u)) continue;
    if (hints[lane] >= short_side) {
      hints[lane] -= short_side;
      short_sides |= 1u << lane;
    }
    is_hinted |= hints[lane] != 0;
    float& size = size_[block * lanes + lane];
    const bool is_packed = in_block && size >= 0 && size < largest_size;
    source_[block * lanes + lane] = is_packed ? Source::packed : Source::alone;
    slack_[block * lanes + lane] = 0;
    if (is_packed) continue;
    size = -1;
    short_sides |= 1u << lane;
    hints[lane] = kernel::may_be_sweep | kernel::may_be_flat | kernel::may_gain;
    is_hinted = true;
  }
  short_sides_[block] = static_cast<std::uint16_t>(short_sides);
  if (is_hinted) bound_exactly(set, block, hints, in_block ? ~0u : wanted);
}

SecondDerivatives ChordBlocks::piece(std::size_t block, std::size_t lane, std::size_t which,
                                     const Products* products) const {
  const double unit = unit_[block * lanes + lane];
  const float* const d = pieces_.data() + block * block_pieces + which * 3 * lanes + lane;
  SecondDerivatives piece{unit * double(d[0]), unit * double(d[lanes]), unit * double(d[2 * lanes])};
  if (!products || !products->values()) return piece;
  const float* const product = products->values() + which * 3 * lanes + lane;
  piece.uu_vv = unit * unit * double(product[0]);
  piece.uu_uv = unit * unit * double(product[lanes]);
  piece.uv_vv = unit * unit * double(product[2 * lanes]);
  return piece;
}

ChordBound ChordBlocks::chord(std::size_t block, std::size_t lane, const Products* products) const {
  ChordBound::Pieces pieces;
  for (std::size_t k = 0; k < piece_count; ++k) pieces[k] = piece(block, lane, k, products);
  return ChordBound(pieces);
}

double ChordBlocks::distance_of(PatchSegments segments, std::size_t block, std::size_t lane,
                                const Products* products) const {
  if (!segments.are_uniform()) return chord(block, lane, products).distance_of(segments);
  const Rates rates = segments.rates();
  const auto [first, count] = ChordBound::split(rates);
  double most = 0;
  for (int k = first; k < first + count; ++k)
    most = std::max(most, piece(block, lane, static_cast<std::size_t>(k), products).chord(rates));
  return most;
}

void ChordBlocks::Products::find(const ChordBlocks& chords, const PatchSet::Impl& set, std::size_t block) {
  if (is_found_) return;
  is_found_ = true;
  const BlockGroup& group = set.group_of_block(block);
  const float* const unit = chords.unit_.data() + block * lanes;
  values_.fill(std::numeric_limits<float>::infinity());
  if (pairs_of_products(group) == 0) return;
  const kernel::KernelTable& kernels = *chords.kernels_;
  (group.rational ? kernels.bound_rational_products : kernels.bound_products)(
      {.net = set.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
       .degree_u = group.degree_u,
       .degree_v = group.degree_v,
       .pieces = chords.pieces_.data() + block * block_pieces,
       .unit = unit,
       .products = values_.data()});
  for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    const Source source = chords.source_[block * lanes + lane];
    if (source == Source::packed) continue;
    if (source == Source::exact || source == Source::sweep) {
      for (std::size_t k = 0; k < piece_count; ++k)
        for (std::size_t which = 0; which < 3; ++which)
          if (source == Source::exact || which > 0)
            values_[(k * 3 + which) * lanes + lane] =
                source == Source::exact ? std::numeric_limits<float>::infinity() : 0.0f;
      continue;
    }
    const ChordBound chord(set.patches[set.lane_patches[block * lanes + lane]], true);
    const double squared_unit = double(unit[lane]) * double(unit[lane]);
    for (std::size_t k = 0; k < piece_count; ++k) {
      const SecondDerivatives& d = chord.pieces()[k];
      const double bounds[] = {d.uu_vv, d.uu_uv, d.uv_vv};
      for (std::size_t which = 0; which < 3; ++which) {
        const double bound = bounds[which] / squared_unit;
        values_[(k * 3 + which) * lanes + lane] = bound < 0 ? -rounded_down(-bound) : rounded_up(bound);
      }
    }
  }
}

ChordBlocks::Choice ChordBlocks::search(std::size_t block, std::size_t count, const Lanes<double>& distance, int most,
                                        const Products* products) const {
  alignas(cache_line) Lanes<float> wanted, chord;
  Lanes<std::int32_t> rate_u, rate_v;
  for (std::size_t lane = 0; lane < lanes; ++lane)
    wanted[lane] = rounded_down(std::clamp(distance[lane] / double(unit_[block * lanes + lane]), 0.0, 0x1p60));
  kernels_->find_rates({.pieces = pieces_.data() + block * block_pieces,
                        .distance = wanted.data(),
                        .max_rate = most,
                        .rate_u = rate_u.data(),
                        .rate_v = rate_v.data(),
                        .chord = chord.data(),
                        .products = products ? products->values() : nullptr});
  Choice choice;
  for (std::size_t lane = 0; lane < count; ++lane) {
    choice.rates[lane] = {rate_u[lane], rate_v[lane]};
    choice.distance[lane] = double(unit_[block * lanes + lane]) * double(chord[lane]);
    if (rate_u[lane] > 0 || !(distance[lane] > 0)) continue;
    const ChordBound exact = this->chord(block, lane, products);
    const auto found = exact.cheapest(distance[lane], most);
    choice.rates[lane] = found ? *found : Rates{0, 0};
    if (found) choice.distance[lane] = exact.distance(*found);
  }
  return choice;
}

std::uint32_t ChordBlocks::gaining_by_products(const PatchSet::Impl& set, std::size_t block, const Choice& choice,
                                               std::uint32_t asked) const {
  const BlockGroup& group = set.group_of_block(block);
  alignas(cache_line) Lanes<float> share;
  // For rational patches this would take as long as the products themselves: about a tenth is saved.
  share.fill(0.9f);
  if (!group.rational)
    kernels_->share_of_products(
        {.net = set.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values,
         .degree_u = group.degree_u,
         .degree_v = group.degree_v,
         .pieces = pieces_.data() + block * block_pieces,
         .unit = unit_.data() + block * lanes,
         .share = share.data()});
  // Products of rational patches take 3.5 times as long as those of polynomial ones, and their cells up to twice as
  // long.
  const double worth = group.rational ? 0.5 : 1, least = min_saving * pairs_of_products(group);
  std::uint32_t gaining = 0;
  for (std::uint32_t bits = asked; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    const double saved = worth * std::max(0.0, 1 - double(share[lane])) * cells(choice.rates[lane]);
    if (saved >= least) gaining |= 1u << lane;
  }
  return gaining;
}

ChordBlocks::Choice ChordBlocks::cheapest(const PatchSet::Impl& set, std::size_t block, std::size_t count,
                                          const Lanes<double>& distance, int most, Products& products) const {
  Choice choice = search(block, count, distance, most, nullptr);
  const double pairs = pairs_of_products(set.group_of_block(block));
  if (pairs == 0) return choice;
  // The time of products goes by the pairs, that of a mesh by its cells: products pay where there are many cells. Each
  // patch decides for itself, so that its rates do not depend on the others of its block.
  std::uint32_t asked = 0;
  for (std::size_t lane = 0; lane < count; ++lane)
    if (source_[block * lanes + lane] != Source::exact &&
        cells(choice.rates[lane]) >= std::min(min_cells_per_pair * pairs, many_cells))
      asked |= 1u << lane;
  if (asked != 0) choice.sharpened = gaining_by_products(set, block, choice, asked);
  if (choice.sharpened == 0) return choice;
  products.find(*this, set, block);
  const Choice sharper = search(block, count, distance, most, &products);
  for (std::uint32_t bits = choice.sharpened; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    choice.rates[lane] = sharper.rates[lane];
    choice.distance[lane] = sharper.distance[lane];
  }
  return choice;
}

}}  // namespace tessera::abi_0_1
