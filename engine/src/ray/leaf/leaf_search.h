#pragma once
// The search for all roots of one ray in one piece of a patch, in double, with none missed.

#include <cstddef>
#include <memory>

#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/search_pool.h"
#include "ray/line/ray_query.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {

/// The memory of searches, for one thread at a time.
class SearchSpace {
 public:
  /// A limit of depth beyond the resolution of doubles. Nets are cut by halves in depth-first order.
  static constexpr int max_depth = 160;

  /// `largest`: values in a net. The pool, if there is one, must outlive this and gets the memory back.
  explicit SearchSpace(std::size_t largest, SearchPool* pool = nullptr) : stride_(largest), pool_(pool) {}
  SearchSpace(const SearchSpace&) = delete;
  SearchSpace& operator=(const SearchSpace&) = delete;
  ~SearchSpace() {
    if (memory_ && pool_) pool_->give(std::move(memory_));
  }
  /// Takes the memory when it is first needed, before any other call, so that rays decided without a search need none.
  /// Returns false if there is none. Called from within a tree, and Embree cannot handle exceptions.
  bool make_ready() noexcept {
    if (memory_) return true;
    SearchPool none;
    memory_ = (pool_ ? *pool_ : none).take(stride_ * (max_depth + 5), max_depth + 3);
    if (!memory_) return false;
    nets_ = memory_->nets.data();
    boxes_ = memory_->boxes.data();
    return true;
  }
  double* net(int slot) { return nets_ + static_cast<std::size_t>(slot) * stride_; }
  /// Nets beyond those of the search.
  double* leaf_net() { return net(max_depth + 3); }
  double* spare_net() { return net(max_depth + 4); }
  SearchBox& box(int slot) { return boxes_[slot]; }

 private:
  std::size_t stride_;
  SearchPool* pool_;
  std::unique_ptr<SearchMemory> memory_;
  double* nets_ = nullptr;
  SearchBox* boxes_ = nullptr;
};

/// Bounds the error of a coefficient of a projected net (per weight) after `depth` cuts, and of the net's value at a
/// point, in a scene of SceneFrame's size. It is 2^-53 times the largest distance, 4, times the sum of
/// - 32: control point minus centre, times weight, the three products with an axis, the rounding of start and axes;
/// - 4 (m + n) for each halving that made the leaf, and for the evaluation (Bernstein values by convex combinations:
///   Farouki and Rajan, CAGD 4, 1987, sec. 5);
/// - 4 max(m, n) for each cut of the search.
double search_rounding(int degree_u, int degree_v, int halvings, int depth);

/// Sets the gains of a root of a leaf of du x dv of its patch, from the leaf's homogeneous value there: row sums of
/// |J^-1|, and the side to which the line goes. Returns false if J is singular.
bool set_gain(const NetValue& f, double du, double dv, LeafRoot& root);

/// Adds to the query every root of the leaf in [query.near, query.far]; if only the closest is wanted, those nearer
/// than the query's root. A point of the leaf counts as root up to `tolerance` from the line, where no root can be
/// excluded, or where the search meets such a point. `tolerance` is at least twice search_rounding at max_depth.
///
/// The method is branch and bound:
/// 1. A part whose hull lies off the ray by more than rounding holds no root.
/// 2. A part with a certificate (root_certificate.h) is decided by Newton's method.
/// 3. Another part, if its whole extent is below the square root of the tolerance and it is flat up to the tolerance,
///    counts as one root if it has a point within the tolerance.
/// 4. Any other part is narrowed, or halved across its longer side as the ray sees it.
///
/// So every true intersection is found, borders included: neighbours that share a border cannot both reject a ray
/// through it.
void search_leaf(const Leaf& leaf, const double* net, double tolerance, SearchSpace& space, RayQuery& query);

}}  // namespace tessera::abi_0_1
