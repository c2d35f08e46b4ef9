#pragma once
// Holds borders of patches as curves in double, to compare those that are not the same bits.

#include <array>

#include "tess/edges/shared_edges.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// A unit vector that models hardly align with: points near each other along it are few beside those that lie so along
/// x, y or z.
inline constexpr Vec3 unaligned{0.7548776662466927, 0.5698402909980532, 0.3247179572447561};

/// A border of a patch as points and weights, in the direction of u or v. Weights are scaled so that those of both ends
/// add up to 2.
class SideCurve {
 public:
  SideCurve(const BezierPatch& patch, Side side);

  int degree() const { return degree_; }
  Vec3 point(int k) const { return points_[static_cast<std::size_t>(k)]; }
  double weight(int k) const { return weights_[static_cast<std::size_t>(k)]; }
  Vec3 first() const { return points_[0]; }
  Vec3 last() const { return points_[static_cast<std::size_t>(degree_)]; }
  /// Returns the box of the control points.
  Box3 box() const;
  /// Raises the degree of the curve, up to max_degree.
  void elevate(int degree);

 private:
  int degree_;
  std::array<Vec3, max_degree + 1> points_;
  std::array<double, max_degree + 1> weights_;
};

/// Returns a bound on the distance between points of two curves at the same parameter, or at t and 1 - t if `reversed`.
/// Differing degrees are elevated. With points p_k and weights w_k of one curve, q_k and v_k of the other, it is
///   |p(t) - q(t)| = |sum B_k (w_k (p_k - q_k) + (w_k - v_k) (q_k - q(t)))| / sum B_k w_k
///                <= max |p_k - q_k| + max(|w_k - v_k| / w_k) D,   D the diagonal of the box of the q_k.
double distance_bound(SideCurve a, SideCurve b, bool reversed);

/// Whether a curve comes before another in an order that does not depend on their directions: by degrees, then by the
/// points and weights from that end which has the lesser ones. Curves neither of which comes first are the same.
bool comes_before(const SideCurve& a, const SideCurve& b);

/// Whether a border runs against another, both as 4 * patch + side. Their float bits must be the same, in one direction
/// at least. If they are the same in both, the control points in double decide.
bool runs_against(const PatchSet::Impl& set, std::uint32_t border, std::uint32_t other);

/// Splits the edges of `edges`, whose borders' float control points are the same bits, where those in double are not
/// about equal. They are if they lie within 2^-20 of the diagonal of their box, or within the rounding of doubles at
/// that place. Meant for sets that reach so far that separate borders are the same floats. Time: that of sorting all
/// borders.
SharedEdges parted_by_doubles(const PatchSet::Impl& set, const SharedEdges& edges);

/// Returns the patch with one border made a point, the border's first. Errors: out_of_memory.
Result<BezierPatch> with_pole(const BezierPatch& patch, Side side);

}}  // namespace tessera::abi_0_1
