#pragma once
// Surfaces of CAD files that a profile sweeps, by turning or by moving straight on, as exact NURBS.

#include <array>
#include <optional>

#include "exact/arcs.h"
#include "exact/spline_line.h"
#include "exact/thinned_spline.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Maps parameters of a surface in a CAD file to ours.
struct Reparametrization {
  std::optional<Arcs> u, v;  ///< empty: equal parameters

  bool is_identity() const { return !u && !v; }
  std::array<double, 2> operator()(double theirs_u, double theirs_v) const {
    return {u ? u->parameter(theirs_u) : theirs_u, v ? v->parameter(theirs_v) : theirs_v};
  }
};

struct FaceSurface {
  BSplineSurface surface;
  Reparametrization parameters;
  double fit_error = 0;    ///< 0: exact
  SplineShift shift = {};  ///< what thin() has done
};

/// Orthogonal axes of unit length, left- or right-handed.
struct Frame {
  Vec3 origin, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Vec3 at(const Vec3& p) const { return origin + (p.x * x + p.y * y) + p.z * z; }
  Vec3 local(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {dot(d, x), dot(d, y), dot(d, z)};
  }
};

inline Interval range_u(const Domain& box) { return {box.u0, box.u1}; }
inline Interval range_v(const Domain& box) { return {box.v0, box.v1}; }

/// Adds the parameters to a surface. Errors: the surface's own.
Result<FaceSurface> with_parameters(Result<BSplineSurface> surface, const Reparametrization& parameters,
                                    double fit_error = 0);

/// Revolves `profile`, which runs along v with points in the frame's coordinates, about the frame's z by the angles u.
/// Errors of this and the following: those of BSplineSurface. Angles span at most 2 pi.
Result<FaceSurface> revolved(const Frame& frame, const Interval& angles, const SplineLine& profile);
/// Moves `profile`, which runs along u, by v times `direction`.
Result<FaceSurface> extruded(const SplineLine& profile, const Vec3& direction, const Interval& range);
/// The plane origin + u x + v y.
Result<FaceSurface> plane_surface(const Frame& frame, const Domain& box);
/// The cylinder of angles u and heights v.
Result<FaceSurface> cylinder_surface(const Frame& frame, double radius, const Domain& box);
/// The cone of angles u, with radius + v sin(half_angle) at the height v cos(half_angle).
Result<FaceSurface> cone_surface(const Frame& frame, double radius, double half_angle, const Domain& box);
/// Revolves a circle of radius `minor`, whose centre is `major` away from the axis, about the axis: spheres and tori.
Result<FaceSurface> torus_surface(const Frame& frame, double major, double minor, const Domain& box);

}}  // namespace tessera::abi_0_1
