#include "tess/plan/divide_patches.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include "block/patch_trims.h"
#include "parallel/long_lists.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/edges/edge_needs.h"
#include "tess/edges/thin_patches.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// At higher rates of a patch, an odd border rate instead of the next even one saves too little to look for.
constexpr int max_to_cross = 2;

/// Returns the distance of the triangle that crosses the middle of an odd border, for a patch whose even rate along it
/// has a bound of halves.
double crossing_distance(const PatchNeeds& needs, PatchSegments segments, std::size_t patch, Side side) {
  // The border has an odd number of segments, more than the patch needs, so its middle segment crosses the middle of
  // the patch. Without inner points between them, the opposite border's may cross it too. That border is taken to have
  // an odd number as well: its real rate depends on patches that this one does not touch.
  assert(segments.are_uniform());  // only patches of at most max_to_cross segments come here
  const int rate = along(segments, side).rate() + 1;
  const auto [piece, rates] = ChordBound::crossing(segments.rates(), side, rate);
  const PatchSet::Slot slot = needs.set().slots[patch];
  return needs.chords().piece(slot.block, slot.lane, piece).chord(rates) + needs.given(patch);
}

/// Chooses the segments of all borders from those that the patches need for themselves.
class BorderSegments {
 public:
  BorderSegments(std::span<const PatchSegments> segments, const SharedEdges& edges)
      : segments_(segments), edges_(edges), needs_(edges.count()) {}

  /// Adds the needs of a patch. `never`: 1 if its borders must be even where it has an even rate.
  void add(std::size_t patch, std::uint32_t never) {
    const EdgeNeeds u(segments_[patch].u, never), v(segments_[patch].v, never);
    const std::uint32_t* const edges = edges_.of_borders().data() + 4 * patch;
    EdgeNeeds* const needs = needs_.data();
    const auto add_to = [needs](std::uint32_t edge, EdgeNeeds one) {
      if (edge != no_id) needs[edge].add(one);
    };
    add_to(edges[0], u), add_to(edges[1], v), add_to(edges[2], u), add_to(edges[3], v);
  }
  /// Counts the needs of each edge in its eighths, for segments that are not uniform. `against`: for each border,
  /// whether it runs against the edge. `has_needs`: whether a patch was added.
  template <class HasNeeds>
  void part(std::vector<std::uint8_t> against, const HasNeeds& has_needs) {
    against_ = std::move(against);
    pieces_.resize(edges_.count());
    for (std::size_t k = 0; k < segments_.size(); ++k)
      for (const Side side : all_sides)
        if (const std::uint32_t edge = edges_.edge(k, side); edge != no_id && has_needs(k))
          pieces_[edge].add(along(segments_[k], side), is_against(k, side));
  }
  /// Gives the edges of each group the needs of all of them, where these are uniform. Other groups keep their own:
  /// their patches decide, not those elsewhere.
  void share(std::span<const std::vector<std::uint32_t>> groups) {
    groups_ = groups;
    share();
  }
  void share() {
    for (const std::vector<std::uint32_t>& group : groups_) {
      if (!std::ranges::all_of(group, [this](std::uint32_t edge) { return is_uniform(edge); })) continue;
      EdgeNeeds all;
      for (const std::uint32_t edge : group) all.take(needs_[edge]);
      for (const std::uint32_t edge : group) {
        needs_[edge].take(all);
        if (!pieces_.empty() && !pieces_[edge].empty()) pieces_[edge].add(all.most(), false);
      }
    }
  }
  /// Whether a patch has an even rate along a border that other patches may share.
  bool is_even_edge(std::size_t patch, Side side) const {
    return along(segments_[patch], side).parts_halves() && edges_.edge(patch, side) != no_id;
  }
  void make_even(std::size_t patch, Side side) { needs_[edges_.edge(patch, side)].make_even(); }

  /// Returns how many segments lie on edges with one border.
  std::uint32_t open_edges() const {
    std::uint32_t count = 0;
    if (pieces_.empty()) {
      for (const EdgeNeeds needs : needs_)
        if (needs.has_one_patch()) count += needs.rate();
    } else {
      for (std::uint32_t edge = 0; edge < needs_.size(); ++edge)
        if (needs_[edge].has_one_patch()) count += static_cast<std::uint32_t>(of_edge(edge, false).rate());
    }
    return count;
  }

  /// Returns the segments of a border.
  Segments of(std::size_t patch, Side side) const {
    const std::uint32_t edge = edges_.edge(patch, side);
    return edge == no_id ? along(segments_[patch], side) : of_edge(edge, is_against(patch, side));
  }
  /// Writes the segments of a patch's four borders.
  void put(std::size_t patch, std::array<Segments, 4>& borders) const {
    if (!pieces_.empty()) {
      for (const Side side : all_sides) borders[static_cast<std::size_t>(side)] = of(patch, side);
      return;
    }
    const PatchSegments own = segments_[patch];
    const std::uint32_t* const edges = edges_.of_borders().data() + 4 * patch;
    const EdgeNeeds* const needs = needs_.data();
    const auto of_border = [needs](std::uint32_t edge, Segments along) {
      return edge == no_id ? along : needs[edge].segments();
    };
    borders[0] = of_border(edges[0], own.u), borders[1] = of_border(edges[1], own.v);
    borders[2] = of_border(edges[2], own.u), borders[3] = of_border(edges[3], own.v);
  }

 private:
  bool is_uniform(std::uint32_t edge) const { return pieces_.empty() || pieces_[edge].is_uniform(); }
  bool is_against(std::size_t patch, Side side) const {
    return !against_.empty() && against_[4 * patch + static_cast<std::size_t>(side)];
  }
  Segments of_edge(std::uint32_t edge, bool against) const {
    return pieces_.empty() ? needs_[edge].segments() : pieces_[edge].segments(against, needs_[edge].is_even());
  }

  std::span<const PatchSegments> segments_;
  const SharedEdges& edges_;
  std::vector<EdgeNeeds> needs_;       ///< `[edge]`
  std::vector<PieceNeeds> pieces_;     ///< `[edge]`; empty if all segments are uniform
  std::vector<std::uint8_t> against_;  ///< `[border]`; empty if all segments are uniform
  std::span<const std::vector<std::uint32_t>> groups_;
};

constexpr std::size_t patches_in_piece = 2048;

/// Calls work(begin, end) for pieces of the patches, on all threads.
template <class Work>
void for_pieces(std::size_t patches, const Work& work) {
  if (!parallel_for(patches, patches_in_piece, {}, work).ok()) throw std::bad_alloc();  // the only error
}

/// The odd borders that some patches refuse, and the others' patches, with their distances there.
struct OddBorders {
  std::vector<std::pair<std::size_t, Side>> refused = {};
  std::vector<std::pair<std::size_t, float>> accepted = {};
};

/// Makes the borders even that patches refuse, and returns the odd ones that are left, by pieces of the patches. The
/// borders are made even together: a refusal must not depend on an earlier one. Each raises rates, which lowers the
/// distances of those that were accepted.
template <class ForOddBorders>
std::vector<OddBorders> make_refused_even(BorderSegments& borders, const PlanFacts& facts, double tolerance,
                                          std::size_t patches, const ForOddBorders& for_odd_borders) {
  const auto judge = [&] {
    std::vector<OddBorders> pieces((patches + patches_in_piece - 1) / patches_in_piece);
    for_pieces(patches, [&](std::size_t begin, std::size_t end) {
      OddBorders& piece = pieces[begin / patches_in_piece];
      for_odd_borders(begin, end, [&](std::size_t k, Side side, double distance) {
        if (!(distance <= facts.needs.tolerance_of(k, tolerance))) {
          piece.refused.emplace_back(k, side);
        } else {
          piece.accepted.emplace_back(k, rounded_up(distance));
        }
      });
    });
    return pieces;
  };
  std::vector<OddBorders> pieces = judge();
  const auto refuses = [](const OddBorders& piece) { return !piece.refused.empty(); };
  if (std::ranges::none_of(pieces, refuses)) return pieces;
  for (const OddBorders& piece : pieces)
    for (const auto& [k, side] : piece.refused) borders.make_even(k, side);
  borders.share();
  pieces = judge();
  assert(std::ranges::none_of(pieces, refuses));
  return pieces;
}

/// Whether welding made a patch a point, and a neighbour has triangles there.
bool is_welded_spot(const PatchNeeds& needs, std::size_t patch, const DividedPatches& patches) {
  // Welding makes such a patch a point only where a neighbour has this point, see weld_borders().
  return patches.divisions[patch].has_one_corner() && !needs.shapes()[patch].collapsed.any() &&
         patches.segments[patch] == PatchSegments{1, 1} &&
         is_needle(needs.set().patches[patch], Side::v0, needs.options().weld.reach);
}

/// Gives triangles to patches without any, unless those of a neighbour show what is left of them. `has_poles`: whether
/// any patch has a border that is a point.
void keep_from_vanishing(const PlanFacts& facts, bool has_poles, DividedPatches& patches) {
  const SharedEdges& edges = facts.borders.edges();
  std::vector<Division>& divisions = patches.divisions;
  if (!patches.rare->lines.empty()) patches.rare.make().lines.clear();
  if (!has_poles) return;
  std::vector<std::uint32_t> without;  // patches of an area without triangles
  for (std::uint32_t k = 0; k < divisions.size(); ++k)
    if (const Division& of = divisions[k]; of.collapsed.any() && !of.empty && of.triangle_count() == 0)
      without.push_back(k);
  if (without.empty()) return;
  std::vector<std::uint32_t> holders(edges.count(), no_id);  // `[edge]`: a patch with triangles
  for (std::uint32_t k = 0; k < divisions.size(); ++k)
    for (const Side side : all_sides)
      if (const std::uint32_t edge = edges.edge(k, side); edge != no_id && divisions[k].triangle_count() > 0)
        holders[edge] = k;
  for (const std::uint32_t k : without) {
    std::uint32_t holder = no_id;
    for (const Side side : all_sides)
      if (const std::uint32_t edge = edges.edge(k, side); edge != no_id && holder == no_id) holder = holders[edge];
    if (holder == no_id && !is_welded_spot(facts.needs, k, patches)) {
      divisions[k].add_inner_points(patches.segments[k]);
    } else {
      patches.rare.make().lines.push_back({k, holder});
    }
  }
}

/// Chooses the borders, and raises the bounds of patches whose triangles cross their middles there.
BorderSegments choose_borders(const PlanFacts& facts, double tolerance, DividedPatches& patches) {
  const PatchSet::Impl& set = facts.needs.set();
  const std::span<const PatchShape> shapes = facts.borders.shapes(facts.needs);
  const std::span<const PatchSegments> segments = patches.segments;
  // Only distances are known for triangles that cross the middle; angles and pixels hold for halves.
  const bool by_distance = patches.angles.empty() && patches.pixels.empty();
  const auto is_coarse = [&](std::size_t k) {
    return by_distance && std::max(segments[k].u.rate(), segments[k].v.rate()) <= max_to_cross;
  };
  const std::uint8_t *const crosses = patches.crosses.empty() ? nullptr : patches.crosses.data(),
                            *const cuts = set.trims ? set.trims->is_cut.data() : nullptr;
  const auto always_crosses = [crosses](std::size_t k) { return crosses && crosses[k]; };
  BorderSegments borders(segments, facts.borders.edges());
  std::uint64_t keys = 0;
  const auto is_cut = [cuts](std::size_t k) { return cuts && cuts[k]; };
  const auto has_needs = [&](std::size_t k) { return !shapes[k].is_curve || is_cut(k); };
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (has_needs(k)) borders.add(k, std::uint32_t{!is_cut(k) && !is_coarse(k) && !always_crosses(k)});
    keys |= segments[k].u.key() | segments[k].v.key();
  }
  if (!Segments::are_uniform(keys)) borders.part(facts.borders.against(facts.needs), has_needs);
  borders.share(facts.borders.in_step());
  const auto for_odd_borders = [&](std::size_t begin, std::size_t end, const auto& visit) {
    for (std::size_t k = begin; k < end; ++k) {
      if (!is_coarse(k) || shapes[k].is_curve || always_crosses(k)) continue;
      for (const Side side : all_sides) {
        if (!borders.is_even_edge(k, side)) continue;
        if (!borders.of(k, side).parts_halves()) visit(k, side, crossing_distance(facts.needs, segments[k], k, side));
      }
    }
  };
  for (const OddBorders& piece : make_refused_even(borders, facts, tolerance, segments.size(), for_odd_borders))
    for (const auto& [k, distance] : piece.accepted) patches.bounds[k] = std::max(patches.bounds[k], distance);
  return borders;
}

void divide(const PlanFacts& facts, const BorderSegments& borders, DividedPatches& patches) {
  const std::span<const PatchShape> shapes = facts.borders.shapes(facts.needs);
  const std::span<const PatchSegments> segments = patches.segments;
  const ListSize sizes[] = {size_of(patches.divisions, segments.size())};
  resize_lists(sizes);
  const std::span<Division> divisions = patches.divisions;
  std::atomic<bool> has_poles = false;
  for_pieces(segments.size(), [&](std::size_t begin, std::size_t end) {
    bool finds_poles = false;
    for (std::size_t k = begin; k < end; ++k) {
      borders.put(k, divisions[k].border);
      divisions[k].set(shapes[k], segments[k]);
      finds_poles |= shapes[k].collapsed.any();
    }
    if (finds_poles) has_poles = true;
  });
  patches.open_edges = borders.open_edges();
  keep_from_vanishing(facts, has_poles, patches);
}

/// Returns rates up to `most` that keep a distance wherever triangles lie, also across the middle; empty if there are
/// none.
std::optional<Rates> rates_within(const ChordBound& chord, double distance, Rates most) {
  ChordBound::Pieces pieces;
  pieces.fill(chord.pieces()[0]);
  const ChordBound anywhere(pieces);
  const auto keeps = [&](Rates rates) { return anywhere.distance(rates) <= distance; };
  const std::optional<Rates> best = anywhere.cheapest(distance, max_rate);
  if (!best) return {};
  const Rates capped{std::min(best->u, most.u), std::min(best->v, most.v)};
  if (keeps(capped)) return capped;
  for (const bool fixed_u : {true, false}) {
    const int fixed = fixed_u ? capped.u : capped.v, other = fixed_u ? most.v : most.u;
    const double needed = anywhere.needed(distance, fixed, fixed_u, false);
    if (!(needed <= other)) continue;
    const int rate = std::min(other, static_cast<int>(std::ceil(needed)));
    const Rates rates = fixed_u ? Rates{fixed, rate} : Rates{rate, fixed};
    if (keeps(rates)) return rates;
  }
  return {};
}

}  // namespace

void divide_patches(const PlanFacts& facts, double tolerance, DividedPatches& patches) {
  divide(facts, choose_borders(facts, tolerance, patches), patches);
}

void divide_within_borders(const PlanFacts& facts, double tolerance, double border_tolerance, DividedPatches& patches) {
  const BorderSegments borders = choose_borders(facts, border_tolerance, patches);
  const std::vector<PatchSegments> of_borders = std::move(patches.segments);  // the memory that `borders` refers to
  patches.segments = of_borders;
  patches.crosses.assign(patches.segments.size(), 0);
  for (std::size_t k = 0; k < patches.segments.size(); ++k) {
    const double left = tolerance - facts.needs.given(k);
    const Rates most = of_borders[k].rates();
    const auto rates = left > 0 ? rates_within(facts.needs.chord(k), left, most) : std::optional<Rates>();
    if (!rates || !(double(rates->u) * rates->v < double(most.u) * most.v)) continue;
    patches.segments[k] = *rates;
    patches.bounds[k] = rounded_up(facts.needs.chord(k).distance_of(*rates, true) + facts.needs.given(k));
    patches.crosses[k] = 1;
  }
  if (!patches.rare->beyond.empty())
    std::erase_if(patches.rare.make().beyond, [&](std::uint32_t k) { return double(patches.bounds[k]) <= tolerance; });
  divide(facts, borders, patches);
}

}}  // namespace tessera::abi_0_1
