#pragma once
// Parts of the curves that bound what loops keep of a patch, as curves in space.

#include <cstdint>

#include "kernel/ray/ray_kernels.h"
#include "query/nearest_foot.h"
#include "query/query_tree.h"
#include "query/range.h"
#include "ray/line/ray_line.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// A part [from, to] of a piece of a loop: the curve s(c(t)) of a patch s and the piece's c.
struct KeptCurve {
  const TrimPiece* piece;  ///< in the surface's parameters
  std::uint32_t patch;
  double from, to;
  VectorRange bend;  ///< its second derivative by t, in the scene's coordinates
};

/// A point of a kept curve and its derivative by t, relative to the frame's centre in the model's unit.
struct CurvePoint {
  double u, v;  ///< in the patch
  Vec3 position, derivative;
};

/// Places of curves: the patch, its part of the surface's domain, and what evaluates it.
struct CurveGround {
  const BezierPatch* patch;
  const Domain* domain;
  const SceneFrame* frame;
  const kernel::RayKernels* kernels;
};

CurvePoint point_of(const CurveGround& ground, const KeptCurve& curve, double t);
/// Fills `bend` by the patch's derivatives over the box of the curve's parameters.
void bound_bend(const CurveGround& ground, KeptCurve& curve);
/// Returns boxes of the curve.
ItemBoxes boxes_of(const CurveGround& ground, const KeptCurve& curve);
/// Returns how far a curve may be from its chord, in the scene's coordinates.
double sag_of(const KeptCurve& curve);

/// Finds the nearest point of a curve to `point`, relative to the frame's centre. `limit`: the distance beyond which
/// points are of no use. `parts` counts the work; when it reaches `max_parts` the search ends, and the foot is not
/// converged.
Foot nearest_foot(const CurveGround& ground, const KeptCurve& curve, const Vec3& point, double limit, int max_parts,
                  int& parts);

}}  // namespace tessera::abi_0_1
