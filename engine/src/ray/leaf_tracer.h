#pragma once
// One ray against one piece of a patch: the kernels in float first, then the search in double where they prove nothing.

#include "kernel/ray_kernels.h"
#include "ray/leaf_nets.h"
#include "ray/leaf_search.h"
#include "ray/ray_query.h"
#include "ray/set_view.h"

namespace tessera {

/// The ray of a query as kernels take it.
kernel::RayProbe probe_of(const RayQuery& query);
/// Its end, which comes nearer with each root.
float probe_far(const RayQuery& query);

/// Refers to what it is made of. Const calls from any number of threads, each with a search space of its own.
struct LeafTracer final : OriginTest {
  const SetView* set = nullptr;
  const LeafNets* nets = nullptr;
  const kernel::RayKernels* kernels = nullptr;
  double tolerance = 0;  ///< as of search_leaf

  /// Adds to the query what it wants of a leaf. `probe`: of the query, used again from leaf to leaf.
  void search(unsigned leaf, kernel::RayProbe& probe, RayQuery& query, SearchSpace& space) const;

  /// spawn_root.h
  OriginRoot judge(const RayLine& line, const LeafRoot& root) const override;

 private:
  bool decide(const Leaf& leaf, unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query) const;
};

}  // namespace tessera
