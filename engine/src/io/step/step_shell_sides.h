#pragma once
// The sides of shells: a solid's skin has its normals outwards, and its voids have them inwards.

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Turns shells of solids with voids around where the file errs: shells within the box of the largest one must enclose
/// a negative volume, and the others a positive one, by a rule over the borders of their faces. Returns the number of
/// shells that it turned. Errors: those of BSplineSurface and Curve.
Result<std::size_t> settle_shell_sides(Shape& shape);

}}  // namespace tessera::abi_0_1
