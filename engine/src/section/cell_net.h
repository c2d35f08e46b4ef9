#pragma once
// The control net of a part of a patch, and what it proves about the curves of equal height there.
//
// A curve of the height d is a graph over v where g = weight * (height - d) is strictly monotone along u: u = U(v).
// With c(v) = r(U(v), v) and D = r_uu U'^2 + 2 r_uv U' + r_vv,
//   c'' = D - r_u (n.D) / (n.r_u),    U' = -g_v / g_u,
// the projection of D to the plane along r_u. So |c''| <= |D| |r_u| / |n.r_u|, and a chord over a step h of v lies
// within h^2 |c''| / 8 of the curve. For rational patches r = P / W, relative to a point within R of r,
//   r_u = (P_u - r W_u) / W,  r_uu = (P_uu - 2 r_u W_u - r W_uu) / W,  r_uv = (P_uv - r_u W_v - r_v W_u - r W_uv) / W.

#include <cstdint>
#include <span>
#include <vector>

#include "section/levels.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// How curves of equal height run through a part of a patch.
enum class CellKind : std::uint8_t {
  open,     ///< not known: the part must be divided
  empty,    ///< no plane meets it
  over_u,   ///< one graph over u
  over_v,   ///< one graph over v
  along_u,  ///< lines of constant v: the height is the same along u
  along_v,  ///< lines of constant u
  tiny,     ///< anything; it is smaller than Levels::point_size, or no longer divided
};
constexpr bool runs_over_u(CellKind kind) { return kind == CellKind::over_u || kind == CellKind::along_u; }

/// Facts about a part of a patch.
struct CellFacts {
  CellKind kind = CellKind::empty;
  double low = 0, high = 0;  ///< heights
  double bending = 0;        ///< the largest |c''| over the part's own parameter from 0 to 1
  double slack = 0;          ///< to add to the distance of a chord
  double diameter = 0;       ///< of a box that holds the part
  bool divide_u = false;     ///< how to divide it, if `open`
};

/// Control points times weights, relative to the levels' origin, over [0, 1]^2 of a part of a patch.
class CellNet {
 public:
  CellNet(const BezierPatch& patch, const Levels& levels);

  CellFacts facts(const Levels& levels) const;
  /// Divides at the middle of u, or of v: returns the upper half, and keeps the lower.
  CellNet take_upper_half(bool along_u);
  /// Heights times weights, and weights, along the side u = 1, or v = 1.
  std::pair<std::vector<double>, std::vector<double>> upper_side(bool along_u) const;

 private:
  struct Slopes;
  struct Sizes;
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (n_ + 1) + j); }
  double weight(std::size_t k) const { return weights_.empty() ? 1 : weights_[k]; }
  Slopes slopes(bool along_u, double lowest, double highest) const;
  Sizes sizes() const;
  bool is_constant_along(bool along_u, double contact) const;
  void choose(CellFacts& facts, const Levels& levels, double lowest, double highest) const;

  int m_, n_;
  std::vector<Vec3> points_;
  std::vector<double> weights_, heights_;
  double flat_ = -1;  ///< within how much of a plane the whole patch lies; negative: it is not flat
  Vec3 flat_normal_;
};

}}  // namespace tessera::abi_0_1
