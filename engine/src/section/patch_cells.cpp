#include "section/patch_cells.h"

#include <cmath>
#include <utility>

#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Chords of a cell beyond which it may pay to bound its parts one by one, and how often it is tried.
constexpr double many_chords = 16, more_chords = 64, max_chords = 4096;
constexpr int eager_depth = 6, max_depth = 60;

bool is_simple(const CellFacts& facts, const Levels& levels, int depth) {
  if (facts.kind == CellKind::empty) return true;
  if (facts.kind != CellKind::open) {
    if (facts.diameter <= levels.chord) return true;
    const double chords = std::sqrt(facts.bending / (8 * levels.chord));
    if (chords <= many_chords || (depth >= eager_depth && chords <= more_chords)) return true;
    if (depth >= 2 * eager_depth && chords <= max_chords) return true;
  }
  return false;
}

}  // namespace

struct PatchCells::Part {
  CellNet net;
  std::uint32_t node;
  int depth;
};

PatchCells::PatchCells(const BezierPatch& patch, const Levels& levels, const std::array<PatchBorder, 4>& borders) {
  CellNode root;
  for (const Side side : all_sides) {
    const auto k = static_cast<std::size_t>(side);
    CellLine line{.heights = borders[k].heights, .reversed = borders[k].reversed, .along_u = runs_along_u(side)};
    line.across = is_far(side) ? 1 : 0;
    line.first_interval = interval_count_;
    interval_count_ += line.heights->interval_count();
    is_proven_ = is_proven_ && !line.heights->is_shallow();
    lines_.push_back(line);
    root.sides[k].line = static_cast<std::uint32_t>(k);
  }
  nodes_.push_back(root);
  std::deque<Part> parts;
  parts.push_back({CellNet(patch, levels), 0, 0});
  while (!parts.empty()) {
    Part part = std::move(parts.front());
    parts.pop_front();
    divide(std::move(part), levels, parts);
  }
}

void PatchCells::divide(Part part, const Levels& levels, std::deque<Part>& parts) {
  const CellFacts facts = part.net.facts(levels);
  CellNode& node = nodes_[part.node];
  node.low = facts.low, node.high = facts.high;
  node.kind = facts.kind;
  node.bending = facts.bending, node.slack = facts.slack, node.diameter = facts.diameter;
  if (is_simple(facts, levels, part.depth)) return;
  if (facts.high - facts.low <= levels.contact) {
    // It lies in the plane as far as anyone can tell. A whole patch has no curves then; a part of one may have some.
    node.kind = CellKind::tiny;
    node.is_shallow = facts.diameter > levels.point_size;
    is_proven_ = is_proven_ && (part.node == 0 || !node.is_shallow);
    return;
  }
  if (facts.diameter <= levels.point_size || part.depth >= max_depth || nodes_.size() >= max_cells) {
    if (node.kind == CellKind::open) node.kind = CellKind::tiny;
    node.is_shallow = facts.diameter > levels.point_size;
    is_proven_ = is_proven_ && !node.is_shallow;
    return;
  }
  const bool along_u = facts.divide_u;
  CellNet upper = part.net.take_upper_half(along_u);
  const Domain& domain = node.domain;
  const double at = along_u ? 0.5 * (domain.u0 + domain.u1) : 0.5 * (domain.v0 + domain.v1);
  const std::uint32_t line = add_line(part.net, along_u, node, at, levels);
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  node.first_child = first;
  node.divided_u = along_u;
  CellNode low{.domain = node.domain, .sides = node.sides}, high = low;
  const auto cut = [&](Side side) {
    low.sides[static_cast<std::size_t>(side)].to = at;
    high.sides[static_cast<std::size_t>(side)].from = at;
  };
  const Side far = along_u ? Side::u1 : Side::v1, near = opposite(far);
  cut(along_u ? Side::v0 : Side::u0);
  cut(along_u ? Side::v1 : Side::u1);
  (along_u ? low.domain.u1 : low.domain.v1) = (along_u ? high.domain.u0 : high.domain.v0) = at;
  low.sides[static_cast<std::size_t>(far)] =
      high.sides[static_cast<std::size_t>(near)] = {line, lines_[line].from, lines_[line].to};
  nodes_.push_back(low);
  nodes_.push_back(high);
  parts.push_back({std::move(part.net), first, part.depth + 1});
  parts.push_back({std::move(upper), first + 1, part.depth + 1});
}

/// Adds the line that divides a node, across the direction of the division.
std::uint32_t PatchCells::add_line(CellNet& lower, bool along_u, const CellNode& node, double at,
                                   const Levels& levels) {
  auto [weighted, weights] = lower.upper_side(along_u);
  own_lines_.emplace_back(std::move(weighted), std::move(weights)).divide(levels);
  const Side low = along_u ? Side::v0 : Side::u0;
  CellLine line{.heights = &own_lines_.back(), .along_u = !along_u, .across = at};
  line.from = along_u ? node.domain.v0 : node.domain.u0;
  line.to = along_u ? node.domain.v1 : node.domain.u1;
  line.on = {node.sides[static_cast<std::size_t>(low)].line, node.sides[static_cast<std::size_t>(opposite(low))].line};
  line.first_interval = interval_count_;
  interval_count_ += line.heights->interval_count();
  is_proven_ = is_proven_ && !line.heights->is_shallow();
  lines_.push_back(line);
  return static_cast<std::uint32_t>(lines_.size() - 1);
}

}}  // namespace tessera::abi_0_1
