#pragma once
// A BVH of boxes whose insides somebody else knows. Embree's types stay in embree_boxes.cpp.

#include <memory>
#include <vector>

#include "base/function_ref.h"
#include "ray/ray_line.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera {

/// Owns device, scene and geometry. Const calls from any number of threads, each inside a FlushDenormals
/// (embree_scene.h).
class EmbreeBoxes {
 public:
  /// Errors: internal and out_of_memory, from Embree.
  static Result<EmbreeBoxes> make();
  EmbreeBoxes(EmbreeBoxes&&) noexcept;
  EmbreeBoxes& operator=(EmbreeBoxes&&) noexcept;
  ~EmbreeBoxes();

  /// Boxes within [-1,1]^3. On errors there are none. Errors: cancelled, Embree's own.
  Status build(std::vector<Box3> boxes, const Execution& execution);

  /// Calls `visit` for each box that the line meets and perhaps others, the nearer ones rather first. It returns the s up
  /// to which boxes are still of interest; minus infinity ends the visits. The line must not be empty.
  using Visit = FunctionRef<double(unsigned box)>;
  void visit(const RayLine& line, Visit visit) const;

  /// What Embree has allocated, and the boxes.
  std::size_t memory_bytes() const;

 private:
  struct State;
  explicit EmbreeBoxes(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tessera
