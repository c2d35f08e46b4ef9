#include "tess/edges/segment_choices.h"

#include <numeric>

#include "tess/cells/stitched_patch.h"
#include "tess/edges/edge_needs.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int rounds = 4;
/// For edges with more borders, needs are summed up once per round; the needs of a choice can only add to that sum.
constexpr std::size_t max_looked_at = 8;

class Chooser {
 public:
  Chooser(std::span<const PatchShape> shapes, const SharedEdges& edges, std::span<const std::uint8_t> against,
          std::span<const SegmentChoices> choices, const std::atomic<bool>* cancel)
      : shapes_(shapes),
        edges_(edges),
        against_(against),
        choices_(choices),
        cancel_(cancel),
        chosen_(choices.size(), 0),
        first_(edges.count() + 1, 0),
        needs_(edges.count()) {
    const auto for_borders = [&](auto visit) {
      for (std::uint32_t border = 0; border < 4 * shapes.size(); ++border)
        if (const std::uint32_t edge = edge_of_border(border); edge != no_id) visit(border, edge);
    };
    for_borders([&](std::uint32_t, std::uint32_t edge) { ++first_[edge + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    borders_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_borders([&](std::uint32_t border, std::uint32_t edge) { borders_[next[edge]++] = border; });
  }

  Result<std::vector<std::uint8_t>> choose() {
    const std::size_t before = triangles();
    for (int round = 0; round < rounds && improve(); ++round) continue;
    if (triangles() > before) std::fill(chosen_.begin(), chosen_.end(), std::uint8_t{0});
    if (is_cancelled()) return Status(StatusCode::cancelled, "cancelled by the caller");
    return std::move(chosen_);
  }

 private:
  std::uint32_t edge_of_border(std::uint32_t border) const {
    return shapes_[border / 4].is_curve ? no_id : edges_.edge(border / 4, all_sides[border % 4]);
  }
  const ProvenSegments& present(std::size_t patch) const { return choices_[patch][chosen_[patch]]; }

  bool is_cancelled() const { return cancel_ && cancel_->load(); }

  struct Needs {
    PieceNeeds pieces;
    std::uint16_t is_even = 0;

    void add(const ProvenSegments& proven, Side side, bool against) {
      const Segments wanted = along(proven.segments, side);
      pieces.add(wanted, against);
      is_even |= static_cast<std::uint16_t>(!proven.anywhere && wanted.parts_halves());
    }
  };
  std::size_t border_count(std::uint32_t edge) const { return first_[edge + 1] - first_[edge]; }
  /// Returns the needs of all borders of an edge if the patch takes that choice.
  Needs needs_with(std::uint32_t edge, std::size_t patch, const ProvenSegments& choice) const {
    Needs needs;
    for (std::size_t k = first_[edge]; k < first_[edge + 1]; ++k) {
      const std::uint32_t border = borders_[k];
      needs.add(border / 4 == patch ? choice : present(border / 4), all_sides[border % 4], against_[border]);
    }
    return needs;
  }
  void sum_up() {
    for (std::uint32_t edge = 0; edge < needs_.size(); ++edge)
      if (border_count(edge) > max_looked_at) needs_[edge] = needs_with(edge, choices_.size(), {});  // no patch
  }

  /// Does one round; returns whether a patch took another choice.
  bool improve() {
    bool has_changed = false;
    sum_up();
    for (std::size_t k = 0; k < choices_.size() && !is_cancelled(); ++k) {
      if (shapes_[k].is_curve || choices_[k].count() == 1) continue;
      const std::uint8_t had = chosen_[k];
      std::size_t least = cost(k, choices_[k][had]);
      for (std::uint8_t c = 0; c < choices_[k].count(); ++c)
        if (const std::size_t triangles = cost(k, choices_[k][c]); triangles < least) least = triangles, chosen_[k] = c;
      has_changed |= chosen_[k] != had;
    }
    return has_changed;
  }

  /// Counts a patch's triangles, and those of its neighbours at its borders. The neighbours' other triangles are left
  /// out: their number does not depend on the choice, except where a neighbour whose borders are joined gets inner
  /// points.
  std::size_t cost(std::size_t patch, const ProvenSegments& choice) const {
    std::array<Segments, 4> borders;
    std::size_t beside = 0;
    for (const Side side : all_sides) {
      const auto s = static_cast<std::size_t>(side);
      borders[s] = border_with(patch, side, choice);
      if (const std::uint32_t edge = edges_.edge(patch, side); edge != no_id)
        beside += (border_count(edge) - 1) * static_cast<std::size_t>(borders[s].rate());
    }
    return beside + Division::of(shapes_[patch], choice.segments, borders).triangle_count();
  }
  /// Returns the segments of a border if its patch takes that choice.
  Segments border_with(std::size_t patch, Side side, const ProvenSegments& choice) const {
    const std::uint32_t edge = edges_.edge(patch, side);
    if (edge == no_id) return along(choice.segments, side);
    const std::size_t own = 4 * patch + static_cast<std::size_t>(side);
    Needs needs = needs_[edge];
    if (border_count(edge) > max_looked_at) {
      needs.add(choice, side, against_[own]);
    } else {
      needs = needs_with(edge, patch, choice);
    }
    return needs.pieces.segments(against_[own], needs.is_even);
  }
  std::size_t triangles() {
    sum_up();
    std::size_t count = 0;
    for (std::size_t k = 0; k < choices_.size(); ++k) {
      std::array<Segments, 4> borders;
      for (const Side side : all_sides) borders[static_cast<std::size_t>(side)] = border_with(k, side, present(k));
      count += Division::of(shapes_[k], present(k).segments, borders).triangle_count();
    }
    return count;
  }

  std::span<const PatchShape> shapes_;
  const SharedEdges& edges_;
  std::span<const std::uint8_t> against_;
  std::span<const SegmentChoices> choices_;
  const std::atomic<bool>* cancel_;
  std::vector<std::uint8_t> chosen_;
  std::vector<std::size_t> first_;      ///< `[edge]`: its first place in borders_, and the number of all at the end
  std::vector<std::uint32_t> borders_;  ///< edge by edge, 4 * patch + side
  std::vector<Needs> needs_;            ///< `[edge]`, set for edges with more than max_looked_at borders
};

}  // namespace

Result<std::vector<std::uint8_t>> choose_together(std::span<const PatchShape> shapes, const SharedEdges& edges,
                                                  std::span<const std::uint8_t> against,
                                                  std::span<const SegmentChoices> choices,
                                                  const std::atomic<bool>* cancel) {
  return Chooser(shapes, edges, against, choices, cancel).choose();
}

}}  // namespace tessera::abi_0_1
