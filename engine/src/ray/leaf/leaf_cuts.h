#pragma once
// Cuts of patches into the pieces that exact rays are traced against.

#include <cstddef>
#include <vector>

#include "ray/line/ray_line.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The number of halvings of a patch along each direction.
struct Cuts {
  int u = 0, v = 0;
  std::size_t pieces() const { return std::size_t{1} << (u + v); }
};

/// Writes the homogeneous coefficients w (x, y, z), w of the patch in the scene's coordinates, `[component][i][j]`.
/// Polynomial patches have no w; otherwise the largest weight is scaled by a power of two to [1, 2).
void write_patch(const BezierPatch& patch, const SceneFrame& frame, double* net);

/// A patch in pieces that are halved repeatedly. Memory is reused from patch to patch.
class LeafCutter {
 public:
  explicit LeafCutter(const SceneFrame& frame) : frame_(&frame) {}

  /// Starts with the whole patch, which must live until the next start.
  void start(const BezierPatch& patch);
  /// Halves as often as `cuts` says, first along u.
  void cut(const Cuts& cuts);
  /// Cuts the patch into at least 2^halvings pieces per side:
  /// - more along sides that are strongly bent or much longer than the others;
  /// - then until nine pieces in ten keep `max_bend`, the share of its length by which a piece leaves its tangent
  ///   plane.
  ///
  /// Pieces next to poles do not count if there are others.
  Cuts flatten(int halvings, double max_bend);

  /// Returns the net of piece `across * 2^cuts.v + along`; the next one follows after `values()`.
  const double* net(std::size_t piece) const { return nets_.data() + piece * values(); }
  /// Returns the net of a rectangle within that piece, in the patch's parameters, until the next call.
  const double* part_of(std::size_t piece, const Domain& rectangle);
  std::size_t values() const { return patch_->points().size() * (patch_->is_rational() ? 4 : 3); }

 private:
  void halve(bool along_u);
  bool bends(double max_bend, bool& along_u) const;

  const SceneFrame* frame_;
  const BezierPatch* patch_ = nullptr;
  Cuts cuts_;
  std::vector<double> nets_, halves_, part_;
};

}}  // namespace tessera::abi_0_1
