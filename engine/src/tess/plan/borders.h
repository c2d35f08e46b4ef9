#pragma once
// The facts that neighbouring patches share along their borders, whatever the tolerance is.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tess/edges/edge_directions.h"
#include "tess/edges/shared_edges.h"
#include "tess/edges/weld.h"
#include "tess/plan/cut_faces.h"
#include "tess/plan/patch_needs.h"

namespace tessera { inline namespace abi_0_1 {

/// The edges that borders share, the borders that are welded, and the shapes that patches have then.
class Borders {
 public:
  Borders() = default;
  /// Welds the borders by the options of `needs`. `edges`: of the set, before welding; `faces`: without runs if edges
  /// of shapes stay open.
  Borders(const PatchNeeds& needs, SharedEdges edges, std::span<const std::uint32_t> only_borders,
          const CutFaces& faces);

  const SharedEdges& edges() const { return edges_; }  ///< after welding
  const Weld& weld() const { return weld_; }
  /// The shapes by which patches are divided: those after welding; cut patches have no area.
  std::span<const PatchShape> shapes(const PatchNeeds& needs) const {
    return !weld_.shapes.empty() ? weld_.shapes : drawn_.empty() ? needs.shapes() : drawn_;
  }
  /// Groups of edges that should have as many segments, because they lie along one edge of a shape.
  std::span<const std::vector<std::uint32_t>> in_step() const { return in_step_; }
  /// Returns the directions of borders along their edges. The set must be as it was when the edges were found.
  EdgeDirections directions(const PatchNeeds& needs) const {
    return {needs.set(), edges_, weld_, shapes(needs), needs.shapes()};
  }
  /// Finds the directions at the set's present revision, for against(). Returns whether each edge is one still: edits
  /// may have moved its borders apart.
  bool follow(const PatchNeeds& needs);
  /// Returns for each border whether it runs against the leading border of its edge. Requires that each edge is one.
  std::vector<std::uint8_t> against(const PatchNeeds& needs) const;

 private:
  void weld_by(const PatchNeeds& needs, std::span<const std::uint32_t> only_borders, const EdgeRuns* runs);
  /// `pairs`: as CutFaces::borders_in_step has them.
  void find_in_step(std::span<const std::array<std::uint32_t, 2>> pairs);

  SharedEdges edges_;
  Weld weld_;
  std::vector<PatchShape> drawn_;  ///< `[patch]`: cut ones are curves; empty if no patch is cut
  std::vector<std::vector<std::uint32_t>> in_step_;
  /// Made by follow().
  struct Directions {
    std::uint64_t revision = 0;
    bool hold = false;
    std::vector<std::uint8_t> against;
  };
  std::optional<Directions> known_;
};

}}  // namespace tessera::abi_0_1
