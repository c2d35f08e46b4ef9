#pragma once
// A model of splines, or the error in its place, as bytes for another process on this machine.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Version of the bytes. Raise it with each change of what they mean, which includes the numbers of StatusCode.
inline constexpr int model_bytes_version = 1;
/// The message of model_from_bytes() for other bytes.
inline constexpr std::string_view damaged_model = "a damaged model";

/// Converts a model to bytes. Its surfaces must be B-splines; any other kind gives an internal error.
std::string to_bytes(const Result<Model>& model);
/// Restores the model bit for bit. Errors: the one that was written; internal (these are not bytes of to_bytes; the message is
/// damaged_model).
Result<Model> model_from_bytes(std::string_view bytes);

}  // namespace tessera::inline abi_0_1
