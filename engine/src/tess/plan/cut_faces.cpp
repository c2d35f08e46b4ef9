#include "tess/plan/cut_faces.h"

#include "block/patch_edges.h"
#include "block/patch_trims.h"

namespace tessera { inline namespace abi_0_1 {

CutFaces CutFaces::of(const PatchSet::Impl& set, bool closes_edges) {
  CutFaces made;
  if (set.edges && closes_edges) made.runs.emplace(set);
  if (!set.trims) return made;
  for (const TrimRegion& region : set.trims->regions) made.sides.emplace_back(region);
  if (!made.runs) return made;
  std::vector<std::uint8_t> is_of_face(set.patches.size(), 0);
  for (const PatchEdges::Face& face : set.edges->faces)
    for (const std::uint32_t patch : face.patches)
      if (patch != no_id) is_of_face[patch] = 1;
  for (const PatchTrims::Cut& cut : set.trims->cuts) made.names_edges.push_back(is_of_face[cut.patch]);
  return made;
}

}}  // namespace tessera::abi_0_1
