#include "tess/plan/plan_facts.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The facts that loops and borders state, whatever the bounds are.
struct EdgesAndFaces {
  SharedEdges edges;                        ///< before welding
  std::vector<std::uint32_t> only_borders;  ///< see WeldRules
  CutFaces faces;
};

/// Bounds all blocks, and finds the edges and cut faces of the set.
Result<EdgesAndFaces> bound_and_find_edges(PatchNeeds& needs, const Execution& execution) {
  const PatchSet::Impl& set = needs.set();
  const Execution quiet{.cancel = execution.cancel};
  const std::size_t blocks = set.lane_counts.size();
  BorderHashes hashes(set);
  const auto hash = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) hashes.find(set, block);
  };
  Status status = parallel_for(blocks, 4 * blocks_per_task, quiet, hash);
  if (!status.ok()) return status;
  SharedEdges edges;
  std::vector<std::uint32_t> only_borders;
  std::optional<Result<CutFaces>> faces;
  // One thread finds the edges, one after the other, and one follows the loops, while the others find the bounds.
  const std::size_t patches = keeps_turnings(needs.options()) ? set.patches.size() : 0,
                    normals = (patches + normals_per_task - 1) / normals_per_task;
  const auto find_or_bound = [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece)
      if (piece == 0)
        edges = SharedEdges(set, hashes, &only_borders);
      else if (piece == 1)
        faces = CutFaces::of(set, needs.options().closes_edges, quiet);
      else if (piece < blocks + 2)
        needs.bound_block(piece - 2);
      else
        for (std::size_t k = (piece - blocks - 2) * normals_per_task;
             k < std::min(patches, (piece - blocks - 1) * normals_per_task); ++k)
          needs.bound_turning(k);
  };
  status = parallel_for(2 + blocks + normals, 1, execution, find_or_bound);
  if (!status.ok()) return status;
  if (!*faces) return faces->status();
  return EdgesAndFaces{std::move(edges), std::move(only_borders), **std::move(faces)};
}

}  // namespace

Result<PlanFacts> find_plan_facts(const PatchSet::Impl& set, const PlannerOptions& options,
                                  const Execution& execution) {
  PlanFacts facts{PatchNeeds(set, options), {}, {}};
  Result<EdgesAndFaces> found = bound_and_find_edges(facts.needs, execution);
  if (!found) return found.status();
  facts.faces = std::move(found->faces);
  facts.borders = Borders(facts.needs, std::move(found->edges), found->only_borders, facts.faces);
  facts.needs.take_weld(facts.borders.weld());
  if (Status status = facts.needs.bound_views(execution); !status.ok()) return status;
  return facts;
}

}}  // namespace tessera::abi_0_1
