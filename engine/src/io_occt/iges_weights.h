#pragma once
// Checks the weights of the rational surfaces in the text of an IGES file.

#include <string>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Checks that the weights of all entities of type 128 are positive. If one is not, OpenCASCADE silently drops all
/// weights of that surface and reads another one. Text that is not a number is left to OpenCASCADE. Errors:
/// invalid_weight (names the entity and the weight).
Status check_iges_weights(const std::string& path);

}  // namespace tessera::inline abi_0_1
