#pragma once
// A bicubic in place of a polynomial of any degree, with bounds of its error, for the float kernels of exact rays.

#include <array>
#include <cstddef>

#include "kernel/ray/ray_kernels.h"
#include "ray/net/projected_net.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Four components of a net, `[component][i * columns + j]`.
using FourNets = std::array<std::array<double, (max_degree + 1) * (max_degree + 1)>, 4>;

/// A net about the middle of its square: the polynomial in u and v from -1/2 to 1/2.
struct CubicNet {
  using Power = std::array<std::array<double, 4>, 4>;  ///< coefficients of u^i v^j, `[i][j]`
  std::array<Power, 4> power{};
  /// Bounds for |u|, |v| <= RayLeaf::reach, by component, of the difference between the net and the bicubic, in value
  /// and in either derivative. Zero if neither degree is above three.
  std::array<double, 4> value_error{}, slope_error{};
};

/// Above degree three this is the Chebyshev series of the net on the square of that reach, without its terms above the
/// third (economisation: Lanczos, Applied Analysis, 1956, sec. 7.8). The omitted terms are bounded one by one by
/// |T_k| <= 1 and |T_k'| <= k^2.
CubicNet cubic_net(const NetShape<0, 0>& shape, const FourNets& net);

}}  // namespace tessera::abi_0_1
