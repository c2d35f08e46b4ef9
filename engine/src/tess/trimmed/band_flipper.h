#pragma once
// Turns the edges of a cut patch's band, so that its triangles face as the surface does.

#include <atomic>
#include <cstdint>
#include <vector>

#include "base/function_ref.h"
#include "plane/band_mesh.h"
#include "tess/trimmed/patch_points.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Flips edges between pairs of triangles where one of them is turned far from its surface: needles along loops, whose
/// corners lie on one curve. Distances do not show these.
///
/// The tilt of a triangle: 1 - cos of the angle between it and the mean of the surface's normals at its corners.
class BandFlipper {
 public:
  using Triangle = BandMesh::Triangle;

  /// `points`: of the patch. `vertices`: in the patch's own parameters. All must outlive this object.
  BandFlipper(PatchPoints& points, const std::vector<ParameterPoint>& vertices)
      : points_(points), vertices_(vertices), places_(vertices.size()) {}

  /// Flips edges of the triangles from `first` on while that lowers the larger tilt of two triangles, where it is above
  /// 1 - cos(30 degrees). Triangles stay counter-clockwise in the parameters. `may_flip`: whether two triangles may be
  /// replaced by two others. `cancel`: looked at for each triangle, unless null; if cancelled, it stops.
  ///
  /// It ends: the list of all tilts, the largest first, gets smaller with each flip, and there are finitely many
  /// triangulations.
  void run(
      std::vector<Triangle>& triangles, std::size_t first,
      FunctionRef<bool(const Triangle& a, const Triangle& b, const Triangle& new_a, const Triangle& new_b)> may_flip,
      const std::atomic<bool>* cancel);

 private:
  struct Place {
    Vec3 position, normal;
    bool is_known = false;
  };
  const Place& place(std::uint32_t vertex);
  double tilt(const Triangle& triangle);
  bool is_ccw(const Triangle& triangle) const;

  PatchPoints& points_;
  const std::vector<ParameterPoint>& vertices_;
  std::vector<Place> places_;  ///< by vertex
  BandMesh mesh_;
};

}}  // namespace tessera::abi_0_1
