#pragma once
// Bicubic Hermite patches: of 16 vectors, and of 12 with the twists zero (Ferguson) or estimated (Adini).

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/domain.h"
#include "tessera/status.h"
#include "tessera/vec.h"

#pragma GCC visibility push(default)
namespace tessera {

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

}  // namespace tessera
#pragma GCC visibility pop
