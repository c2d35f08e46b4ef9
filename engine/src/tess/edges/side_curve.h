#pragma once
// Borders of patches as curves in double, to be compared where they are not the same bits.

#include <array>

#include "tess/edges/shared_edges.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// A border of a patch in homogeneous form relative to its patch's points, running with u or v. Weights are scaled so that
/// those of both ends add up to 2.
class SideCurve {
 public:
  SideCurve(const BezierPatch& patch, Side side);

  int degree() const { return degree_; }
  Vec3 point(int k) const { return points_[static_cast<std::size_t>(k)]; }
  double weight(int k) const { return weights_[static_cast<std::size_t>(k)]; }
  Vec3 first() const { return points_[0]; }
  Vec3 last() const { return points_[static_cast<std::size_t>(degree_)]; }
  /// Of the control points.
  Box3 box() const;
  /// The same curve, of a higher degree, up to max_degree.
  void elevate(int degree);

 private:
  int degree_;
  std::array<Vec3, max_degree + 1> points_;
  std::array<double, max_degree + 1> weights_;
};

/// What points of the curves at the same parameter (or, `reversed`, at t and 1 - t) lie apart at most: with points p_k and
/// weights w_k of one, q_k and v_k of the other, of equal degrees,
///   |p(t) - q(t)| = |sum B_k (w_k (p_k - q_k) + (w_k - v_k) (q_k - q(t)))| / sum B_k w_k
///                <= max |p_k - q_k| + max(|w_k - v_k| / w_k) D,   D the diagonal of the box of the q_k.
/// Degrees that differ are elevated.
double distance_bound(SideCurve a, SideCurve b, bool reversed);

/// Whether a border runs against another of its edge, both by 4 * patch + side. Where their float bits are the same in either
/// direction, by those in double.
bool runs_against(const PatchSet::Impl& set, std::uint32_t border, std::uint32_t other);

/// The edges of `edges`, whose borders' float control points are the same bits, parted where those in double are not about
/// the same: within 2^-20 of the diagonal of their box, or what doubles round at that place. For sets that reach so far that
/// borders apart from each other are the same floats. Time: that of sorting all borders.
SharedEdges parted_by_doubles(const PatchSet::Impl& set, const SharedEdges& edges);

/// The patch with a border made a point, its first. Errors: out_of_memory.
Result<BezierPatch> with_pole(const BezierPatch& patch, Side side);

}  // namespace tessera::inline abi_0_1
