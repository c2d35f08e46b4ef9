#pragma once
// One ray against one piece of a patch: all roots, none missed.

#include <cstddef>
#include <vector>

#include "base/aligned.h"
#include "ray/leaf_nets.h"
#include "ray/projected_net.h"
#include "ray/ray_query.h"

namespace tessera {

/// A part of a leaf's square that may hold roots.
struct SearchBox {
  double u0 = 0, v0 = 0, du = 1, dv = 1;
  int depth = 0;  ///< cuts on the way here
};

/// The memory of searches, of one thread at a time.
class SearchSpace {
 public:
  /// A search splits no deeper, for resolution ends long before; a net is cut by halves in depth-first order.
  static constexpr int most_depth = 160;

  /// `largest`: values in a net.
  explicit SearchSpace(std::size_t largest) : stride_(largest) {}
  /// Takes the memory when it is first needed: before anything else, and not where rays are decided without a search.
  /// False where there is none.
  bool make_ready() noexcept {
    if (!boxes_.empty()) return true;
    try {
      nets_.resize(stride_ * (most_depth + 5));
      boxes_.resize(most_depth + 3);
      return true;
    } catch (...) {  // called from Embree, which knows no exceptions
      return false;
    }
  }
  double* net(int slot) { return nets_.data() + static_cast<std::size_t>(slot) * stride_; }
  /// Beyond those of the search.
  double* leaf_net() { return net(most_depth + 3); }
  double* spare_net() { return net(most_depth + 4); }
  SearchBox& box(int slot) { return boxes_[static_cast<std::size_t>(slot)]; }

 private:
  std::size_t stride_;
  UnsetVector<double> nets_;
  std::vector<SearchBox> boxes_;
};

/// How far, in a scene of the size of SceneFrame's, a coefficient of a projected net (per weight) may be off after
/// `depth` cuts, and the value of the net at a point: 2^-53 times the largest distance, 4, times
///   32: control point minus centre, times weight, the three products with an axis, the rounding of start and axes;
///   4 (m + n) for each halving that made the leaf, and for the evaluation (Bernstein values by convex combinations:
///   Farouki and Rajan, CAGD 4, 1987, sec. 5);
///   4 max(m, n) for each cut of the search.
double search_rounding(int degree_u, int degree_v, int halvings, int depth);

/// Sets how far from `root` another may be that is the same: the linear model's image of an error of the residual and of
/// rounding, for a leaf of du x dv of its patch. Not where the model says nothing.
bool set_radius(const NetValue& f, double rounding, double du, double dv, LeafRoot& root);

/// Adds to the query every root of the leaf in [query.near, query.far]: where only the closest is wanted, those nearer
/// than what the query has. A point of the leaf counts as root up to `tolerance` from the line, where no root can be
/// excluded, or where the search meets such a point. `tolerance` is at least twice search_rounding at most_depth.
///
/// Branch and bound: a part whose hull lies off the ray by more than rounding holds no root and is left; a part with a
/// certificate (root_certificate.h) is decided by Newton's method; of the others those whose whole extent is below the
/// square root of the tolerance count as one root where they have a point within the tolerance; the rest is narrowed or
/// halved, across its longer side as the ray sees it. So whatever the surface meets truly, borders included, is found:
/// neighbours that share a border cannot both reject a ray through it.
void search_leaf(const Leaf& leaf, const double* net, double tolerance, SearchSpace& space, RayQuery& query);

}  // namespace tessera
