#pragma once
// Bicubic Hermite patches of 16 vectors, or of 12 with the twists zero (Ferguson) or estimated (Adini); networks of such
// patches that join smoothly along whole edges.

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
namespace tessera::inline abi_0_1 {

class PatchGrid;  // tessera/convert.h

/// The order of the rows and columns of a geometry matrix.
enum class HermiteOrder : std::uint8_t {
  by_end,   ///< position 0, tangent 0, tangent 1, position 1: rows r, r_u at u0, r_u, r at u1; columns the same along v
  by_kind,  ///< position 0, position 1, tangent 0, tangent 1
};

/// Position, derivatives and twist at a corner or node.
struct HermiteNode {
  Vec3 position, du, dv, duv;  ///< r, r_u, r_v, r_uv

  friend bool operator==(const HermiteNode&, const HermiteNode&) = default;  ///< by all four
};
/// The same with the twist left open.
struct CornerTangents {
  Vec3 position, du, dv;  ///< r, r_u, r_v
};

/// The bicubic patch with given positions, tangents and twists at its corners. Tangents and twists are derivatives by
/// the patch's own parameters, which run over its domain: with s = (u - u0) / (u1 - u0) the blends are
/// H0(s), (u1 - u0) H1(s), (u1 - u0) H2(s), H3(s). Immutable but for assignment; copies share their vectors.
class HermitePatch {
 public:
  /// The corners of a domain in the order (u0,v0), (u0,v1), (u1,v0), (u1,v1).
  using Corners = std::array<HermiteNode, 4>;
  using OpenCorners = std::array<CornerTangents, 4>;  ///< as Corners, without twists
  /// 16 vectors [i][j], i along u.
  using Grid = std::array<Vec3, 16>;

  // Errors of all: non_finite (of a vector; index = the element), invalid_argument (the domain).

  /// The geometry matrix: 16 vectors [i][j], in order by_end [[r, r_v, r_v, r], [r_u, r_uv, r_uv, r_u], [r_u, r_uv,
  /// r_uv, r_u], [r, r_v, r_v, r]]. Error: count_mismatch.
  static Result<HermitePatch> make(std::span<const Vec3> geometry, const Domain& domain = {},
                                   HermiteOrder order = HermiteOrder::by_end);
  /// With twists. Errors: as make.
  static Result<HermitePatch> from_corners(const Corners& corners, const Domain& domain = {});
  /// 12 vectors, all twists zero (Ferguson, Multivariable curve interpolation, 1964).
  static Result<HermitePatch> ferguson(const OpenCorners& corners, const Domain& domain = {});
  /// 12 vectors, twists by Adini: those of the bilinearly blended Coons patch of the four borders,
  /// r_uv(i,j) = (r_u(i,1) - r_u(i,0)) / dv + (r_v(1,j) - r_v(0,j)) / du - (r00 - r10 - r01 + r11) / (du dv)
  /// (Farin, Curves and Surfaces for CAGD, 5th ed., ch. 15).
  static Result<HermitePatch> adini(const OpenCorners& corners, const Domain& domain = {});
  /// The algebraic form: 16 coefficients a_ij of s^i t^j, s and t over [0,1]. Error: count_mismatch.
  static Result<HermitePatch> from_algebraic(std::span<const Vec3> coefficients, const Domain& domain = {});
  /// Through 16 points [i][j], at the parameters (u[i], v[j]) of the domain: four distinct u and four distinct v,
  /// within the domain or not. Errors: count_mismatch; invalid_argument (two equal parameters, which make the system
  /// singular; index = the second), non_finite.
  static Result<HermitePatch> through_points(std::span<const Vec3> points, std::span<const double> u,
                                             std::span<const double> v, const Domain& domain = {});
  /// A polynomial Bezier patch of degrees 1 to 3 each way; exact. Errors: unsupported (rational), unsupported_degree.
  static Result<HermitePatch> from_bezier(const BezierPatch& patch, const Domain& domain = {});

  const Domain& domain() const { return data_->domain; }  ///< by whose parameters derivatives are taken
  /// The geometry matrix, derivatives by u and v of the domain.
  Grid geometry(HermiteOrder order = HermiteOrder::by_end) const;
  /// At u = u0 (a = 0) or u1 (a = 1), v = v0 (b = 0) or v1 (b = 1).
  HermiteNode corner(int a, int b) const;
  /// The coefficients a_ij of s^i t^j, s and t over [0,1].
  Grid algebraic_form() const;
  /// The points at the parameters (u[i], v[j]): the inverse of through_points.
  Grid points_at(const std::array<double, 4>& u, const std::array<double, 4>& v) const;

  /// The same surface over another rectangle: q_s = (u1 - u0) / (s1 - s0) p_u, and q_st by the product.
  Result<HermitePatch> reparametrized(const Domain& domain) const;

 private:
  struct Data {
    Grid geometry;  // by_end
    Domain domain;
  };
  explicit HermitePatch(const Data& data) : data_(std::make_shared<const Data>(data)) {}
  /// The geometry by local parameters, which run over [0,1], from that by the domain's, and back.
  static Result<HermitePatch> from_local(const Grid& local, const Domain& domain);
  Grid local_geometry() const;
  friend SurfaceJet evaluate_jet(const HermitePatch& patch, double u, double v);
  friend Result<PatchGrid> to_bezier(const HermitePatch& patch);

  std::shared_ptr<const Data> data_;
};

/// The reference evaluator: the sum over the products of blends. Derivatives by u and v of the domain. Any finite
/// (u,v).
SurfaceJet evaluate_jet(const HermitePatch& patch, double u, double v);

/// One bicubic Bezier patch over the patch's domain; exact to rounding. Error: non_finite (too large).
Result<PatchGrid> to_bezier(const HermitePatch& patch);

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

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
