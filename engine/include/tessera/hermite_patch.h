#pragma once
// Bicubic Hermite patches of 16 vectors, or of 12 with the twists zero (Ferguson) or estimated (Adini); networks of
// such patches that join smoothly along whole edges.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

class PatchGrid;  // tessera/convert.h

/// The order of the rows and columns of a geometry matrix.
enum class HermiteOrder : std::uint8_t {
  by_end,   ///< position 0, tangent 0, tangent 1, position 1: rows r, r_u at u0, r_u, r at u1; columns the same along v
  by_kind,  ///< position 0, position 1, tangent 0, tangent 1
};

/// Position, derivatives and twist at a corner or node.
struct HermiteNode {
  Vec3 position, du, dv, duv;  ///< r, r_u, r_v, r_uv

  friend bool operator==(const HermiteNode&, const HermiteNode&) = default;
};
/// Position and derivatives at a corner whose twist is open.
struct CornerTangents {
  Vec3 position, du, dv;  ///< r, r_u, r_v
};

/// The bicubic patch with given positions, tangents and twists at its corners. Tangents and twists are derivatives by
/// the patch's own parameters, which run over its domain: with s = (u - u0) / (u1 - u0) the blends are H0(s), (u1 - u0)
/// H1(s), (u1 - u0) H2(s), H3(s). Immutable except for assignment; copies share their vectors.
class HermitePatch {
 public:
  /// The corners of a domain in the order (u0,v0), (u0,v1), (u1,v0), (u1,v1).
  using Corners = std::array<HermiteNode, 4>;
  using OpenCorners = std::array<CornerTangents, 4>;  ///< Corners without twists
  /// 16 vectors [i][j], i along u.
  using Grid = std::array<Vec3, 16>;

  /// Makes a patch from the geometry matrix: 16 vectors [i][j], in order by_end [[r, r_v, r_v, r], [r_u, r_uv, r_uv,
  /// r_u], [r_u, r_uv, r_uv, r_u], [r, r_v, r_v, r]]. Errors: count_mismatch, non_finite (a vector; index = the
  /// element), invalid_argument (the domain).
  static Result<HermitePatch> make(std::span<const Vec3> geometry, const Domain& domain = {},
                                   HermiteOrder order = HermiteOrder::by_end);
  /// Makes a patch from corners with twists. Errors: non_finite (a vector; index = the element), invalid_argument (the
  /// domain).
  static Result<HermitePatch> from_corners(const Corners& corners, const Domain& domain = {});
  /// Makes a patch from 12 vectors with zero twists. Errors: as for from_corners(). Source: Ferguson, Multivariable
  /// curve interpolation, 1964.
  static Result<HermitePatch> ferguson(const OpenCorners& corners, const Domain& domain = {});
  /// Makes a patch from 12 vectors with Adini's twists, those of the bilinearly blended Coons patch of the four
  /// borders: r_uv(i,j) = (r_u(i,1) - r_u(i,0)) / dv + (r_v(1,j) - r_v(0,j)) / du - (r00 - r10 - r01 + r11) / (du dv).
  /// Errors: as for from_corners(). Source: Farin, Curves and Surfaces for CAGD, 5th ed., ch. 15.
  static Result<HermitePatch> adini(const OpenCorners& corners, const Domain& domain = {});
  /// Makes a patch from 16 coefficients a_ij of s^i t^j, s and t over [0,1]. Errors: as for make().
  static Result<HermitePatch> from_algebraic(std::span<const Vec3> coefficients, const Domain& domain = {});
  /// Makes the patch through 16 points [i][j] at the parameters (u[i], v[j]) of the domain.
  ///
  /// - `u`, `v`: four distinct parameters each, within the domain or not.
  ///
  /// Errors: count_mismatch, invalid_argument (two equal parameters, which make the system singular; index = the
  /// second; the domain), non_finite (index = the point or the parameter).
  static Result<HermitePatch> through_points(std::span<const Vec3> points, std::span<const double> u,
                                             std::span<const double> v, const Domain& domain = {});
  /// Makes a patch from a polynomial Bezier patch of degrees 1 to 3 in each direction; exact. Errors: unsupported
  /// (rational), unsupported_degree, non_finite (a vector too large), invalid_argument (the domain).
  static Result<HermitePatch> from_bezier(const BezierPatch& patch, const Domain& domain = {});

  const Domain& domain() const { return data_->domain; }  ///< derivatives are by its parameters
  /// Returns the geometry matrix, with derivatives by u and v of the domain.
  Grid geometry(HermiteOrder order = HermiteOrder::by_end) const;
  /// Returns the corner at u = u0 (a = 0) or u1 (a = 1), v = v0 (b = 0) or v1 (b = 1).
  HermiteNode corner(int a, int b) const;
  /// Returns the coefficients a_ij of s^i t^j, s and t over [0,1].
  Grid algebraic_form() const;
  /// Returns the points at the parameters (u[i], v[j]): the inverse of through_points().
  Grid points_at(const std::array<double, 4>& u, const std::array<double, 4>& v) const;

  /// Returns the same surface over another rectangle [s0, s1] x [t0, t1]: q_s = (u1 - u0) / (s1 - s0) p_u, q_t
  /// likewise, and q_st with the product of both factors. Errors: as for from_corners().
  Result<HermitePatch> reparametrize(const Domain& domain) const;

 private:
  struct Data {
    Grid geometry;  // by_end
    Domain domain;
  };
  explicit HermitePatch(const Data& data);
  /// Makes a patch from the geometry by local parameters, which run over [0,1].
  static Result<HermitePatch> from_local(const Grid& local, const Domain& domain);
  /// Returns the geometry by local parameters.
  Grid local_geometry() const;
  friend SurfaceJet evaluate_jet(const HermitePatch& patch, double u, double v);
  friend Result<PatchGrid> to_bezier(const HermitePatch& patch);

  std::shared_ptr<const Data> data_;
};

/// Evaluates the sum over the products of blends: the reference evaluator, for any finite (u,v). Derivatives are by u
/// and v of the domain.
SurfaceJet evaluate_jet(const HermitePatch& patch, double u, double v);

/// How the twists of a network's nodes are estimated.
enum class TwistEstimate : std::uint8_t {
  zero,    ///< Ferguson's zero twists
  adini,   ///< from tangents and positions of the eight neighbours, indices clamped at borders
  bessel,  ///< from positions alone: the twist of the biquadratic through 3x3 nodes
};

/// Returns the nodes [i][j] at (u[i], v[j]) with estimated twists. Derivatives are by u and v. There is one twist per
/// node, so patches remain G1. The estimates are:
///
/// - adini: [R_v(i+1,j) - R_v(i-1,j)] / Du + [R_u(i,j+1) - R_u(i,j-1)] / Dv - [P(i+1,j+1) - P(i-1,j+1) - P(i+1,j-1) +
///   P(i-1,j-1)] / (Du Dv), with each D over two spans.
/// - bessel: [1-a, a] D [1-b, b]^T, where D holds the mixed differences of four cells over their areas and a = h_{i-1}
///   / (h_{i-1} + h_i), with b likewise. The weights are (1+a, -a) at a first node and (-(1-a), 2-a) at a last one,
///   with a of the inner node beside it.
///
/// Errors: invalid_argument (fewer than two knots, or three for bessel; knots that do not increase), count_mismatch,
/// non_finite.
///
/// Source: Farin, Curves and Surfaces for CAGD, 5th ed., ch. 15.
Result<std::vector<HermiteNode>> estimate_twists(TwistEstimate estimate, std::span<const double> u,
                                                 std::span<const double> v, std::span<const HermiteNode> nodes);

/// A grid of bicubic patches whose neighbours are G1 along whole edges. Each node (P, A, B, T) holds the values at the
/// (1,1) corner of the patch at its lower left. Factors k_i > 0 for the columns and l_j > 0 for the rows, k_0 = l_0 =
/// 1, scale tangents.
///
/// - Patch (i,j) takes at its corner (a,b), from node (i+a, j+b), r_u = K A, r_v = L B, r_uv = K L T on [0,1]^2, where
///   K = k_i if a = 0, else 1, and L = l_j if b = 0, else 1.
/// - The parameters of the whole run over knots with the spacings h_i = k_i h_{i-1}, g_j = l_j g_{j-1}; by them it is
///   C1.
///
/// Immutable except for assignment; copies share everything.
class HermiteNetwork {
 public:
  /// Makes a network from factors. The knots start at 0, with h_0 = g_0 = 1.
  ///
  /// - `nodes`: count_u * count_v nodes [i][j], at least two in each direction.
  /// - `k`, `l`: count_u - 1 and count_v - 1 factors, one per column or row of nodes with a patch after it.
  ///
  /// Errors: invalid_argument (too few nodes; a factor that is not positive, k_0 or l_0 that is not 1, knots that a
  /// factor makes coincide; index = the factor), count_mismatch, non_finite (index = the node or factor).
  static Result<HermiteNetwork> from_factors(std::size_t count_u, std::size_t count_v,
                                             std::span<const HermiteNode> nodes, std::span<const double> k,
                                             std::span<const double> l);
  /// Makes the C1 bicubic with given derivatives by u and v at the knots: A = h_{i-1} R_u, B = g_{j-1} R_v, T = h_{i-1}
  /// g_{j-1} R_uv, where h_{-1} is h_0. Errors: as for from_factors() (index = the knot or node).
  static Result<HermiteNetwork> on_knots(std::span<const double> u, std::span<const double> v,
                                         std::span<const HermiteNode> nodes);

  std::size_t count_u() const { return data_->knots_u.size(); }  ///< nodes along u
  std::size_t count_v() const { return data_->knots_v.size(); }  ///< nodes along v
  /// Returns P, A, B and T of node (i,j).
  const HermiteNode& node(std::size_t i, std::size_t j) const { return data_->nodes[i * count_v() + j]; }
  std::span<const double> factors_u() const { return data_->k; }      ///< k of each interval along u
  std::span<const double> factors_v() const { return data_->l; }      ///< l of each interval along v
  std::span<const double> knots_u() const { return data_->knots_u; }  ///< parameters of the rows of nodes
  std::span<const double> knots_v() const { return data_->knots_v; }  ///< parameters of the columns of nodes
  /// Returns the rectangle between the first and the last knots.
  Domain domain() const { return {knots_u().front(), knots_u().back(), knots_v().front(), knots_v().back()}; }
  /// Returns patch (i,j) on [0,1]^2; i < count_u() - 1, j < count_v() - 1. Errors: out_of_memory.
  Result<HermitePatch> patch(std::size_t i, std::size_t j) const;

 private:
  struct Data {
    std::vector<HermiteNode> nodes;
    std::vector<double> k, l, knots_u, knots_v;
  };
  explicit HermiteNetwork(Data data);
  HermitePatch::Corners patch_corners(std::size_t i, std::size_t j) const;
  friend SurfaceJet evaluate_jet(const HermiteNetwork& network, double u, double v);
  static Result<HermiteNetwork> checked(HermiteNetwork network);

  std::shared_ptr<const Data> data_;
};

/// Evaluates the patch that contains (u,v): the reference evaluator. At an inner knot it takes the patch on the right;
/// outside the domain the nearest patch continues. Derivatives are by u and v.
SurfaceJet evaluate_jet(const HermiteNetwork& network, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
