#pragma once
// One ray or a packet against one piece of a patch: the float kernels first, then the search in double where these
// prove nothing.

#include <array>
#include <cstddef>

#include "kernel/ray/ray_kernels.h"
#include "ray/border/lazy_adjacency.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/leaf_search.h"
#include "ray/leaf/leaf_trims.h"
#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"
#include "ray/tube/edge_tubes.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the ray of a query in the kernels' form.
kernel::RayProbe probe_of(const RayQuery& query);

/// The queries of rays that are traced together, all for the closest or all for any root, and the kernels' inputs for
/// them.
struct QueryPacket {
  static constexpr std::size_t size = kernel::RayPacket::size;

  std::array<RayQuery*, size> queries;  ///< null in idle lanes
  std::array<kernel::RayProbe, size> probes;
  kernel::RayPacket rays;
  kernel::PolishedRays polished;

  void set(std::size_t lane, RayQuery& query);
  void set_idle(std::size_t lane);
};

/// The pieces that are traced, and the set and borders that they belong to.
struct TracedLeaves {
  const SetView* set = nullptr;
  const LeafNets* nets = nullptr;
  const LazyAdjacency* borders = nullptr;  ///< once found, roots of rays that leave a surface are followed across them
  std::size_t patches = 0;                 ///< patches from this index on are neighbours, whose roots count only for
                                           ///< all hits
  double tolerance = 0;                    ///< as requested, in the scene's coordinates
  const LeafTrims* trims = nullptr;        ///< null if no patch is cut
  const EdgeTubes* tubes = nullptr;        ///< their primitives follow those of the leaves
  unsigned first_tube = 0;                 ///< the number of leaves

  std::size_t primitives() const { return first_tube + tubes->count(); }

  /// What the loops of its face keep of a leaf.
  PatchUse use_of(unsigned leaf) const { return trims == nullptr ? PatchUse::whole : trims->use(leaf); }
  /// Returns the tolerance for search_leaf: at least what rounding requires.
  double tolerance_of(const Leaf& leaf) const;
};

/// Traces leaves and tubes; refers to the data that it is made of. Const calls from any number of threads, each with a
/// search space of its own.
struct LeafTracer final : OriginTest, TracedLeaves {
  const kernel::RayKernels* kernels = nullptr;

  /// Adds to the query the roots that it wants from a leaf or a tube. `probe` is the query's, reused from leaf to leaf.
  void search(unsigned leaf, kernel::RayProbe& probe, RayQuery& query, SearchSpace& space) const;

  /// Does so for the queries of a packet whose bits are set in `lanes`, each as if alone.
  void search(unsigned leaf, QueryPacket& packet, unsigned lanes, SearchSpace& space) const;

  /// Returns whether the patch exists, and (u,v) is in [0,1]^2.
  bool has(const LeftPoint& point) const;
  /// Returns a point of a patch, in the model's coordinates.
  Vec3 at(const LeftPoint& point) const;

  /// See spawn_root.h.
  OriginRoot decide_root(const RayLine& line, const LeafRoot& root) const override;

 private:
  void search_tube(unsigned tube, RayQuery& query) const;
  TrimSide side_of(const Leaf& leaf, const kernel::RayRoot& root) const;
  unsigned decide(unsigned leaf_index, QueryPacket& packet, unsigned lanes) const;
  /// The roots of a packet: bits of the rays that have one, and of those whose root is near a loop.
  struct PacketRoots {
    unsigned lanes = 0, near_loops = 0;
  };
  unsigned take_roots(const Leaf& leaf, QueryPacket& packet, const PacketRoots& roots) const;
  unsigned take_each_root(const Leaf& leaf, QueryPacket& packet, const PacketRoots& roots) const;
  bool take_gain(RayQuery& query, LeafRoot& root) const;
  bool decide(const Leaf& leaf, unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query) const;
  bool decide_any(const Leaf& leaf, const kernel::RayRoot& root, RayQuery& query) const;
  const OriginTest* origin_test(const kernel::RayRoot& root, const RayQuery& query) const;
  bool take_roots(const Leaf& leaf, const kernel::RayRoots& roots, RayQuery& query) const;
};

}}  // namespace tessera::abi_0_1
