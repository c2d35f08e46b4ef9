#pragma once
// The tree over the boxes of instances, whose contents the caller traces.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "ray/line/ray_line.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Const calls from any number of threads, each inside a FlushDenormals.
class InstanceTree {
 public:
  static constexpr std::size_t packet = 16;

  virtual ~InstanceTree() = default;

  /// Builds the tree of boxes within [-1,1]^3. On errors there are none. Errors: cancelled, unsupported, out_of_memory,
  /// Embree's own.
  virtual Status build(std::vector<Box3> boxes, const Execution& execution) = 0;

  /// Calls visit(box, lanes, ends) for each box that some of the lines meet, and perhaps for others, roughly from near
  /// to far. The lines' bits are set in `lanes`. For each line the call sets the s up to which boxes are still of
  /// interest; minus infinity ends the visits. `lines` is one line or a packet of coherent ones; none may be empty.
  using Visit = FunctionRef<void(unsigned box, unsigned lanes, std::array<double, packet>& ends)>;
  virtual void visit(std::span<const RayLine* const> lines, Visit visit) const = 0;

  virtual std::size_t memory_bytes() const = 0;
};

}}  // namespace tessera::abi_0_1
