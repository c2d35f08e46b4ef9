#pragma once
// Networks of bicubic Hermite patches that join smoothly along whole edges.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tessera/hermite_patch.h"

#pragma GCC visibility push(default)
namespace tessera {

/// How the twists of a network's nodes are estimated.
enum class TwistEstimate : std::uint8_t {
  zero,    ///< Ferguson's
  adini,   ///< from tangents and positions of the eight neighbours, indices clamped at borders
  bessel,  ///< from positions alone: of the biquadratic through 3x3 nodes
};

/// The nodes [i][j] at (u[i], v[j]) with their twists replaced by estimates. Derivatives are by u and v.
///   adini:  [R_v(i+1,j) - R_v(i-1,j)] / Du + [R_u(i,j+1) - R_u(i,j-1)] / Dv
///           - [P(i+1,j+1) - P(i-1,j+1) - P(i+1,j-1) + P(i-1,j-1)] / (Du Dv), the D over two spans
///   bessel: [1-a, a] D [1-b, b]^T, D the mixed differences of four cells over their areas, b likewise,
///           a = h_{i-1} / (h_{i-1} + h_i); at a first node the weights are (1+a, -a), at a last (-(1-a), 2-a), with
///           a of the inner node beside it
/// (Farin, Curves and Surfaces for CAGD, 5th ed., ch. 15). One twist a node, so that patches stay G1.
/// Errors: invalid_argument (fewer than two knots, for bessel three; knots that don't increase), count_mismatch,
/// non_finite.
Result<std::vector<HermiteNode>> estimate_twists(TwistEstimate estimate, std::span<const double> u,
                                                 std::span<const double> v, std::span<const HermiteNode> nodes);

/// A grid of nodes (P, A, B, T), those of the (1,1) corner of the patch at the lower left of each, and factors k_i > 0
/// for the column lines and l_j > 0 for the row lines, k_0 = l_0 = 1. Patch (i,j) takes at its corner (a,b), from node
/// (i+a, j+b), r_u = K A, r_v = L B, r_uv = K L T on [0,1]^2, where K = k_i if a = 0, else 1, and L = l_j if b = 0,
/// else 1. Neighbours are G1 along whole edges. The parameters of the whole run over knot spacings h_i = k_i h_{i-1},
/// g_j = l_j g_{j-1}, by which it is C1. Immutable but for assignment; copies share everything.
class HermiteNetwork {
 public:
  /// `nodes`: count_u * count_v of them [i][j], at least two each way; `k`: count_u - 1 factors, one for each line with
  /// a patch to its right, `l`: count_v - 1. The knots start at 0, with h_0 = g_0 = 1.
  /// Errors: invalid_argument (too few nodes; a factor that is not positive, k_0 or l_0 that is not 1, knots that a
  /// factor makes coincide; index = the factor), count_mismatch, non_finite (index = the node or factor).
  static Result<HermiteNetwork> from_factors(std::size_t count_u, std::size_t count_v,
                                             std::span<const HermiteNode> nodes, std::span<const double> k,
                                             std::span<const double> l);
  /// The C1 bicubic with given derivatives by u and v at the knots: A = h_{i-1} R_u, B = g_{j-1} R_v, T = h_{i-1}
  /// g_{j-1} R_uv, where h_{-1} is h_0. Errors: as above (index = the knot or node).
  static Result<HermiteNetwork> on_knots(std::span<const double> u, std::span<const double> v,
                                         std::span<const HermiteNode> nodes);

  std::size_t count_u() const { return data_->knots_u.size(); }  ///< nodes along u
  std::size_t count_v() const { return data_->knots_v.size(); }  ///< nodes along v
  /// P, A, B and T of node (i,j).
  const HermiteNode& node(std::size_t i, std::size_t j) const { return data_->nodes[i * count_v() + j]; }
  std::span<const double> factors_u() const { return data_->k; }      ///< k of each interval along u, as made
  std::span<const double> factors_v() const { return data_->l; }      ///< l of each interval along v, as made
  std::span<const double> knots_u() const { return data_->knots_u; }  ///< parameters of the rows of nodes
  std::span<const double> knots_v() const { return data_->knots_v; }  ///< parameters of the columns of nodes
  /// Between the first and the last knots.
  Domain domain() const { return {knots_u().front(), knots_u().back(), knots_v().front(), knots_v().back()}; }
  /// Patch (i,j) on [0,1]^2; i < count_u() - 1, j < count_v() - 1. The one call that throws: std::bad_alloc.
  HermitePatch patch(std::size_t i, std::size_t j) const;

 private:
  struct Data {
    std::vector<HermiteNode> nodes;
    std::vector<double> k, l, knots_u, knots_v;
  };
  explicit HermiteNetwork(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}
  HermitePatch::Corners patch_corners(std::size_t i, std::size_t j) const;
  friend SurfaceJet evaluate_jet(const HermiteNetwork& network, double u, double v);
  static Result<HermiteNetwork> checked(HermiteNetwork network);

  std::shared_ptr<const Data> data_;
};

/// The reference evaluator, by the patch that holds (u,v): at an inner knot the one on its right; outside the domain
/// the nearest patch goes on. Derivatives by u and v.
SurfaceJet evaluate_jet(const HermiteNetwork& network, double u, double v);

/// One bicubic Bezier patch a cell, over the knots; exact to rounding. Error: non_finite (too large).
Result<PatchGrid> to_bezier(const HermiteNetwork& network);

}  // namespace tessera
#pragma GCC visibility pop
