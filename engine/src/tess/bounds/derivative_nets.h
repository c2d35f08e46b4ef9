#pragma once
// Computes the second derivatives of a patch as Bezier nets, cuts them to pieces and bounds their size.

#include <array>
#include <cstddef>

#include "surface/net/homogeneous.h"
#include "tess/bounds/chord_bound.h"

namespace tessera { inline namespace abi_0_1 {

/// A net of homogeneous vectors, `[i][j]`.
struct DerivativeNet {
  int rows = 0, columns = 0;
  std::array<Homogeneous, (max_degree + 1) * (max_degree + 1)> at;

  DerivativeNet() = default;
  DerivativeNet(const DerivativeNet& other) { *this = other; }
  DerivativeNet& operator=(const DerivativeNet& other);  ///< copies only the size() vectors in use
  int size() const { return rows * columns; }
  Homogeneous& operator()(int i, int j) { return at[static_cast<std::size_t>(i * columns + j)]; }
};

/// Cuts a net into quarters [low or high u][low or high v], by de Casteljau at 1/2.
void cut(const DerivativeNet& net, DerivativeNet (&quarter)[2][2]);
/// Returns the net of a rectangle of the parameters.
DerivativeNet cut_to(const DerivativeNet& net, const Domain& rectangle);

/// The second derivatives of a homogeneous patch, and its points, which bounds of a rational patch need.
struct DerivativeNets {
  DerivativeNet uu, uv, vv, points;
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  double scale = 1;               ///< from the nets' numbers to the patch's lengths
  double size = 0, heaviest = 0;  ///< the largest coordinate and weight among points

  explicit DerivativeNets(const BezierPatch& patch);
};

/// The nets of a piece, which is made of up to four quarters.
struct DerivativePiece {
  using Nets = std::array<const DerivativeNet*, 4>;
  Nets uu{}, uv{}, vv{}, points{};
  std::size_t count = 0;
};

/// Returns bounds over a piece. `rounding`: the error of differences and cuts, relative to their operands. `products`:
/// also bounds products, for degrees up to max_product_degree.
SecondDerivatives bound_piece(const DerivativeNets& patch, const DerivativePiece& piece, double rounding,
                              bool products);

}}  // namespace tessera::abi_0_1
