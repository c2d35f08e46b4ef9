#pragma once
// Tensor-product Bezier patches in double, polynomial and rational: every surface is converted to them. Also the scalar
// reference evaluators that the fast kernels are tested against.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <span>

#include "tessera/detail/shared_memory.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The largest degree in each direction; the smallest is 1.
inline constexpr int max_degree = 15;

/// A Bezier patch on [0,1]^2: r(u,v) = sum_ij B_{i,m}(u) B_{j,n}(v) V_ij or, rational with weights w_ij > 0, r = sum B
/// B w_ij V_ij / sum B B w_ij  (Farin, Curves and Surfaces for CAGD, 5th ed., ch. 14 and 16).
///
/// Points are stored [i][j], i along u: V_ij is points()[i * (degree_v() + 1) + j]. Immutable except for assignment;
/// copies share their points.
class BezierPatch {
 public:
  /// Makes a polynomial patch.
  ///
  /// - `degree_u`, `degree_v`: 1 to max_degree.
  /// - `points`: (degree_u + 1) * (degree_v + 1) finite points in the order above.
  ///
  /// Errors: unsupported_degree, count_mismatch, non_finite (index = the offending point).
  static Result<BezierPatch> polynomial(int degree_u, int degree_v, std::span<const Vec3> points);
  /// Makes a rational patch.
  ///
  /// - `points`: as for polynomial(), not premultiplied.
  /// - `weights`: one finite weight > 0 per point, at least 1e-100 of the largest. If all are equal by ==, they are
  ///   dropped and the patch is polynomial.
  ///
  /// Weights must be positive even where the denominator would be so anyway. A patch stores each point and its weight,
  /// with no place for a point of weight zero, which is at infinity if w V is not zero; a point computed between two of
  /// them does not exist. With negative weights the patch leaves its hull, on which boxes and bounds rest.
  ///
  /// Errors: those of polynomial(), invalid_weight (index = the offending weight).
  static Result<BezierPatch> rational(int degree_u, int degree_v, std::span<const Vec3> points,
                                      std::span<const double> weights);

  /// Returns this patch with other control points, as many as before, and the same weights. Errors: count_mismatch,
  /// non_finite (index = the offending point).
  Result<BezierPatch> with_points(std::span<const Vec3> points) const;

  int degree_u() const { return degree_u_; }
  int degree_v() const { return degree_v_; }
  bool is_rational() const { return weights_ != nullptr; }             ///< whether it has weights
  std::span<const Vec3> points() const { return {points_, count()}; }  ///< `[i][j]`, not premultiplied
  /// The weights `[i][j]`; empty for a polynomial patch. All pieces of a rational surface are rational, even those with
  /// equal weights.
  std::span<const double> weights() const { return {weights_, is_rational() ? count() : 0}; }
  const Vec3& point(int i, int j) const { return points_[index(i, j)]; }  ///< 0 <= i <= degree_u, 0 <= j <= degree_v
  /// Returns the weight of point (i, j); 1 in a polynomial patch.
  double weight(int i, int j) const { return !is_rational() ? 1.0 : weights_[index(i, j)]; }

  /// Returns the box of the control points, which contains the patch.
  Box3 hull_box() const;
  /// Returns the sides whose control points all coincide (by ==): the patch has a pole there.
  SideMask collapsed_sides() const;

 private:
  BezierPatch() = default;
  std::size_t count() const { return index(degree_u_, degree_v_) + 1; }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (degree_v_ + 1) + j); }

  int degree_u_ = 0, degree_v_ = 0;
  const Vec3* points_ = nullptr;
  const double* weights_ = nullptr;  ///< null for a polynomial patch
  SharedMemory memory_;  ///< holds points and weights; shared by copies, pieces of one surface and patches of one file
  friend class PatchPieces;
  friend class PatchPool;
};

/// Position and partial derivatives at one (u,v).
struct SurfaceJet {
  Vec3 position, du, dv, duu, duv, dvv;  ///< r and its derivatives by u and v
};

/// @name Reference evaluators
/// Slow and plain, one point at a time, in double, for any finite (u,v), inside [0,1]^2 or not.
/// @{

/// Evaluates by de Casteljau's algorithm along u, then along v; rational patches in homogeneous form (Farin, sec.
/// 14.3).
Vec3 de_casteljau(const BezierPatch& patch, double u, double v);
/// Evaluates by the bilinear de Casteljau algorithm: min(m,n) bilinear steps, then curve steps in the direction of the
/// higher degree; rational patches in homogeneous form (Farin, sec. 14.1).
Vec3 de_casteljau_bilinear(const BezierPatch& patch, double u, double v);
/// Evaluates by the rational de Casteljau algorithm along u, then along v. Each step interpolates the points themselves
/// by weighted ratios, so every intermediate point is in the hull (Farin, sec. 13.3).
Vec3 de_casteljau_rational(const BezierPatch& patch, double u, double v);
/// Returns position, first and second derivatives; rational ones by the quotient rule (Piegl and Tiller, The NURBS
/// Book, eq. 4.20).
SurfaceJet evaluate_jet(const BezierPatch& patch, double u, double v);

/// @}

/// How a unit normal was found.
enum class NormalKind : std::uint8_t {
  regular,    ///< r_u x r_v / |r_u x r_v|
  limit,      ///< the limit at a degenerate point (a collapsed side, parallel tangents)
  undefined,  ///< there is none; the vector is zero
};
/// A direction of length 1, and how it was found.
struct UnitNormal {
  Vec3 direction;                           ///< zero where undefined
  NormalKind kind = NormalKind::undefined;  ///< regular, a limit, or undefined
};
/// Returns the unit normal at (u,v) in [0,1]^2. Where r_u x r_v vanishes, it is the one-sided limit from inside the
/// patch along the parameter that leads away from the collapsed side (from r_u and r_uv, or r_v and r_uv).
UnitNormal unit_normal(const BezierPatch& patch, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
