// The rates of borders: one for all patches that meet there.

#include <algorithm>
#include <array>

#include "tess/certified_plan.h"

namespace tessera {
namespace {

/// Of a patch with higher rates, an odd one in the place of the next even one saves too little to look for.
constexpr int most_to_straddle = 2;

}  // namespace

bool CertifiedPlanner::may_straddle(std::size_t patch, Side side, const std::array<int, 4>& borders, double tolerance,
                                    CertifiedPlan& plan) const {
  // Where no inner points lie between them, the opposite border's segment may do it as well.
  const auto s = static_cast<std::size_t>(side);
  const int opposite = borders[(s + 2) % 4], rate = opposite % 2 == 1 ? std::min(borders[s], opposite) : borders[s];
  const auto [piece, rates] = ChordBound::straddling(plan.rates_[patch], edge_of(side), rate);
  const PatchSet::Slot slot = set_->slots[patch];
  const double given = roundings_[patch] + fit_error_,
               distance = chords_.piece(slot.block, slot.lane, piece).chord(rates) + given;
  if (!(distance <= tolerance)) return false;
  plan.bounds_[patch] = std::max(plan.bounds_[patch], rounded_up(distance));
  return true;
}

void CertifiedPlanner::divide(double tolerance, CertifiedPlan& plan) const {
  struct Need {
    std::uint16_t most = 1;     ///< of the rates of its patches
    std::uint16_t is_even = 0;  ///< the edge's must be, as one of them counts on no triangle straddling the middle
  };
  const std::span<const PatchShape> shapes = divided_shapes();
  const std::span<const Rates> rates = plan.rates_;
  const auto rate_along = [](Rates own, Side side) { return runs_along_u(side) ? own.u : own.v; };
  // Angles and pixels are known of halves alone.
  const bool by_distance = !options_.angle && !options_.camera;
  const auto is_coarse = [&](std::size_t k) {
    return by_distance && std::max(rates[k].u, rates[k].v) <= most_to_straddle;
  };
  const auto always_straddles = [&](std::size_t k) { return !plan.straddles_.empty() && plan.straddles_[k]; };
  std::vector<Need> needs(edges_.count());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (shapes[k].is_curve) continue;
    const auto never = static_cast<std::uint16_t>(!is_coarse(k) && !always_straddles(k));
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      if (edge == SharedEdges::none) continue;
      const auto rate = static_cast<std::uint16_t>(rate_along(rates[k], side));
      needs[edge].most = std::max(needs[edge].most, rate);
      needs[edge].is_even |= static_cast<std::uint16_t>(~rate & never);
    }
  }
  const auto border_of = [&](std::size_t k, Side side) -> int {
    const std::uint32_t edge = edges_.edge(k, side);
    if (edge == SharedEdges::none) return rate_along(rates[k], side);
    const Need need = needs[edge];
    return need.most + (need.most & need.is_even);
  };
  const auto borders_of = [&](std::size_t k) {
    return std::array{border_of(k, Side::v0), border_of(k, Side::u1), border_of(k, Side::v1), border_of(k, Side::u0)};
  };
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (!is_coarse(k) || shapes[k].is_curve || always_straddles(k)) continue;
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      if (rate_along(rates[k], side) % 2 == 1 || edge == SharedEdges::none) continue;
      if (needs[edge].most % 2 == 1 && !needs[edge].is_even && !may_straddle(k, side, borders_of(k), tolerance, plan))
        needs[edge].is_even = 1;
    }
  }
  plan.divisions_.reserve(rates.size());
  for (std::size_t k = 0; k < rates.size(); ++k) plan.divisions_.emplace_back().set(shapes[k], rates[k], borders_of(k));
}

}  // namespace tessera
