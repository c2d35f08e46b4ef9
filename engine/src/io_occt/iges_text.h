#pragma once
// Checks and completes the B-spline surfaces in the text of an IGES file.

#include <optional>
#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that the weights of all entities of type 128 are positive. If one is not, OpenCASCADE silently drops all
/// weights of that surface and reads another one. Text that is not a number is left to OpenCASCADE. Messages begin with
/// `path`. Errors: invalid_weight (names the entity and the weight).
Status check_iges_weights(std::string_view text, const std::string& path);

/// The text with the ranges of parameters that entities of type 128 leave out: those of their knots. OpenCASCADE drops
/// a surface without its ranges. Empty if none is left out.
std::optional<std::string> with_iges_ranges(std::string_view text);

}}  // namespace tessera::abi_0_1
