#pragma once
// Where patches are cut into the pieces that exact rays are traced against.

#include <cstddef>
#include <vector>

#include "ray/line/ray_line.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// How often a patch is halved along each direction.
struct Cuts {
  int u = 0, v = 0;
  std::size_t pieces() const { return std::size_t{1} << (u + v); }
};

/// Homogeneous coefficients w (x, y, z), w of the patch in the scene's coordinates, `[component][i][j]`; w is left out of
/// polynomial patches, else the largest weight is scaled by a power of two to [1, 2).
void write_patch(const BezierPatch& patch, const SceneFrame& frame, double* net);

/// A patch in pieces, which are halved on and on. Memory is used again from patch to patch.
class PatchCutter {
 public:
  explicit PatchCutter(const SceneFrame& frame) : frame_(&frame) {}

  /// The whole patch, which must stay until the next.
  void start(const BezierPatch& patch);
  /// Halves so often, first along u.
  void cut(const Cuts& cuts);
  /// Cuts it into at least 2^halvings pieces a side: more along sides that are strongly bent or much longer than the others,
  /// and then until nine pieces in ten keep `max_bend`, the share of its length by which a piece leaves its tangent plane.
  /// Pieces next to poles
  /// do not count where there are others.
  Cuts flatten(int halvings, double max_bend);

  /// By `across * 2^cuts.v + along`; the next follows after `values()`.
  const double* net(std::size_t piece) const { return nets_.data() + piece * values(); }
  std::size_t values() const { return patch_->points().size() * (patch_->is_rational() ? 4 : 3); }

 private:
  void halve(bool along_u);
  bool bends(double max_bend, bool& along_u) const;

  const SceneFrame* frame_;
  const BezierPatch* patch_ = nullptr;
  Cuts cuts_;
  std::vector<double> nets_, halves_;
};

}  // namespace tessera::inline abi_0_1
