#pragma once
// Embree's side of an exact scene: the pieces of patches as primitives of a user geometry. Embree's types stay in
// embree_leaves.cpp.

#include <memory>
#include <span>

#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/leaf_search.h"
#include "ray/leaf/leaf_tracer.h"
#include "ray/line/ray_query.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Owns device, scene and geometry. Const calls from any number of threads, each with a search space of its own and
/// inside a FlushDenormals (embree_scene.h).
class EmbreeLeaves {
 public:
  static constexpr std::size_t packet = 16;

  /// `isa`: of this machine, for Embree as well. Errors: internal and out_of_memory, from Embree.
  static Result<EmbreeLeaves> make(Isa isa);
  EmbreeLeaves(EmbreeLeaves&&) noexcept;
  EmbreeLeaves& operator=(EmbreeLeaves&&) noexcept;
  ~EmbreeLeaves();

  /// Builds the BVH, in the caller's arena. Everything that `leaves` refers to must stay in place, and must not change
  /// while the scene is used, except borders, which may be found meanwhile. `follows`: refit() will be called;
  /// otherwise the nets' boxes may be dropped afterwards. On errors the scene is empty. Errors: cancelled, Embree's
  /// own.
  Status build(const TracedLeaves& leaves, bool follows, const Execution& execution);
  /// Refits the BVH to the boxes of the nets. After an error the scene is empty. Errors: as above.
  Status refit(double tolerance, const Execution& execution);

  /// Runs the query against all leaves that its line meets. The line must not be empty.
  void trace(RayQuery& query, SearchSpace& space) const;
  /// Runs up to a packet of queries for the same kind of roots; faster than one by one if they are coherent.
  void trace(std::span<RayQuery* const> queries, SearchSpace& space) const;

  /// Returns the tracer of the leaves that were built.
  const LeafTracer& tracer() const;
  /// Returns the bytes that Embree has allocated.
  std::size_t memory_bytes() const;

 private:
  struct State;
  explicit EmbreeLeaves(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}}  // namespace tessera::abi_0_1
