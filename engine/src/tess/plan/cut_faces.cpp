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
  std::vector<std::uint32_t> faces(set.patches.size(), no_id);
  for (std::uint32_t face = 0; face < set.edges->faces.size(); ++face)
    for (const std::uint32_t patch : set.edges->faces[face].patches)
      if (patch != no_id) faces[patch] = face;
  for (const PatchTrims::Cut& cut : set.trims->cuts) made.of_cuts.push_back(faces[cut.patch]);
  return made;
}

}}  // namespace tessera::abi_0_1
