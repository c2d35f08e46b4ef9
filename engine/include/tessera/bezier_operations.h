#pragma once
// Operations on Bezier patches, polynomial and rational: curves on them, derivatives, subdivision, degree elevation,
// reorientation, makers of simple patches; measuring and making smooth joins of two patches along a side.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A Bezier curve: degree + 1 points, and as many weights > 0, or none if polynomial.
struct BezierPolygon {
  std::vector<Vec3> points;     ///< Bernstein coefficients
  std::vector<double> weights;  ///< one per point; empty for a polynomial curve
};

/// @name Curves, derivatives and pieces of a patch
/// Accuracy: each coordinate is within 2 units of 2^-52 times the largest coordinate of the patch. Points that coincide
/// by == still coincide, so poles remain poles. Patches that share a border by == share it after the same operation.
/// @{

/// Returns the isocurve v = const along u, 0 <= v <= 1: W_i = sum_j V_ij B_j(v), in homogeneous form if the patch is
/// rational. Errors: invalid_argument or non_finite (the parameter), out_of_memory.
Result<BezierPolygon> u_line(const BezierPatch& patch, double v);
/// Returns the isocurve u = const along v, 0 <= u <= 1: Q_j = sum_i V_ij B_i(u). Errors: as for u_line().
Result<BezierPolygon> v_line(const BezierPatch& patch, double u);
/// Returns a border curve, whose points are a border of the net: u0 and u1 run along v, v0 and v1 along u. Errors:
/// invalid_argument (no such side).
Result<BezierPolygon> boundary_curve(const BezierPatch& patch, Side side);

/// Returns the derivative of order a in u and b in v, any order >= 0, as a Bezier patch of degree (m - a, n - b) on the
/// differences of the net: (1,0) is r_u, (1,1) is r_uv, (0,2) is r_vv. A direction in which the derivative is constant
/// has degree 1, with two equal rows.
///
/// Errors: unsupported (a rational patch), invalid_argument (a negative order), non_finite (too large).
Result<BezierPatch> derivative_patch(const BezierPatch& patch, int order_u, int order_v);
/// Returns r_uv at r(0,0), r(0,1), r(1,0), r(1,1); in a polynomial patch m n (V11 - V10 - V01 + V00) and its like. A
/// twist vanishes where the four points at its corner form a parallelogram.
std::array<Vec3, 4> corner_twists(const BezierPatch& patch);

/// Splits a patch at the parameter t, 0 <= t <= 1, into the parts over [0, t] and [t, 1], each on [0,1]^2 again. They
/// share their common border by ==. At t = 0 and t = 1 one part is only a curve. Errors: invalid_argument or
/// non_finite (the parameter).
Result<std::pair<BezierPatch, BezierPatch>> split_u(const BezierPatch& patch, double t);
/// Splits along v, like split_u(). Errors: invalid_argument or non_finite (the parameter).
Result<std::pair<BezierPatch, BezierPatch>> split_v(const BezierPatch& patch, double t);
/// Returns the part over a rectangle within [0,1]^2, on [0,1]^2. Errors: invalid_argument or non_finite (the
/// rectangle).
Result<BezierPatch> sub_patch(const BezierPatch& patch, const Domain& rectangle);
/// Returns the same patch with the given degrees. Errors: unsupported_degree (below the patch's, or above max_degree).
Result<BezierPatch> elevate_degree(const BezierPatch& patch, int degree_u, int degree_v);

/// Returns r(v,u), exactly. Flips normals. Errors: out_of_memory.
Result<BezierPatch> transpose(const BezierPatch& patch);
/// Returns r(1-u,v), like transpose(). Errors: out_of_memory.
Result<BezierPatch> reverse_u(const BezierPatch& patch);
/// Returns r(u,1-v), like transpose(). Errors: out_of_memory.
Result<BezierPatch> reverse_v(const BezierPatch& patch);

/// @}

/// @name Makers of patches of degree (1,n)
/// The patches are straight along u and have a curve of degree n along v: the rows of the net are curves.
/// @{

/// Makes the ruled patch (1-u) C0(v) + u C1(v). The curve of lower degree is elevated. Rational curves must have the
/// same weights by == at the same degree; otherwise the surface is of a higher degree. Errors: unsupported (other
/// weights), those of BezierPatch::rational() for the net.
Result<BezierPatch> make_ruled(const BezierPolygon& c0, const BezierPolygon& c1);
/// Makes the generalised cylinder C(v) + u d. Errors: invalid_argument (d is zero), those of BezierPatch::rational()
/// for the net.
Result<BezierPatch> make_cylinder(const BezierPolygon& curve, const Vec3& direction);
/// Makes the generalised cone with the apex at u = 0 and the curve at u = 1. Errors: those of BezierPatch::rational()
/// for the net.
Result<BezierPatch> make_cone(const Vec3& apex, const BezierPolygon& curve);
/// Makes the bilinear patch of four corners, a hyperbolic paraboloid unless they lie in a plane. Errors: non_finite
/// (index = the corner).
Result<BezierPatch> make_hyperbolic_paraboloid(const Vec3& r00, const Vec3& r01, const Vec3& r10, const Vec3& r11);

/// @}

/// One of the two patches of a join: its side there, and the rectangle of parameters that the patch covers.
struct JoinedPatch {
  const BezierPatch& patch;  ///< referenced; must outlive the call
  Side side = Side::u1;      ///< that is joined
  Domain domain = {};        ///< derivatives are by its parameters
};

/// Largest values that count as zero.
struct JoinTolerances {
  double position = 1e-9;    ///< times the diagonal of the box of both patches
  double angle = 1e-6;       ///< between the normals, in radians
  double derivative = 1e-9;  ///< times the larger of the two largest cross-derivatives
};

/// How smoothly two patches join.
enum class Continuity : std::uint8_t {
  none,  ///< the borders differ
  c0,    ///< the borders are equal
  g1,    ///< and so are the normals along it, pointing the same way
  c1,    ///< and so are the derivatives across the border
};

/// Report on a join: maxima along the whole border, at equal fractions of the two sides.
///
/// Each figure is an upper bound, proven by hulls of Bernstein coefficients (up to rounding: products of degree up to
/// 8 * 15, a few hundred units of 2^-52 of the largest). It is at most 0.1 % or the stated floor above the true
/// maximum, unless `sharp` is false: then halving stopped at 2^-40 of the border or 20,000 pieces.
struct JoinReport {
  double position_gap = 0;  ///< floor: 1e-15 of the size
  /// Angle between the normals as seen through the join, in radians. Floor: 1e-12. It is pi if a normal vanishes inside
  /// the border.
  double normal_angle = 0;
  /// |p_c - q_c|, where c runs across the join from p into q, by the parameters of the domains. Floor: 1e-15 of the
  /// derivatives.
  double derivative_gap = 0;
  std::optional<double> ratio;  ///< k > 0 with p_c = k q_c along the whole border, within the tolerance of derivatives
  bool reversed = false;        ///< whether q's side runs the other way
  bool sharp = true;            ///< whether the bounds are as tight as stated
  Continuity continuity = Continuity::none;  ///< the highest that holds
};

/// Measures the join of p with q along one side of each. Patches may have any degrees and be rational. q's side may run
/// with p's or against it: the nearer is taken. A normal that vanishes at an end of the border (a pole) is divided out
/// there: its limit along the border counts.
///
/// Errors: invalid_argument (no such side, a domain that is empty, a tolerance that is negative or NaN), non_finite (a
/// domain).
Result<JoinReport> measure_join(const JoinedPatch& p, const JoinedPatch& q, const JoinTolerances& tolerances = {});

/// Returns q with its first two rows along the side replaced so that p_c = k q_c, k > 0 (k = 1: C1): W_0j = V_mj,
/// W_1j = W_0j + m_p len_q / (k m_q len_p) (V_mj - V_{m-1,j}), where len is the domain's width across the side;
/// rational patches in homogeneous form. If the degrees along the side differ, the lower one is raised first. If q has
/// degree 1 across the side, its far border moves. `reversed`: whether q's side runs the other way.
///
/// Errors: as for measure_join(); invalid_argument or non_finite (k), invalid_weight (a new weight is not positive: k
/// is too small).
Result<BezierPatch> make_join(const JoinedPatch& p, const JoinedPatch& q, double k = 1, bool reversed = false);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
