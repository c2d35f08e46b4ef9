#pragma once
// Newton's method in double, from a facet that a ray hit to the true surface.

#include "ray/border/adjacency.h"
#include "ray/line/ray_segment.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// A point r(u,v) of the surface and its distance from a ray; a root if the residual is rounding.
struct SurfaceRoot {
  std::uint32_t patch = 0;
  double u = 0, v = 0;
  double s = 0;   ///< arc length along the segment to the position's foot on the ray
  Vec3 position;  ///< absolute
  Vec3 du, dv;
  double residual = 0;  ///< distance from the position to the ray
};

/// Moves hits onto the surface of one patch set.
class Refiner {
 public:
  /// `reach`: how far a root may lie from its facet, in parameters. The adjacency must outlive this. `box`: the set's.
  Refiner(const SetView& set, const Adjacency& adjacency, const Box3& box, double reach);

  /// Finds the root near (u,v) on `patch` or, if it lies across a border, on the patches behind. Returns false if there
  /// is none within a few grid cells: the ray grazes the surface, or the surface is too crooked for its grid.
  bool refine(const RaySegment& segment, std::uint32_t patch, double u, double v, SurfaceRoot& root) const;

  /// Evaluates position and derivatives at (u,v), with s and residual towards the segment. Returns false where there
  /// are none (first_order.h).
  bool evaluate(const RaySegment& segment, std::uint32_t patch, double u, double v, SurfaceRoot& root) const;

  /// Returns the residual up to which a point of the surface counts as a root.
  double tolerance() const { return tolerance_; }

 private:
  enum class Outcome { inside, outside, failed };
  struct Leash;
  class Frontier;

  Leash leash(std::uint32_t patch, double u, double v) const;
  Outcome newton(const RaySegment& segment, SurfaceRoot& root) const;
  bool descend(const RaySegment& segment, const Leash& leash, SurfaceRoot& root) const;
  bool inside(const RaySegment& segment, SurfaceRoot& root) const;
  void push_neighbours(const SurfaceRoot& root, Frontier& frontier) const;

  SetView set_;
  const Adjacency& adjacency_;
  double cells_;     ///< limit of the iterates' distance from the start, in parameters
  double rounding_;  ///< the smallest residual that rounding allows
  double tolerance_;
};

}}  // namespace tessera::abi_0_1
