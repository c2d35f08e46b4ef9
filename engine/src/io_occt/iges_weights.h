#pragma once
// Weights of the rational surfaces of an IGES file, as they stand in its text.

#include <string>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// That those of entities of type 128 are positive. OpenCASCADE silently leaves out all weights of a surface of which one
/// is not, and reads another surface. What is no number is left to it. Errors: invalid_weight (names the entity and the
/// weight).
Status check_iges_weights(const std::string& path);

}  // namespace tessera::inline abi_0_1
