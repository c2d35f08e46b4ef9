#pragma once
// Operations on Bezier patches, polynomial and rational: curves on them, derivatives, subdivision, degree elevation,
// reorientation, makers of the simplest ones; joins of two patches along an edge, measured and made smooth.

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// A Bezier curve: degree + 1 points, and as many weights > 0, or none for a polynomial one.
struct BezierPolygon {
  std::vector<Vec3> points;     ///< Bernstein coefficients
  std::vector<double> weights;  ///< one a point; empty for a polynomial curve
};

// Results are right to rounding: each coordinate within 2 units of 2^-52 times the largest coordinate of the patch.
// Points that coincide keep coinciding by ==, so poles stay poles. Patches that share a border by == share it after the
// same operation.

/// The u-line v = const, 0 <= v <= 1: W_i = sum_j V_ij B_j(v), in homogeneous form if the patch is rational.
/// Errors: invalid_argument (the parameter, NaN included), out_of_memory.
Result<BezierPolygon> u_line(const BezierPatch& patch, double v);
/// The v-line u = const: Q_j = sum_i V_ij B_i(u).
Result<BezierPolygon> v_line(const BezierPatch& patch, double u);
/// A border of the net, which is the net of the border: u0 and u1 run along v, v0 and v1 along u.
/// Error: invalid_argument (not one edge).
Result<BezierPolygon> boundary_curve(const BezierPatch& patch, Edge edge);

/// The derivative of order a in u and b in v as a Bezier patch, degree (m - a, n - b), on the differences of the net:
/// (1,0) is r_u, (1,1) r_uv, (0,2) r_vv, any order. A direction in which the derivative is constant has degree 1, with
/// two equal rows. Errors: unsupported (a rational patch), invalid_argument (a negative order), non_finite (too large).
Result<BezierPatch> derivative_patch(const BezierPatch& patch, int order_u, int order_v);
/// r_uv at r(0,0), r(0,1), r(1,0), r(1,1). For a polynomial patch m n (V11 - V10 - V01 + V00) and its like, which
/// vanish where the four points at a corner are a parallelogram.
std::array<Vec3, 4> corner_twists(const BezierPatch& patch);

/// The parts over [0, t] and [t, 1], each on [0,1]^2 again, 0 <= t <= 1; at an end of the range one part is a curve.
/// Their common border is shared by ==. Error: invalid_argument (the parameter).
Result<std::pair<BezierPatch, BezierPatch>> split_u(const BezierPatch& patch, double t);
Result<std::pair<BezierPatch, BezierPatch>> split_v(const BezierPatch& patch, double t);
/// The part over a rectangle within [0,1]^2. Error: invalid_argument (the rectangle).
Result<BezierPatch> sub_patch(const BezierPatch& patch, const Domain& rectangle);
/// The same patch with higher degrees. Error: unsupported_degree (below the patch's, or above max_degree).
Result<BezierPatch> elevate_degree(const BezierPatch& patch, int degree_u, int degree_v);

/// r(v,u), r(1-u,v) and r(u,1-v): exact. The normal turns over. Error: out_of_memory.
Result<BezierPatch> transpose(const BezierPatch& patch);
Result<BezierPatch> reverse_u(const BezierPatch& patch);
Result<BezierPatch> reverse_v(const BezierPatch& patch);

// Makers: patches of degree (1,n), straight along u, a curve of degree n along v. Errors of all: those of BezierPatch
// for the net that they make, whose rows are the curves.

/// (1-u) C0(v) + u C1(v). Curves of unequal degrees are elevated. Rational ones must have the same weights by == once
/// they have the same degree, else the surface is of a higher degree than this. Error: unsupported (other weights).
Result<BezierPatch> make_ruled(const BezierPolygon& c0, const BezierPolygon& c1);
/// The generalised cylinder C(v) + u d. Error: invalid_argument (d is zero).
Result<BezierPatch> make_cylinder(const BezierPolygon& curve, const Vec3& direction);
/// The generalised cone: the apex at u = 0, the curve at u = 1.
Result<BezierPatch> make_cone(const Vec3& apex, const BezierPolygon& curve);
/// The bilinear patch of four corners, a hyperbolic paraboloid unless they lie in a plane.
Result<BezierPatch> make_hyperbolic_paraboloid(const Vec3& r00, const Vec3& r01, const Vec3& r10, const Vec3& r11);

/// One side of a join: a patch (referred to, not copied), which of its edges, and the rectangle of parameters that it
/// covers, by which derivatives are taken.
struct JoinSide {
  const BezierPatch& patch;  ///< must outlive the call
  Edge edge = Edge::u1;      ///< the border that is meant
  Domain domain = {};        ///< by whose parameters derivatives are taken
};

/// What may be taken for zero.
struct JoinTolerances {
  double position = 1e-9;    ///< times the diagonal of the box of both patches
  double angle = 1e-6;       ///< between the normals, radians
  double derivative = 1e-9;  ///< times the larger of the two largest cross-derivatives
};

enum class Continuity : std::uint8_t {
  none,  ///< the borders differ
  c0,    ///< one border
  g1,    ///< and one normal all along it, pointing the same way
  c1,    ///< and one derivative across it
};

/// Maxima along the whole border, at equal fractions of the two edges. Each figure is an upper bound proven by hulls of
/// Bernstein coefficients (to rounding: products of degree up to 8 * 15, a few hundred units of 2^-52 of the largest),
/// at most 0.1 % or the stated floor above the true maximum unless `sharp` is false: then halving stopped at 2^-40 of
/// the border or 20,000 pieces.
struct JoinReport {
  double position_gap = 0;  ///< floor 1e-15 of the size
  /// Between the normals as seen through the join; floor 1e-12; pi if a normal vanishes inside the border.
  double normal_angle = 0;
  /// |p_c - q_c|, c across the join from p into q, by the parameters of the domains; floor 1e-15 of the derivatives.
  double derivative_gap = 0;
  std::optional<double> ratio;  ///< k with p_c = k q_c all along, within the tolerance of derivatives; k > 0
  bool reversed = false;        ///< q's edge runs the other way
  bool sharp = true;            ///< whether the bounds are as tight as stated
  Continuity continuity = Continuity::none;  ///< the most that holds
};

/// Measures the join of p with q along the given edges, of any degrees, polynomial or rational. q's edge may run the
/// same way as p's or the other way: the nearer is taken. A normal that vanishes at an end of the border (a pole) is
/// divided out there: its limit along the border counts. Errors: invalid_argument (no such edge, a domain that is empty
/// or not finite, a tolerance that is negative or NaN).
Result<JoinReport> measure_join(const JoinSide& p, const JoinSide& q, const JoinTolerances& tolerances = {});

/// q with its first two rows along the edge replaced so that p_c = k q_c, k > 0 (k = 1: C1):
/// W_0j = V_mj, W_1j = W_0j + m_p len_q / (k m_q len_p) (V_mj - V_{m-1,j}), len the widths of the domains across the
/// edge; rational patches in homogeneous form. If the degrees along the edge differ, the lower is raised first.
/// `reversed`: q's edge runs the other way. If q has degree 1 across, its far border moves. Errors: invalid_argument
/// (as above, k), invalid_weight (a new weight is not positive: k is too small).
Result<BezierPatch> make_join(const JoinSide& p, const JoinSide& q, double k = 1, bool reversed = false);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
