#pragma once
// A BVH of boxes whose contents the caller traces. Embree's types stay in embree_boxes.cpp.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "ray/line/ray_line.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Owns device, scene and geometry. Const calls from any number of threads, each inside a FlushDenormals
/// (embree_scene.h).
class EmbreeBoxes {
 public:
  /// Errors: internal and out_of_memory, from Embree.
  static Result<EmbreeBoxes> make();
  EmbreeBoxes(EmbreeBoxes&&) noexcept;
  EmbreeBoxes& operator=(EmbreeBoxes&&) noexcept;
  ~EmbreeBoxes();

  /// Builds the BVH of boxes within [-1,1]^3. On errors there are none. Errors: cancelled, Embree's own.
  Status build(std::vector<Box3> boxes, const Execution& execution);

  static constexpr std::size_t packet = 16;

  /// Calls visit(box, lanes, ends) for each box that some of the lines meet, and perhaps for others, roughly from near
  /// to far. The lines' bits are set in `lanes`. For each line the call sets the s up to which boxes are still of
  /// interest; minus infinity ends the visits. `lines` is one line or a packet of coherent ones; none may be empty.
  using Visit = FunctionRef<void(unsigned box, unsigned lanes, std::array<double, packet>& ends)>;
  void visit(std::span<const RayLine* const> lines, Visit visit) const;

  /// Returns the bytes that Embree has allocated, and those of the boxes.
  std::size_t memory_bytes() const;

 private:
  struct State;
  explicit EmbreeBoxes(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}}  // namespace tessera::abi_0_1
