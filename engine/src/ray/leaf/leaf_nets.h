#pragma once
// The pieces of patches that exact rays are traced against: float leaves for the kernels, and on request control nets
// in the scene's coordinates.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "kernel/ray/ray_kernels.h"
#include "ray/line/ray_line.h"
#include "ray/line/set_view.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Steps of Newton's method, in a patch's parameters, up to which the surface equals its tangent plane within rounding.
constexpr double linear_step = 1e-9;

/// A piece [u0, u0 + du] x [v0, v0 + dv] of a patch. The sums are exact.
struct Leaf {
  std::uint32_t patch = 0;
  std::uint8_t degree_u = 0, degree_v = 0;
  bool rational = false;
  bool is_shrunk = false;                          ///< a part of what halvings give: see leaf_trims.h
  std::uint8_t halvings_u = 0, halvings_v = 0;     ///< from the patch to the piece, or to what it is a part of
  float linear = static_cast<float>(linear_step);  ///< linear_step, or less where weights differ
  double u0 = 0, v0 = 0, du = 1, dv = 1;
  const Vec3* points = nullptr;  ///< of the patch when the piece was made: only for prefetching

  int size() const { return (degree_u + 1) * (degree_v + 1); }
  int components() const { return rational ? 4 : 3; }
  /// Returns the rounding of its net (LeafNets::write_net), in halvings.
  int halvings() const;
  static constexpr int max_halvings = 6;  ///< upper bound of halvings()
};

/// The flatness that pieces must have.
struct Flatness {
  int halvings = 0;     ///< minimum for each side
  double max_bend = 1;  ///< see LeafCutter::flatten
};

struct Cuts;
class LeafCutter;

class LeafNets {
 public:
  /// Cuts every patch by itself, so that the pieces are nearly flat and roughly square. Only leaves() may then be
  /// used, until make(). Errors: cancelled, out_of_memory.
  Status plan(const SetView& set, const SceneFrame& frame, const Flatness& flatness, const Execution& execution);
  /// The leaves before make(), which may be shrunk.
  std::span<Leaf> planned() { return leaves_; }
  /// Makes the pieces and their boxes. Errors: as above.
  Status make(const SetView& set, const Execution& execution);
  /// Makes the pieces of these patches again, with their boxes, which must not have been dropped. The cuts stay those
  /// of plan(), however the patches bend now. After an error some pieces are not updated. Errors: cancelled,
  /// out_of_memory.
  Status update(const SetView& set, std::span<const std::uint32_t> patches, const Execution& execution);

  std::span<const Leaf> leaves() const { return leaves_; }
  const kernel::RayLeaf& local(std::size_t leaf) const {
    return *reinterpret_cast<const kernel::RayLeaf*>(local_.data() + leaf * local_bytes_);
  }
  /// Returns the boxes of the control points, one per leaf, until they are dropped. A piece lies in its box except for
  /// rounding.
  std::span<const Box3> boxes() const { return boxes_; }
  void drop_boxes() { boxes_ = std::vector<Box3>(); }  // a list in braces would keep the memory
  /// Writes the piece's part of write_patch(). `other`, of the same size, is overwritten. `set`: as it was built from.
  void write_net(const SetView& set, const Leaf& leaf, double* net, double* other) const;
  const SceneFrame& frame() const { return frame_; }
  /// Returns the number of values in the largest net.
  std::size_t largest() const { return largest_; }
  std::size_t memory_bytes() const {
    return leaves_.capacity() * sizeof(Leaf) + boxes_.capacity() * sizeof(Box3) + local_.capacity();
  }

 private:
  std::size_t first_leaf(std::uint32_t patch) const;
  void set_leaves(const BezierPatch& patch, std::uint32_t index, const Cuts& cuts, std::size_t first);
  void cut(const BezierPatch& patch, std::uint32_t index, LeafCutter& cutter);

  SceneFrame frame_;
  std::vector<Leaf> leaves_;
  std::vector<Box3> boxes_;
  UnsetVector<std::byte> local_;
  std::size_t local_bytes_ = 0;
  std::size_t largest_ = 0;
};

}}  // namespace tessera::abi_0_1
