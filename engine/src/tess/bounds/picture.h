#pragma once
// Bounds how far apart patches and their triangles can lie in a camera's picture.
//
// 1. In the camera's axes, x to the right, y up and z deep, a point is seen at f (x, y) / z pixels. So the picture of a
//    patch with points (x, y, z) and weights w is the rational patch in the plane with points f (x, y) / z and weights
//    w z.
// 2. Flat triangles become flat ones, so ChordBound of that plane patch bounds distances in the picture. It is found
//    for sixteen patches at a time, in float, relative to the middle of each; and one by one where that is too rough.
// 3. A point p that lies within d of q is seen within
//      |f p / z_p - f q / z_q| = f |(p - q)_xy - q_xy / z_q (p - q)_z| / z_p <= f d sqrt(1 + |q_xy / z_q|^2) / z_p
//    of it. This bounds roundings. It also serves patches whose hull comes too near to the eye, or behind it: the least
//    depth at which anything of them is seen gives the distance in space that they must keep.

#include <array>
#include <limits>
#include <optional>

#include "block/patch_set_impl.h"
#include "tess/bounds/chord_bound.h"
#include "tessera/status.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// A View whose numbers have been checked, with the camera's axes.
class Camera {
 public:
  /// Checks a view. Errors: invalid_argument (numbers that are not finite; eye and target in one place; field of view,
  /// extent, size or near distance out of range).
  static Result<Camera> make(const View& view);

  bool orthographic() const { return orthographic_; }
  double focal() const { return focal_; }  ///< pixels per unit of x / z; orthographic: per length
  double nearest() const { return near_; }
  /// Returns f sqrt(1 + |q_xy / z_q|^2) at the frame's corners.
  double steepest() const;
  /// Returns a point in the camera's axes.
  Vec3 local(const Vec3& p) const {
    const Vec3 from = p - eye_;
    return {dot(from, right_), dot(from, up_), dot(from, forward_)};
  }
  /// Returns how far a point in the camera's axes lies outside of plane 0 .. plane_count() - 1, which are those of the
  /// frame's sides and the near plane; negative inside.
  double outside(const Vec3& p, int plane) const {
    if (plane == 4) return near_ - p.z;
    const double half = plane < 2 ? half_width_ : half_height_, along = plane < 2 ? p.x : p.y;
    const double side = plane % 2 == 0 ? along : -along;
    return orthographic_ ? side - half : (side - half * p.z) * (plane < 2 ? lean_x_ : lean_y_);
  }
  int plane_count() const { return orthographic_ ? 4 : 5; }

 private:
  Camera() = default;
  Vec3 eye_, right_, up_, forward_;
  double focal_ = 1, near_ = 0;
  double half_width_ = 1, half_height_ = 1;  ///< half the frame's size: tangents, or lengths
  double lean_x_ = 1, lean_y_ = 1;           ///< cosines between the frame's planes and the line of sight
  bool orthographic_ = false;
};

/// The bound of one patch in a picture. A patch that lies outside the frame is not seen, and keeps any tolerance.
class ScreenSpaceBound {
 public:
  ScreenSpaceBound() = default;  ///< bounds a patch that is not seen
  /// `moved`: how far vertices and surface may lie beside the patch; `pixels` > 0: the tolerance.
  ScreenSpaceBound(const Camera& camera, const BezierPatch& patch, double moved, double pixels);
  /// Finds the bounds of a block's patches and writes them to `pictures` by patch; `moved` is by lane.
  static void find(const Camera& camera, const PatchSet::Impl& set, std::size_t block,
                   const std::array<double, PatchSet::lanes>& moved, double pixels, ScreenSpaceBound* pictures);

  /// Returns the chord bound of the patch in the plane, in pixels; empty if the patch is bounded by its distance in
  /// space.
  std::optional<ChordBound> projected() const {
    return projected_ ? std::optional(ChordBound(*projected_)) : std::nullopt;
  }
  /// Returns the part of the pixels that `moved` takes; 0 if the patch isn't projected.
  double moved_pixels() const { return moved_pixels_; }
  /// Returns the total distance in space to keep; infinite if the patch is projected, or not seen.
  double distance() const { return distance_; }
  /// Returns the pixels that segments keep, with the total distance `distance` in space. `projected`: projected().
  double pixels(const std::optional<ChordBound>& projected, PatchSegments segments, double distance) const;
  double pixels(PatchSegments segments, double distance) const { return pixels(projected(), segments, distance); }

 private:
  void bound_by_depth(const Camera& camera, const BezierPatch& patch, double moved, double pixels);
  void allow_for(const Camera& camera, double moved, double shallowest, double size);

  std::optional<ChordBound::PlainPieces> projected_;
  double moved_pixels_ = 0;
  double distance_ = std::numeric_limits<double>::infinity();
  double steepest_ = 0, depth_ = 0;  ///< for patches bounded by depth; the depth is 0 where nothing is seen
};

}}  // namespace tessera::abi_0_1
