#pragma once
// Copies of surfaces at other places.

#include <memory>

#include "io/step/step_inverse.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the inverse of a surface under a map that scales evenly. Parameters are those of the surface itself.
std::unique_ptr<SurfaceInverse> make_replica_inverse(std::unique_ptr<SurfaceInverse> of, const Affine& map,
                                                     double tolerance);

}}  // namespace tessera::abi_0_1
