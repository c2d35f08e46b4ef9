#include "section/patch_arcs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {

void PatchArcs::reset(const PatchCells& cells, const Level& level, double contact) {
  cells_ = &cells;
  level_ = level;
  contact_ = contact;
  ++turn_;
  if (made_.size() < cells.lines().size()) made_.resize(cells.lines().size(), 0);
  if (roots_.size() < cells.interval_count()) {
    roots_.resize(cells.interval_count());
    crossing_of_.resize(cells.interval_count());
  }
  if (above_.size() < cells.interval_count() + cells.lines().size())
    above_.resize(cells.interval_count() + cells.lines().size());
  crossings_.clear();
  arcs_.clear();
  points_.clear();
  special_.clear();
  touched_.clear();
}

void PatchArcs::find(const PatchCells& cells, const Level& level, double contact) {
  reset(cells, level, contact);
  to_visit_.assign(1, 0);
  while (!to_visit_.empty()) {
    const std::uint32_t at = to_visit_.back();
    to_visit_.pop_back();
    const CellNode& node = cells.nodes()[at];
    if (level.at < node.low - 2 * contact || level.at > node.high + 2 * contact) continue;
    if (node.first_child == 0) {
      visit(at);
    } else {
      to_visit_.push_back(node.first_child + 1);
      to_visit_.push_back(node.first_child);
    }
  }
}

/// Finds on which side of the plane the places of a line are, and its points in the plane.
void PatchArcs::make(std::uint32_t index) {
  if (made_[index] == turn_) return;
  made_[index] = turn_;
  const CellLine& line = cells_->lines()[index];
  const std::span<const double> heights = line.heights->heights();
  std::uint8_t* const above = above_.data() + line.first_interval + index;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    above[k] = level_.is_above(heights[k]);
    if (std::abs(heights[k] - level_.at) > 2 * contact_) continue;
    const double along = line.parameter(line.heights->places()[k]);
    special_.push_back(line.along_u ? ParameterPoint{along, line.across} : ParameterPoint{line.across, along});
  }
  if (index >= 4) {
    above[0] = is_above(line.on[0], line.across);
    above[heights.size() - 1] = is_above(line.on[1], line.across);
  }
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    if (above[k] == above[k + 1]) continue;
    roots_[line.first_interval + k] = line.heights->root(k, level_.at);
    crossing_of_[line.first_interval + k] = no_id;
  }
}

bool PatchArcs::is_above(std::uint32_t index, double parameter) {
  make(index);
  const CellLine& line = cells_->lines()[index];
  const double place = line.place(parameter);
  const std::size_t k = line.heights->interval_at(place);
  const std::uint8_t* const above = above_.data() + line.first_interval + index;
  if (place == line.heights->places()[k] || above[k] == above[k + 1]) return above[k] != 0;
  if (place == line.heights->places()[k + 1]) return above[k + 1] != 0;
  return above[place < roots_[line.first_interval + k] ? k : k + 1] != 0;
}

std::uint32_t PatchArcs::crossing(std::uint32_t index, std::size_t interval) {
  const CellLine& line = cells_->lines()[index];
  std::uint32_t& known = crossing_of_[line.first_interval + interval];
  if (known != no_id) return known;
  known = static_cast<std::uint32_t>(crossings_.size());
  const double along = line.parameter(roots_[line.first_interval + interval]);
  LineCrossing found{.line = index, .interval = static_cast<std::uint32_t>(interval)};
  found.at = line.along_u ? ParameterPoint{along, line.across} : ParameterPoint{line.across, along};
  crossings_.push_back(found);
  return known;
}

/// Appends the crossings of a cell's side, in the direction of its line's parameter or against it.
void PatchArcs::add_side(const CellSide& side, bool backward) {
  make(side.line);
  const CellLine& line = cells_->lines()[side.line];
  const std::span<const double> places = line.heights->places();
  const std::uint8_t* const above = above_.data() + line.first_interval + side.line;
  const auto [low, high] = std::minmax({line.place(side.from), line.place(side.to)});
  const std::size_t first = around_.size();
  const auto sign = [&](double place, std::size_t k) {
    if (place == places[k]) return above[k] != 0;
    if (place == places[k + 1]) return above[k + 1] != 0;
    return above[place < roots_[line.first_interval + k] ? k : k + 1] != 0;
  };
  for (std::size_t k = line.heights->interval_at(low); k + 1 < places.size() && places[k] < high; ++k) {
    if (above[k] == above[k + 1]) continue;
    if (sign(std::max(low, places[k]), k) != sign(std::min(high, places[k + 1]), k))
      around_.push_back(crossing(side.line, k));
  }
  if (backward != line.reversed) std::reverse(around_.begin() + static_cast<std::ptrdiff_t>(first), around_.end());
}

void PatchArcs::add_arc(std::uint32_t cell, std::uint32_t from, std::uint32_t to) {
  const auto arc = static_cast<std::uint32_t>(arcs_.size());
  arcs_.push_back({cell, {from, to}});
  for (const std::uint32_t end : {from, to}) {
    auto& arcs = crossings_[end].arcs;
    arcs[arcs[0] == no_id ? 0 : 1] = arc;
  }
}

/// Sorts the crossings of a cell with a graph along its parameter. Each side across it has one at most, and comes first
/// or last. An arc begins or ends at each of the others, in their order.
void PatchArcs::sort_over(const CellNode& cell) {
  const bool over_u = runs_over_u(cell.kind);
  const bool is_constant = cell.kind == CellKind::along_u || cell.kind == CellKind::along_v;
  const double first = over_u ? cell.domain.u0 : cell.domain.v0, last = over_u ? cell.domain.u1 : cell.domain.v1;
  const auto key = [&](std::uint32_t k) {
    const LineCrossing& at = crossings_[k];
    const double along = over_u ? at.at.u : at.at.v, across = over_u ? at.at.v : at.at.u;
    if (is_constant) return std::tuple(across, 0, along);
    const bool is_end = cells_->lines()[at.line].along_u != over_u;
    return std::tuple(along, !is_end ? 0 : along == first ? -1 : along == last ? 1 : 0, across);
  };
  std::ranges::stable_sort(around_, {}, key);
}

void PatchArcs::visit(std::uint32_t index) {
  const CellNode& cell = cells_->nodes()[index];
  around_.clear();
  for (const Side side : all_sides) add_side(cell.sides[static_cast<std::size_t>(side)], is_backward(side));
  if (cell.kind == CellKind::tiny) {
    if (!cell.is_shallow) (around_.empty() ? touched_ : points_).push_back(index);
  }
  if (around_.size() > 2 && cell.kind != CellKind::tiny) sort_over(cell);
  for (std::size_t k = 0; k + 1 < around_.size(); k += 2) add_arc(index, around_[k], around_[k + 1]);
}

}}  // namespace tessera::abi_0_1
