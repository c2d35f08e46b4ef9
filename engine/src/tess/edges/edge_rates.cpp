// Chooses the rates of borders: one for all patches that meet there.

#include <algorithm>
#include <array>
#include <cassert>

#include "tess/edges/edge_needs.h"
#include "tess/edges/side_curve.h"
#include "tess/plan/certified_plan.h"

namespace tessera::inline abi_0_1 {
namespace {

/// At higher rates of a patch, an odd border rate instead of the next even one saves too little to look for.
constexpr int max_to_straddle = 2;

}  // namespace

std::vector<std::uint8_t> CertifiedPlanner::borders_against() const {
  constexpr std::uint32_t none = SharedEdges::none;
  const std::size_t borders = 4 * shapes_.size();
  std::vector<std::uint32_t> welds(borders, none), heads(edges_.count(), none);
  for (std::uint32_t k = 0; k < weld_.borders.size(); ++k) welds[weld_.borders[k].to] = k;
  const auto edge = [&](std::uint32_t border) { return edges_.edge(border / 4, all_sides[border % 4]); };
  // Borders of curves are welded to none, and have no segments.
  const auto counts = [&](std::uint32_t border) { return edge(border) != none && !shapes_[border / 4].is_curve; };
  for (std::uint32_t border = 0; border < borders; ++border)
    if (counts(border) && welds[border] == none && heads[edge(border)] == none) heads[edge(border)] = border;
  std::vector<std::uint8_t> against(borders, 0);
  for (std::uint32_t border = 0; border < borders; ++border) {
    if (!counts(border) || heads[edge(border)] == none) continue;
    const VertexCopies::Border weld =
        welds[border] == none ? VertexCopies::Border{border, border, false} : weld_.borders[welds[border]];
    against[border] = weld.reversed != runs_against(*set_, weld.from, heads[edge(border)]);
  }
  return against;
}

bool CertifiedPlanner::may_straddle(std::size_t patch, Side side, const std::array<Segments, 4>& borders,
                                    double tolerance, CertifiedPlan& plan) const {
  // If no inner points lie between them, a segment of the opposite border may cross the middle as well.
  const auto s = static_cast<std::size_t>(side);
  const Segments border = borders[s], opposite = borders[(s + 2) % 4];
  const int rate = opposite.parts_halves() ? border.rate() : std::min(border.rate(), opposite.rate());
  assert(plan.segments_[patch].are_uniform());  // only patches of at most max_to_straddle segments come here
  const auto [piece, rates] = ChordBound::straddling(plan.segments_[patch].rates(), edge_of(side), rate);
  const PatchSet::Slot slot = set_->slots[patch];
  const double given = roundings_[patch] + fit_error_,
               distance = chords_.piece(slot.block, slot.lane, piece).chord(rates) + given;
  if (!(distance <= tolerance)) return false;
  plan.bounds_[patch] = std::max(plan.bounds_[patch], rounded_up(distance));
  return true;
}

namespace {

/// Returns the needs of each edge in its halves. `against`: for each border, whether it runs against the edge.
std::vector<HalfNeeds> half_needs(std::span<const PatchSegments> segments, std::span<const PatchShape> shapes,
                                  const SharedEdges& edges, std::span<const std::uint8_t> against) {
  std::vector<HalfNeeds> needs(edges.count());
  for (std::size_t k = 0; k < segments.size(); ++k)
    for (const Side side : all_sides)
      if (const std::uint32_t edge = edges.edge(k, side); edge != SharedEdges::none && !shapes[k].is_curve)
        needs[edge].add(along(segments[k], side), against[4 * k + static_cast<std::size_t>(side)]);
  return needs;
}

}  // namespace

void CertifiedPlanner::divide(double tolerance, CertifiedPlan& plan) const {
  const std::span<const PatchShape> shapes = divided_shapes();
  const std::span<const PatchSegments> segments = plan.segments_;
  // Only distances are known for triangles that cross the middle; angles and pixels hold for halves.
  const bool by_distance = !options_.angle && !options_.camera;
  const auto is_coarse = [&](std::size_t k) {
    return by_distance && std::max(segments[k].u.rate(), segments[k].v.rate()) <= max_to_straddle;
  };
  const auto always_straddles = [&](std::size_t k) { return !plan.straddles_.empty() && plan.straddles_[k]; };
  std::vector<EdgeNeeds> needs(edges_.count());
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (shapes[k].is_curve) continue;
    const auto never = static_cast<std::uint16_t>(!is_coarse(k) && !always_straddles(k));
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      if (edge != SharedEdges::none) needs[edge].add(along(segments[k], side), never);
    }
  }
  std::vector<std::uint8_t> against;
  std::vector<HalfNeeds> halves;  // only if some segments are not uniform: then directions of edges matter
  if (options_.fewest && !std::all_of(segments.begin(), segments.end(), [](auto s) { return s.are_uniform(); })) {
    against = borders_against();
    halves = half_needs(segments, shapes, edges_, against);
  }
  const auto uniform_border = [&](std::size_t k, Side side) {
    const std::uint32_t edge = edges_.edge(k, side);
    return edge == SharedEdges::none ? along(segments[k], side) : needs[edge].segments();
  };
  const auto border_in_halves = [&](std::size_t k, Side side) {
    const std::uint32_t edge = edges_.edge(k, side);
    if (edge == SharedEdges::none) return along(segments[k], side);
    return halves[edge].segments(against[4 * k + static_cast<std::size_t>(side)], needs[edge].is_even);
  };
  const auto borders_by = [](std::size_t k, const auto& border) {
    return std::array{border(k, Side::v0), border(k, Side::u1), border(k, Side::v1), border(k, Side::u0)};
  };
  const auto borders_of = [&](std::size_t k) {
    return halves.empty() ? borders_by(k, uniform_border) : borders_by(k, border_in_halves);
  };
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (!is_coarse(k) || shapes[k].is_curve || always_straddles(k)) continue;
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      if (!along(segments[k], side).parts_halves() || edge == SharedEdges::none) continue;
      const std::array<Segments, 4> borders = borders_of(k);
      if (!borders[static_cast<std::size_t>(side)].parts_halves() && !may_straddle(k, side, borders, tolerance, plan))
        needs[edge].is_even = 1;
    }
  }
  plan.divisions_.reserve(segments.size());
  for (std::size_t k = 0; k < segments.size(); ++k)
    plan.divisions_.emplace_back().set(shapes[k], segments[k], borders_of(k));
}

}  // namespace tessera::inline abi_0_1
