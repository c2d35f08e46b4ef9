#pragma once
// A model of splines, or why there is none, as bytes for another process of this program.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Of surfaces that are B-splines. Anything else becomes an error of kind internal.
std::string to_bytes(const Result<Model>& model);
/// The model again, bit for bit. Errors: the one that was written; internal (these are not bytes of to_bytes).
Result<Model> model_from_bytes(std::string_view bytes);

}  // namespace tessera::inline abi_0_1
