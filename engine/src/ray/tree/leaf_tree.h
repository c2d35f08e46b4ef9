#pragma once
// The tree over the pieces of patches of an exact scene.

#include <cstddef>
#include <span>

#include "ray/leaf/leaf_search.h"
#include "ray/leaf/leaf_tracer.h"
#include "ray/line/ray_query.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Const calls from any number of threads, each with a search space of its own and inside a FlushDenormals.
class LeafTree {
 public:
  static constexpr std::size_t packet = QueryPacket::size;

  virtual ~LeafTree() = default;

  /// Builds the tree, in the caller's arena. Everything that `leaves` refers to must stay in place, and must not change
  /// while the tree is used, except borders, which may be found meanwhile. `follows`: refit() will be called; otherwise
  /// the nets' boxes may be dropped afterwards. On errors the tree is empty. Errors: cancelled, unsupported,
  /// out_of_memory, Embree's own.
  virtual Status build(const TracedLeaves& leaves, bool follows, const Execution& execution) = 0;
  /// Fits the tree's boxes to those of the nets. Leaves that were cut away at the build stay so. After an error the
  /// tree is empty. Errors: as above.
  virtual Status refit(double tolerance, const Execution& execution) = 0;

  /// Runs the query against all leaves that its line meets. The line must not be empty.
  virtual void trace(RayQuery& query, SearchSpace& space) const = 0;
  /// Runs 1 to `packet` queries for the same kind of roots; faster than one by one if they are coherent.
  virtual void trace(std::span<RayQuery* const> queries, SearchSpace& space) const = 0;

  /// Returns the tracer of the leaves that were built.
  virtual const LeafTracer& tracer() const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

}}  // namespace tessera::abi_0_1
