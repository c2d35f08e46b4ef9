#pragma once
// How far apart patches and their triangles can lie in a camera's picture.
//
// In the camera's axes, x to the right, y up and z deep, a point is seen at f (x, y) / z pixels: so the picture of a patch with
// points (x, y, z) and weights w is the rational patch in the plane with points f (x, y) / z and weights w z, and since
// flat triangles become flat ones, ChordBound of that patch bounds distances in the picture: sixteen patches at a time, in
// float, relative to the middle of each; one by one where that is too rough. A point p that lies within
// d of q is seen within
//   |f p / z_p - f q / z_q| = f |(p - q)_xy - q_xy / z_q (p - q)_z| / z_p <= f d sqrt(1 + |q_xy / z_q|^2) / z_p.
// That serves roundings; and patches whose hull comes too near to the eye, or behind it: from the depth at which anything of
// them is seen it says to which distance in space they must be kept.

#include <array>
#include <limits>
#include <optional>

#include "block/patch_set_impl.h"
#include "tess/bounds/chord_bound.h"
#include "tessera/status.h"
#include "tessera/tessellation.h"

namespace tessera::inline abi_0_1 {

/// A checked view.
class Camera {
 public:
  /// Errors: invalid_argument (not finite, eye and target in one place, field of view, extent, size or near distance out of
  /// range).
  static Result<Camera> make(const View& view);

  bool orthographic() const { return orthographic_; }
  double focal() const { return focal_; }  ///< pixels per unit of x / z; orthographic: per length
  double nearest() const { return near_; }
  /// f sqrt(1 + |q_xy / z_q|^2) at the frame's corners.
  double steepest() const;
  /// In the camera's axes.
  Vec3 local(const Vec3& p) const;
  /// How far a point given in the camera's axes lies outside the frame or before the near plane, by the plane
  /// 0 .. plane_count - 1; negative inside.
  double outside(const Vec3& p, int plane) const;
  int plane_count() const { return orthographic_ ? 4 : 5; }

 private:
  Camera() = default;
  Vec3 eye_, right_, up_, forward_;
  double focal_ = 1, near_ = 0;
  double half_width_ = 1, half_height_ = 1;  ///< of the frame: tangents, or lengths
  bool orthographic_ = false;
};

/// One patch in a picture. Those none of which is in the frame are not seen, and keep any tolerance.
class ScreenSpaceBound {
 public:
  ScreenSpaceBound() = default;  ///< of one that is not seen
  /// `moved`: how far vertices and surfaces may lie beside the patch; `pixels` > 0: what is to be kept.
  ScreenSpaceBound(const Camera& camera, const BezierPatch& patch, double moved, double pixels);
  /// Those of a block's patches, at their places in `pictures`; `moved` by lane.
  static void find(const Camera& camera, const PatchSet::Impl& set, std::size_t block,
                   const std::array<double, PatchSet::lanes>& moved, double pixels, ScreenSpaceBound* pictures);

  /// The patch in the plane, in pixels, where that is what bounds it.
  std::optional<ChordBound> projected() const {
    return projected_ ? std::optional(ChordBound(*projected_)) : std::nullopt;
  }
  /// What of the pixels goes to `moved`; 0 if it isn't projected.
  double moved_pixels() const { return moved_pixels_; }
  /// The distance in space to be kept, all in all; infinite if it is projected, or not seen.
  double distance() const { return distance_; }
  /// What the rates keep in pixels, being within `distance` in space all in all.
  double pixels(Rates rates, double distance) const;

 private:
  void bound_by_depth(const Camera& camera, const BezierPatch& patch, double moved, double pixels);
  void allow_for(const Camera& camera, double moved, double shallowest, double size);

  std::optional<ChordBound::PlainPieces> projected_;
  double moved_pixels_ = 0;
  double distance_ = std::numeric_limits<double>::infinity();
  double steepest_ = 0, depth_ = 0;  ///< of what is bounded by depth; 0 where it is not seen
};

}  // namespace tessera::inline abi_0_1
