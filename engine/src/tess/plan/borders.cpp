#include "tess/plan/borders.h"

#include <algorithm>

#include "base/union_find.h"
#include "block/patch_trims.h"
#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {

Borders::Borders(const PatchNeeds& needs, SharedEdges edges, std::span<const std::uint32_t> only_borders,
                 const CutFaces& faces)
    : edges_(std::move(edges)) {
  const PatchSet::Impl& set = needs.set();
  if (set.trims) {
    drawn_.assign(needs.shapes().begin(), needs.shapes().end());
    for (const PatchTrims::Cut& cut : set.trims->cuts) drawn_[cut.patch].is_curve = true;
  }
  weld_by(needs, only_borders, faces.runs ? &*faces.runs : nullptr);
  if (!faces.borders_in_step.empty()) find_in_step(faces.borders_in_step);
}

void Borders::weld_by(const PatchNeeds& needs, std::span<const std::uint32_t> only_borders, const EdgeRuns* runs) {
  const PatchSet::Impl& set = needs.set();
  const PlannerOptions& options = needs.options();
  WeldRules rules = options.weld;
  std::vector<std::uint8_t> stay;
  if (runs) stay = runs->borders_that_meet(set.patches.size());
  rules.stay = stay;
  rules.f64_patches = options.f64_patches;
  rules.short_sides = needs.chords().short_sides();
  if (options.f64_positions) {
    // Far from zero the last bits of doubles affect the floats of coordinates that are small relative to the origin.
    const Box3 box = set.model_box();
    rules.reach = std::max(rules.reach, 0x1p-50 * std::max(max_abs(box.lower), max_abs(box.upper)));
    edges_ = parted_by_doubles(set, edges_);
  } else {
    rules.only_borders = only_borders;
  }
  if (!(rules.reach > 0) && rules.f64_patches.empty()) return;
  weld_ = weld_borders(set, shapes(needs), needs.roundings(), rules, edges_);
}

void Borders::find_in_step(std::span<const std::array<std::uint32_t, 2>> pairs) {
  UnionFind groups(edges_.count());
  const auto edge_of_border = [&](std::uint32_t border) { return edges_.edge(border / 4, all_sides[border % 4]); };
  for (const auto& [a, b] : pairs)
    if (const std::uint32_t of_a = edge_of_border(a), of_b = edge_of_border(b); of_a != no_id && of_b != no_id)
      groups.unite(of_a, of_b);
  std::vector<std::uint32_t> places(edges_.count(), no_id);
  for (std::uint32_t edge = 0; edge < edges_.count(); ++edge) {
    const std::uint32_t first = groups.find(edge).member;
    if (first == edge) continue;
    if (places[first] == no_id) {
      places[first] = static_cast<std::uint32_t>(in_step_.size());
      in_step_.push_back({first});
    }
    in_step_[places[first]].push_back(edge);
  }
}

bool Borders::follow(const PatchNeeds& needs) {
  const std::uint64_t revision = needs.set().revision;
  if (known_ && known_->revision == revision) return known_->hold;
  known_.reset();
  Directions known{.revision = revision, .hold = directions(needs).hold(), .against = {}};
  if (known.hold) known.against = against(needs);
  known_ = std::move(known);
  return known_->hold;
}

std::vector<std::uint8_t> Borders::against(const PatchNeeds& needs) const {
  if (known_ && known_->revision == needs.set().revision) return known_->against;
  const EdgeDirections directions = this->directions(needs);
  std::vector<std::uint8_t> against(4 * needs.shapes().size(), 0);
  for (std::uint32_t border = 0; border < against.size(); ++border)
    if (!needs.shapes()[border / 4].is_curve) against[border] = directions.runs_against_leading(border);
  return against;
}

}}  // namespace tessera::abi_0_1
