#pragma once
// A model of splines, or the error in its place, as bytes for another process of this program.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Converts a model to bytes. Its surfaces must be B-splines; any other kind gives an internal error.
std::string to_bytes(const Result<Model>& model);
/// Restores the model bit for bit. Errors: the one that was written; internal (these are not bytes of to_bytes).
Result<Model> model_from_bytes(std::string_view bytes);

}  // namespace tessera::inline abi_0_1
