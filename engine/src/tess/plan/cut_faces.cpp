#include "tess/plan/cut_faces.h"

#include "block/patch_edges.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {

Result<CutFaces> CutFaces::of(const PatchSet::Impl& set, bool closes_edges, const Execution& execution) {
  constexpr std::size_t regions_per_task = 8;
  CutFaces made;
  if (set.edges && closes_edges) {
    made.runs.emplace(set);
    made.borders_in_step = made.runs->borders_in_step(set);
  }
  if (!set.trims) return made;
  made.sides.resize(set.trims->regions.size());
  const auto find_sides = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) made.sides[k] = FaceSides(set.trims->regions[k]);
  };
  if (Status status = parallel_for(made.sides.size(), regions_per_task, execution, find_sides); !status.ok())
    return status;
  if (!made.runs) return made;
  std::vector<std::uint8_t> is_of_face(set.patches.size(), 0);
  for (const PatchEdges::Face& face : set.edges->faces)
    for (const std::uint32_t patch : face.patches)
      if (patch != no_id) is_of_face[patch] = 1;
  for (const PatchTrims::Cut& cut : set.trims->cuts) made.names_edges.push_back(is_of_face[cut.patch]);
  return made;
}

}}  // namespace tessera::abi_0_1
