#pragma once
// The edges of a set on one thread.

#include "base/impl_access.h"
#include "tess/edges/shared_edges.h"

namespace tessera::test {

inline SharedEdges edges_of_set(const PatchSet& set) {
  const PatchSet::Impl& patches = impl_of(set);
  BorderHashes hashes(patches);
  for (std::size_t block = 0; block < patches.lane_counts.size(); ++block) hashes.find(patches, block);
  return {patches, hashes};
}

}  // namespace tessera::test
