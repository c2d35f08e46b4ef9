#pragma once
// One ray against one piece of a patch: the kernels in float first, then the search in double where they prove nothing.

#include <array>
#include <cstddef>

#include "kernel/ray/ray_kernels.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/leaf_search.h"
#include "ray/scene/ray_query.h"
#include "ray/scene/set_view.h"
#include "ray/seam/lazy_adjacency.h"

namespace tessera::inline abi_0_1 {

/// The ray of a query as kernels take it.
kernel::RayProbe probe_of(const RayQuery& query);

/// The queries of rays that are traced together, all for the closest or all for any root, and what kernels are told of them.
struct QueryPacket {
  static constexpr std::size_t size = kernel::RayPacket::size;

  std::array<RayQuery*, size> queries;  ///< null of idle lanes
  std::array<kernel::RayProbe, size> probes;
  kernel::RayPacket rays;
  kernel::PolishedRays polished;

  void set(std::size_t lane, RayQuery& query);
  void set_idle(std::size_t lane);
};

/// The pieces that are traced, and what they belong to.
struct TracedLeaves {
  const SetView* set = nullptr;
  const LeafNets* nets = nullptr;
  const LazyAdjacency* borders = nullptr;  ///< across which roots of rays that leave a surface are followed, once found
  std::size_t patches = 0;                 ///< those from here on are neighbours, whose roots count for all hits alone
  double tolerance = 0;                    ///< as asked for, in the scene's coordinates

  /// That of search_leaf: no less than rounding allows.
  double tolerance_of(const Leaf& leaf) const;
};

/// Refers to what it is made of. Const calls from any number of threads, each with a search space of its own.
struct LeafTracer final : OriginTest, TracedLeaves {
  const kernel::RayKernels* kernels = nullptr;

  /// Adds to the query what it wants of a leaf. `probe`: of the query, used again from leaf to leaf.
  void search(unsigned leaf, kernel::RayProbe& probe, RayQuery& query, SearchSpace& space) const;

  /// The same for the queries of a packet whose bits are set in `lanes`, each as if alone.
  void search(unsigned leaf, QueryPacket& packet, unsigned lanes, SearchSpace& space) const;

  /// spawn_root.h
  OriginRoot judge(const RayLine& line, const LeafRoot& root) const override;

 private:
  unsigned decide(unsigned leaf_index, QueryPacket& packet, unsigned lanes) const;
  unsigned take_roots(const Leaf& leaf, QueryPacket& packet, unsigned lanes) const;
  unsigned take_each_root(const Leaf& leaf, QueryPacket& packet, unsigned lanes) const;
  bool decide(const Leaf& leaf, unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query) const;
  bool take_roots(const Leaf& leaf, const kernel::RayRoots& roots, RayQuery& query) const;
};

}  // namespace tessera::inline abi_0_1
