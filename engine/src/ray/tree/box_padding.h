#pragma once
// The padding of boxes against the rounding of rays in float.

namespace tessera { inline namespace abi_0_1 {

// In scene coordinates.
// - The line's start and direction round by 2^-24, of at most 3.5 and over at most 4: 5e-7 per component.
// - The sides of a box round by 2^-24 of at most 1.5 (tubes reach beyond 1), twice: 2e-7.
// - Embree's own arithmetic for user geometries is not conservative, also in robust scenes. The reciprocal of the
//   direction rounds by 4 units of 2^-24, its products with side and origin by one each. A side is off by at most
//   5 * 2^-24 times its distance from the origin, 3, and 2^-24 times the origin, 1.5: 1e-6.
// - The kernels of the library's own trees round the difference of side and origin, at most 5, the reciprocal and their
//   product, by 2^-24 each: 9e-7.
inline constexpr float box_pad = 2e-6f;

}}  // namespace tessera::abi_0_1
