#pragma once
// Control nets in homogeneous form, for the reference evaluators in double.

#include <array>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The point (w x, w y, w z, w). Uninitialised by default, because nets of the largest degree live on the stack.
struct Homogeneous {
  double x, y, z, w;

  Vec3 vector() const { return {x, y, z}; }
  Vec3 project() const { return {x / w, y / w, z / w}; }
};
inline Homogeneous operator+(const Homogeneous& a, const Homogeneous& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
inline Homogeneous operator-(const Homogeneous& a, const Homogeneous& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
inline Homogeneous operator*(double s, const Homogeneous& a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }

/// Returns position and derivatives of r = A / w from those of A = (w x, w y, w z, w). From A = w r:
///   r_u = (A_u - w_u r) / w,  r_uu = (A_uu - 2 w_u r_u - w_uu r) / w,  r_uv = (A_uv - w_u r_v - w_v r_u - w_uv r) / w
/// (Piegl and Tiller, The NURBS Book, eq. 4.20).
SurfaceJet project(const Homogeneous& a, const Homogeneous& au, const Homogeneous& av, const Homogeneous& auu,
                   const Homogeneous& auv, const Homogeneous& avv);

/// Returns a power of two near x whose reciprocal is one as well; 1 for x = 0.
double power_of_two_near(double x);

/// A patch's net relative to `origin`. Points and weights are divided by powers of two that bring the largest near 1,
/// so sums and products neither overflow nor underflow, and the scaling itself rounds nothing. Polynomial patches have
/// weight 1.
struct HomogeneousNet {
  /// Makes the net relative to zero.
  explicit HomogeneousNet(const BezierPatch& patch) : HomogeneousNet(patch, Vec3{}) {}
  /// Makes the net relative to one of the patch's points.
  HomogeneousNet(const BezierPatch& patch, const Vec3& origin);

  const Homogeneous& at(int i, int j) const { return points[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
  std::size_t size() const { return static_cast<std::size_t>((degree_u + 1) * (degree_v + 1)); }
  /// Turns a point in this net's scale and origin into one in the patch's.
  Vec3 absolute(const Vec3& p) const { return scale * (p + scaled_origin); }

  int degree_u, degree_v;
  double scale;        ///< factor from a vector of this net to a vector of the patch
  Vec3 scaled_origin;  ///< the origin in this net's scale
  std::array<Homogeneous, (max_degree + 1) * (max_degree + 1)> points;
};

/// Returns the corner whose quarter of [0,1]^2 holds (u,v). Relative to it, points of a collapsed edge are exact zeros,
/// and the corner itself evaluates exactly.
inline const Vec3& nearest_corner(const BezierPatch& patch, double u, double v) {
  return patch.point(u > 0.5 ? patch.degree_u() : 0, v > 0.5 ? patch.degree_v() : 0);
}

}}  // namespace tessera::abi_0_1
