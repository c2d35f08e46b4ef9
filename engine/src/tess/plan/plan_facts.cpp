#include "tess/plan/plan_facts.h"

#include <algorithm>

#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Bounds all blocks and returns the edges of the set, before welding.
Result<SharedEdges> bound_and_find_edges(PatchNeeds& needs, const Execution& execution) {
  const PatchSet::Impl& set = needs.set();
  const std::size_t blocks = set.lane_counts.size();
  BorderHashes hashes(set);
  const auto hash = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) hashes.find(set, block);
  };
  Status status = parallel_for(blocks, 4 * blocks_per_task, {.cancel = execution.cancel}, hash);
  if (!status.ok()) return status;
  SharedEdges edges;
  // One thread finds the edges, one after the other, while the others find the bounds.
  const std::size_t patches = keeps_turnings(needs.options()) ? set.patches.size() : 0,
                    normals = (patches + normals_per_task - 1) / normals_per_task;
  const auto find_or_bound = [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece)
      if (piece == 0)
        edges = SharedEdges(set, hashes);
      else if (piece <= blocks)
        needs.bound_block(piece - 1);
      else
        for (std::size_t k = (piece - blocks - 1) * normals_per_task;
             k < std::min(patches, (piece - blocks) * normals_per_task); ++k)
          needs.bound_turning(k);
  };
  status = parallel_for(1 + blocks + normals, 1, execution, find_or_bound);
  if (!status.ok()) return status;
  return edges;
}

}  // namespace

Result<PlanFacts> find_plan_facts(const PatchSet::Impl& set, const PlannerOptions& options,
                                  const Execution& execution) {
  PlanFacts facts{PatchNeeds(set, options), {}, {}};
  Result<SharedEdges> edges = bound_and_find_edges(facts.needs, execution);
  if (!edges) return edges.status();
  Result<CutFaces> faces = CutFaces::of(set, options.closes_edges, {.cancel = execution.cancel});
  if (!faces) return faces.status();
  facts.faces = *std::move(faces);
  facts.borders = Borders(facts.needs, *std::move(edges), facts.faces.runs ? &*facts.faces.runs : nullptr);
  facts.needs.take_weld(facts.borders.weld());
  if (Status status = facts.needs.bound_views(execution); !status.ok()) return status;
  return facts;
}

}}  // namespace tessera::abi_0_1
