#pragma once
// Joins of two patches along an edge: how smooth one is, and making one smooth.

#include <cstdint>
#include <optional>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera {

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

}  // namespace tessera
#pragma GCC visibility pop
