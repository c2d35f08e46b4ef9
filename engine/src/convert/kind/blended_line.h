#pragma once
// One direction of a ruled surface or Coons patch as rational Bezier curves on common breakpoints, of one degree and
// with one weight function: its two curves, and the blending functions of the other two. The surface's points are then
// sums of products of an entry for u and an entry for v, and its weights are products of weights.

#include <array>
#include <string>
#include <vector>

#include "tessera/coons_patch.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// The line's lists. Element k * degree + i belongs to Bezier point i of piece k; neighbours share their ends.
struct BlendedLine {
  int degree = 1;
  std::vector<double> breaks;
  std::vector<double> weights;  ///< empty if both curves are polynomial
  std::array<std::vector<Vec3>, 2> curves;
  std::array<std::vector<long double>, 2> blends;  ///< exactly 1 and 0 at the ends; empty without a blend
};

/// Brings curves N1 / w1 and N2 / w2 to the weights W = w1 w2, or W = w1 where w1 == w2 or w2 is constant. With a blend
/// f of degree a over the whole domain, the degree is max(degree of N1 w2 and N2 w1, degree of W + a). The blend must
/// be polynomial. `direction` is "u" or "v", for messages. Errors: unsupported_degree, those of curves.
Result<BlendedLine> blended_line(const Curve& first, const Curve& second, const Blend* blend,
                                 const std::string& direction);

}}  // namespace tessera::abi_0_1
